//! Slab tests.
//!
//! Plainly: a ray is inside a box while it is between all three pairs of planes, so the interval of `t` inside is the
//! intersection of three intervals. Departures from the plain form:
//! - the box is widened by a pad, a bound on what the primitive tests may be off by, so that a box never culls a
//!   hit that a primitive test would accept (Ize 2013 argues the same for 2 ulps and an exact primitive test);
//! - a direction component too small to move the ray by more than that pad counts as that small, so that no reciprocal
//!   is infinite and `0 * inf` cannot arise from axis-parallel rays;
//! - `min` and `max` take the second operand on NaN, so a slab that overflowed is ignored, not fatal.

mod cull;
pub mod oracle;
mod own;

pub use cull::{CullRay, OneCullRay};
pub use own::OwnBox;

use crate::math::{Lane, Real, Vec3};

/// Components below this share of the largest one, in roundoffs, count as this share: a ray that crosses the whole scene
/// moves an eighth of a roundoff along such an axis, which the pads of both slab tests cover in their number type.
const LEAST_SHARE: f64 = 0.125;

/// Reciprocal direction with the smallest components bounded away from zero.
#[inline(always)]
pub(crate) fn safe_reciprocal<L: Lane>(direction: Vec3<L>) -> Vec3<L> {
    let least = direction.abs().max_component() * L::constant(LEAST_SHARE * <L::Scalar as Real>::ROUNDOFF);
    let one = |d: L| L::one() / d.abs().max(least).with_sign_of(d);
    Vec3::new(one(direction.x), one(direction.y), one(direction.z))
}

#[cfg(test)]
mod tests;
