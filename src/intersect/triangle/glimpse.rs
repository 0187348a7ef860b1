//! What the edge functions of the watertight test tell for certain, so that `f64` need not be asked for each hit.
//!
//! Plainly: a triangle whose edge functions are all clearly of one sign is hit, and at a distance that their weights tell
//! within bounds. Only the hit that is nearest in the end needs the exact distance, and a shadow ray none.
//!
//! With `u` the roundoff of `f32` and `M` the largest coordinate of the corners relative to the origin:
//! - a coordinate across the ray is off by at most `6 u M` (1 for the difference to the origin, 3 for the product with the
//!   shear, 2 for the last difference), so an edge function of coordinates up to `A` by less than
//!   `E = 32 u M (A + 32 u M)`: four products of a coordinate with the error of another, 24; rounding, 8; the rest is for
//!   products of errors;
//! - where all three are beyond `E`, with sum `D`, the weights are off by `6 E / D` in all, and what they weigh, the
//!   corners' coordinates along the ray, by at most half their range times that; rounding adds less than `16 u M`.
//!
//! Where a product may underflow or a quotient overflow, nothing is certain.

use crate::math::{Lane, Mask, Real};

/// Roundoffs in an edge function.
const EDGE_ROUNDOFFS: f64 = 32.0;
/// Roundoffs along the ray.
const ALONG_ROUNDOFFS: f64 = 16.0;
/// Times the range along the ray and `E / D`: 3, and a third more.
const WEIGHTS_OFF: f64 = 4.0;
/// What share the area across the ray has of the squared reach where the point in the plane is known to a few roundoffs.
const STEEP: f64 = 1e-4;
/// Edge functions below say nothing: what products with them lose to underflow is no longer small.
const LEAST_EDGE: f64 = 1e-18;

/// Rays that certainly hit their triangles, and where.
#[derive(Clone, Copy, Debug)]
pub struct Glimpse<L: Lane> {
    /// Lanes that pass the edges.
    pub inside: L::Mask,
    /// No `t` of a hit is below; minus infinity where not even a hit is certain.
    pub near: L,
    /// No `t` of a hit is above; infinity there.
    pub far: L,
    /// Lanes whose line certainly meets the triangle, and not nearly along its plane.
    pub(super) is_steep: L::Mask,
    /// The largest coordinate of the corners relative to the origin.
    pub(super) reach: L,
}

impl<L: Lane> Glimpse<L> {
    /// Bounds, and nothing about how steeply planes are met.
    #[inline(always)]
    pub(crate) fn between(inside: L::Mask, near: L, far: L) -> Self {
        Self { inside, near, far, is_steep: L::Mask::splat(false), reach: L::zero() }
    }

    /// From the corners relative to the origin, sheared: two coordinates across the ray and one along it; `per_z` is how
    /// much `t` grows along the last.
    #[inline(always)]
    pub(super) fn of(corners: [[L; 3]; 3], reach: L, per_z: L) -> Self {
        let [[ax, ay, az], [bx, by, bz], [cx, cy, cz]] = corners;
        let e = [cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax];
        let across = largest([ax, ay, bx, by]).max(largest([cx, cy, cx, cy]));
        let tiny = L::constant(f64::from(f32::MIN_POSITIVE));
        let unit = reach * L::constant(EDGE_ROUNDOFFS * f32::ROUNDOFF);
        let edge_error = unit * (across + unit) + L::constant(LEAST_EDGE);
        let inside = super::woop::same_side(e);
        let (least, greatest) = (e[0].min(e[1]).min(e[2]), e[0].max(e[1]).max(e[2]));
        let share = L::one() / ((e[0] + e[1]) + e[2]);
        let z = ((e[0] * az + e[1] * bz) + e[2] * cz) * share;
        let range = az.max(bz).max(cz) - az.min(bz).min(cz);
        let weights_off = range * (edge_error * share).abs() * L::constant(WEIGHTS_OFF);
        let apart = weights_off + reach * L::constant(ALONG_ROUNDOFFS * f32::ROUNDOFF);
        let (t, apart) = (z * per_z, apart * per_z.abs() + tiny);
        let (near, far) = (t - apart, t + apart);
        let in_range = share.abs().ge(tiny) & (far - near).is_finite();
        let hits = (least.gt(edge_error) | greatest.lt(-edge_error)) & in_range;
        let unknown = L::constant(f64::INFINITY);
        let is_steep = hits & ((e[0] + e[1]) + e[2]).abs().gt(reach * reach * L::constant(STEEP));
        let (near, far) = (L::select(hits, near, -unknown), L::select(hits, far, unknown));
        Self { inside, near, far, is_steep, reach }
    }
}

#[inline(always)]
fn largest<L: Lane>([a, b, c, d]: [L; 4]) -> L {
    a.abs().max(b.abs()).max(c.abs().max(d.abs()))
}
