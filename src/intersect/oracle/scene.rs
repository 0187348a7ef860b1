//! Several shapes together.

use super::{Line, Shape, aabb, cylinder, sphere, triangle};

/// Every `t` at which the line meets the surface of the shape, at most two; through the open ends of a cylinder it meets
/// nothing.
pub fn surfaces(line: &Line, shape: &Shape) -> [Option<f64>; 2] {
    let both = |ends: Option<[f64; 2]>| ends.map_or([None; 2], |t| t.map(Some));
    match shape {
        Shape::Triangle(corners) => [triangle(line, *corners), None],
        Shape::Sphere { center, radius } => both(sphere(line, *center, *radius)),
        Shape::Box { min, max } => both(aabb(line, *min, *max)),
        Shape::Cylinder(c) => {
            let ends =
                cylinder(line, c).map(|ends| ends.map(|(t, on_side)| (c.capped || on_side).then_some(t)));
            ends.unwrap_or_default()
        }
    }
}

/// The nearest of all surfaces that `counts` lets count, and the number of its shape.
///
/// **Accuracy:** hits are exact; which of two is nearer is decided by `t` as `f64`, and the first shape wins a tie.
pub fn nearest(line: &Line, shapes: &[Shape], counts: impl Fn(f64) -> bool) -> Option<(usize, f64)> {
    let mut best: Option<(usize, f64)> = None;
    for (number, shape) in shapes.iter().enumerate() {
        for t in surfaces(line, shape).into_iter().flatten() {
            if counts(t) && best.is_none_or(|(_, nearest)| t < nearest) {
                best = Some((number, t));
            }
        }
    }
    best
}
