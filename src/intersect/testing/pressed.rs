//! Places where instances are flat.

use super::dice::Dice;
use crate::math::Transform;

/// Three headings that are not nearly in a plane, then pressed along x, then moved.
pub(crate) fn pressed(dice: &mut Dice, by: f64, to: [f64; 3]) -> Transform {
    loop {
        let headings = [dice.heading(), dice.heading(), dice.heading()];
        let row = |k: usize| {
            let scale = if k == 0 { by } else { 1.0 };
            let [x, y, z] = headings[k].map(|a| a * scale);
            [x, y, z, to[k]]
        };
        let placed = Transform::from_rows([row(0), row(1), row(2)]);
        if let Some(place) = placed.ok().filter(|place| place.determinant().abs() > 0.05 * by) {
            return place;
        }
    }
}
