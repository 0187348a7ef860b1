//! Numbers: the lane trait, vectors over lanes, boxes, transforms and rounding bounds.
//!
//! Everything that touches a ray is written once over [`Lane`] and used as one value (`f32`, `f64`) or as eight
//! (`f32x8`, `f64x8`).

mod aabb;
mod expansion;
mod lane;
mod lane_scalar;
mod lane_wide;
mod ring;
mod transform;
mod vec3;

pub use aabb::Aabb;
pub(crate) use expansion::{Pair, determinant, determinant_sign, two_sum};
pub use lane::{BitLane, Lane, Mask, Real, Stored, Wide};
pub(crate) use ring::{Ring, cross as ring_cross, dot as ring_dot, pairs, sign, value};
pub use transform::{Transform, TransformError};
pub use vec3::{Vec3, fused_cross, fused_dot};

/// Lanes in one packet: the width of `f32x8`.
pub const WIDTH: usize = 8;

/// An array from a function of the lane number, written out: in hot loops `array::from_fn` and `map` leave calls and loops
/// behind that the optimiser does not always take apart.
#[inline(always)]
pub(crate) fn eight<T>(mut f: impl FnMut(usize) -> T) -> [T; WIDTH] {
    [f(0), f(1), f(2), f(3), f(4), f(5), f(6), f(7)]
}

/// The same for the three axes or corners.
#[inline(always)]
pub(crate) fn three<T>(mut f: impl FnMut(usize) -> T) -> [T; 3] {
    [f(0), f(1), f(2)]
}

/// Bound on the relative error of `n` roundings: `n u / (1 - n u)` with the unit roundoff `u` of `f32`.
///
/// **Source:** Higham, Accuracy and Stability of Numerical Algorithms, 2002, lemma 3.1; the name is that of
/// Pharr, Jakob and Humphreys, 4th ed., 6.8.
pub const fn gamma(n: u32) -> f32 {
    gamma_of(n, f32::EPSILON as f64 / 2.0) as f32
}

/// [`gamma`] for a number type with unit roundoff `u`.
pub const fn gamma_of(n: u32, u: f64) -> f64 {
    let nu = n as f64 * u;
    nu / (1.0 - nu)
}
