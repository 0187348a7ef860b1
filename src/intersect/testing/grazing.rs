//! Triangles that boxes fit badly, and rays that run in their planes.

use super::dice::Dice;
use crate::intersect::Ray;

pub(crate) type Corners = [[f32; 3]; 3];

/// Kinds of [`hard_triangle`].
pub(crate) const KINDS: usize = 8;

/// A triangle that boxes fit badly.
pub(crate) fn hard_triangle(kind: usize, dice: &mut Dice) -> Corners {
    let mut point = |scale: f64| dice.point().map(|x| (scale * x) as f32);
    let (a, b, c, small) = (point(4.0), point(4.0), point(4.0), point(1.0));
    let beside = |p: [f32; 3], by: f32| std::array::from_fn(|k| p[k] + by * small[k]);
    let mut along = a;
    let axis = dice.below(3);
    along[axis] += 6.0;
    match kind {
        0 => [a, b, beside(b, 1e-3)],
        1 => [a, b, beside(a, 1e-6)],
        2 => [a, along, beside(along, 0.05)],
        3 => [a, along, std::array::from_fn(|k| if k == (axis + 1) % 3 { b[k] } else { a[k] })],
        4 => [a, beside(a, 0.1), beside(a, -0.07)],
        5 => [[0.0; 3], b, c],
        6 => [a, a.map(|x| x + 5.0), beside(a, 0.02)],
        _ => [a, b, c].map(|p| p.map(|x| (2.0 * x).round() * 0.5)),
    }
}

/// From a point of a triangle's plane to another: the signs of its edge functions are chance.
pub(crate) fn in_plane(triangles: &[Corners], dice: &mut Dice) -> Ray {
    let [a, b, c] = triangles[dice.below(triangles.len())];
    let point = |dice: &mut Dice| -> [f32; 3] {
        let (u, v) = (dice.between(-1.0, 2.0), dice.between(-1.0, 2.0));
        let at = |k: usize| f64::from(a[k]) * (1.0 - u - v) + f64::from(b[k]) * u + f64::from(c[k]) * v;
        std::array::from_fn(|k| at(k) as f32)
    };
    let (origin, target) = (point(dice), point(dice));
    let nudge = [0.0, 1e-7, 1e-5][dice.below(3)];
    Ray::new(origin, std::array::from_fn(|k| target[k] - origin[k] + nudge * dice.point()[k] as f32))
}
