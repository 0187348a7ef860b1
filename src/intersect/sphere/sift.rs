//! What is cheap to tell of rays and spheres, in the number type of the lanes and by more than rounding may amount to.

use super::Lanes;
use crate::intersect::{RayLanes, doubt};
use crate::math::{Lane, Mask, fused_dot, gamma};

/// Lanes whose rays certainly hit nothing at `limit` or before: there they are still outside, and come nearer. NaN and infinities
/// decide nothing.
#[inline(always)]
pub fn is_beyond<L: Lane>(ray: &RayLanes<L>, s: &Lanes<L>, limit: L) -> L::Mask {
    let (f, d) = (ray.origin - s.center, ray.direction);
    let at = f + d * limit;
    let reach = s.radius * s.radius + doubt::rounding_at(limit, fused_dot(f, f), fused_dot(d, d));
    let outside = fused_dot(at, at).gt(reach) & fused_dot(at, d).lt(L::zero());
    (outside & ray.t_min.ge(L::zero())) | limit.le(ray.t_min)
}

/// True only where the sphere is certainly hit, and before `limit`: for rays that ask no more than that.
///
/// The ray starts outside, comes nearer, passes the centre at less than the radius, and at its closest has not come to the
/// limit: all by more than the slack of [`may_hit`]. So the chord is longer than a thousandth of the way, which is more
/// than rounding makes of where it begins.
#[inline(always)]
pub fn surely_hits<L: Lane>(ray: &RayLanes<L>, s: &Lanes<L>, limit: L) -> L::Mask {
    let (f, d, zero) = (ray.origin - s.center, ray.direction, L::zero());
    let (a, b, ff) = (fused_dot(d, d), fused_dot(f, d), fused_dot(f, f));
    let (r2, slack) = (s.radius * s.radius, ff * L::constant(f64::from(4.0 * gamma(16))));
    let passes_inside = (ff * a - b * b).lt((r2 - slack) * a);
    let comes_nearer = b.lt(zero) & ff.gt(r2 + (slack + slack)) & ray.t_min.le(zero);
    let in_range = is_moderate(a) & is_moderate(ff) & r2.gt(L::constant(1e-18));
    passes_inside & comes_nearer & in_range & (-b).lt(limit * a)
}

/// True far from where products overflow or underflow.
#[inline(always)]
fn is_moderate<L: Lane>(x: L) -> L::Mask {
    x.ge(L::constant(1e-18)) & x.le(L::constant(1e18))
}

/// False only where the sphere is certainly missed. Written with `not greater`, so that overflow, underflow and NaN
/// count as doubt.
#[inline(always)]
pub fn may_hit<L: Lane>(ray: &RayLanes<L>, s: &Lanes<L>) -> L::Mask {
    let (f, d) = (ray.origin - s.center, ray.direction);
    let (a, b, ff) = (fused_dot(d, d), fused_dot(f, d), fused_dot(f, f));
    // Lagrange: |f|^2 |d|^2 - (f.d)^2 = |f x d|^2 is |d|^2 times the squared distance of the line. Either term is off by less
    // than gamma(9) |f|^2 |d|^2; the slack is three times what both may be.
    let (size, slack) =
        (ff * a, ff * L::constant(f64::from(4.0 * gamma(16))) + L::constant(f64::from(f32::MIN_POSITIVE)));
    let reach = s.radius * s.radius + slack;
    let misses = (size - b * b).gt(reach * a);
    let behind = b.gt(L::zero()) & ff.gt(reach + slack) & ray.t_min.ge(L::zero());
    // Elsewhere products may overflow, or lose more to underflow than the slack allows for.
    let in_range = size.gt(L::constant(1e-36)) & size.lt(L::constant(1e36));
    !((misses | behind) & in_range)
}

/// None beside those that [`may_hit`] sorts out: it costs nothing to tell there.
#[inline(always)]
pub fn is_behind<L: Lane>(_: &RayLanes<L>, _: &Lanes<L>) -> L::Mask {
    L::Mask::splat(false)
}
