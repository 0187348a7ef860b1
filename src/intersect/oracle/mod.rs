//! The exact oracle: hit or miss without rounding, and where, for what every kernel claims to decide.
//!
//! All numbers of a question become whole numbers of one tiny unit, so that nothing is rounded; decisions compare squares
//! and never take a root. Only the value of `t` does, with a hundred digits to spare, before it becomes an `f64`. Slow (some
//! ten microseconds a question) and independent of every kernel, of the trees and of the renderer.

mod curved;
mod flat;
pub(super) mod number;
mod scene;
mod shape;
#[cfg(test)]
mod tests;

pub use curved::{cylinder, sphere};
pub use flat::{aabb, triangle};
pub use scene::{nearest, surfaces};
pub use shape::{Cylinder, Shape};

/// A line through space, `origin + t direction` for every `t`. **Needs:** finite numbers, a direction that is not zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Where `t` is 0.
    pub origin: [f64; 3],
    /// What `t` counts.
    pub direction: [f64; 3],
}

impl Line {
    /// The line of a ray.
    pub fn of(ray: &super::Ray) -> Self {
        Self { origin: ray.origin.map(f64::from), direction: ray.direction.map(f64::from) }
    }
}
