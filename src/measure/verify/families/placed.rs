//! Where instances show things.

use super::aim::across;
use crate::intersect::testing::dice::Dice;
use crate::math::Transform;

/// Turned and scaled, more along one axis than along another as often as not, pressed to as little as a thousandth; to where
/// its middle is at the origin, or moved anywhere.
pub(super) fn placed(dice: &mut Dice, center: [f64; 3], size: f64) -> Transform {
    let alike = dice.magnitude(-2.0, 2.0);
    let scale = match dice.below(2) {
        0 => [alike; 3],
        _ => std::array::from_fn(|_| alike * dice.magnitude(-3.0, 0.0)),
    };
    let [before, after] = [turned(dice), turned(dice)];
    let row = |k: usize, c: usize| (0..3).map(|i| after[k][i] * scale[i] * before[i][c]).sum::<f64>();
    let linear: [[f64; 3]; 3] = std::array::from_fn(|k| std::array::from_fn(|c| row(k, c)));
    let middle = linear.map(|row| (0..3).map(|c| row[c] * center[c]).sum::<f64>());
    let to = dice.point().map(|x| x * size * alike * [0.0, 1.0, 1e3][dice.below(3)]);
    let stays = dice.below(2) as f64;
    let moved = |k: usize| to[k] - stays * middle[k];
    let rows = std::array::from_fn(|k| [linear[k][0], linear[k][1], linear[k][2], moved(k)]);
    Transform::from_rows(rows).unwrap_or(Transform::IDENTITY)
}

/// Rows of a rotation.
fn turned(dice: &mut Dice) -> [[f64; 3]; 3] {
    let x = dice.heading();
    let y = across(dice, x);
    [x, y, [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]]]
}
