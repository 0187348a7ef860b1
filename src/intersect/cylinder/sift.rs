//! What is cheap to tell of rays and cylinders, in the number type of the lanes and by more than rounding may amount to.

use super::Lanes;
use crate::intersect::{RayLanes, doubt};
use crate::math::{Lane, Mask, Vec3, fused_dot, gamma};

/// Lanes whose rays certainly hit nothing at `limit` or before: there they are still outside of the side, and come nearer to the
/// axis. Distances across are multiplied by its length, so that nothing is divided. NaN and infinities decide nothing.
#[inline(always)]
pub fn is_beyond<L: Lane>(ray: &RayLanes<L>, c: &Lanes<L>, limit: L) -> L::Mask {
    let (axis, f, d) = (c.to - c.from, ray.origin - c.from, ray.direction);
    let at = f + d * limit;
    let (axis2, along_at, along_d) = (fused_dot(axis, axis), fused_dot(at, axis), fused_dot(d, axis));
    let reach = c.radius * c.radius + doubt::rounding_at(limit, fused_dot(f, f), fused_dot(d, d));
    let outside = (fused_dot(at, at) - reach) * axis2;
    let nearing = fused_dot(at, d) * axis2;
    let later = outside.gt(along_at * along_at) & nearing.lt(along_at * along_d) & ray.t_min.ge(L::zero());
    later | limit.le(ray.t_min)
}

/// False only where the ray's line certainly passes the axis line at more than the radius: the distance is
/// `|f . n| / |n|` with `n` the product of direction and axis. The sum of magnitudes stands for `|n|`: up to 1.7 times
/// too large, but safe from underflow. NaN and overflow count as doubt.
#[inline(always)]
pub fn may_hit<L: Lane>(ray: &RayLanes<L>, c: &Lanes<L>) -> L::Mask {
    let (axis, f, d) = (c.to - c.from, ray.origin - c.from, ray.direction);
    let n = d.cross(axis);
    let sum = |v: Vec3<L>| v.x.abs() + v.y.abs() + v.z.abs();
    let size = sum(d) * sum(axis);
    let slack = sum(f) * size * L::constant(f64::from(gamma(16)));
    let reach = c.radius * sum(n) + slack;
    let misses = f.dot(n).abs().gt(reach);
    // Products of tiny numbers that lost their digits to underflow decide nothing; 64 keeps that loss below a roundoff.
    !(misses & slack.min(size).gt(L::constant(64.0 * f64::from(f32::MIN_POSITIVE))))
}

/// Lanes whose rays certainly start outside of the side and go away from the axis, or beside a cap and away from that. Distances
/// across are multiplied by the axis' length, so that nothing is divided; the slack is four times what rounding may amount
/// to. NaN decides nothing, nor do sizes whose products could overflow or underflow.
#[inline(always)]
pub fn is_behind<L: Lane>(ray: &RayLanes<L>, c: &Lanes<L>) -> L::Mask {
    let (axis, f, d, zero) = (c.to - c.from, ray.origin - c.from, ray.direction, L::zero());
    let (axis2, along_f, along_d) = (fused_dot(axis, axis), fused_dot(f, axis), fused_dot(d, axis));
    let (b, along) = (fused_dot(f, d) * axis2, along_f * along_d);
    let leaves_slab = (along_f.lt(zero) & along_d.lt(zero)) | (along_f.gt(axis2) & along_d.gt(zero));
    if !(b.gt(along) | leaves_slab).any() {
        return L::Mask::splat(false);
    }
    let roundoffs = L::constant(f64::from(gamma(16)));
    let [size_f, size_d, size_axis] = [f, d, axis].map(doubt::size);
    let [off_f, off_d, off_axis] = [size_f, size_d, size_axis].map(|x| x * size_axis * roundoffs);
    let leaves_slab = (along_f.lt(-off_f) & along_d.lt(-off_d))
        | ((along_f - axis2).gt(off_f + off_axis) & along_d.gt(off_d));
    let reach2 = c.radius * c.radius + size_f * size_f * (roundoffs * L::constant(4.0));
    let is_outside = ((fused_dot(f, f) - reach2) * axis2).gt(along_f * along_f);
    let leaves_side = is_outside & (b - along).gt(size_f * size_axis * off_d);
    let is_moderate = size_f.min(size_d).min(size_axis).gt(L::constant(1e-6))
        & size_f.max(size_d).max(size_axis).lt(L::constant(1e6));
    (leaves_slab | leaves_side) & is_moderate & ray.t_min.ge(zero)
}

/// None: to tell of a cylinder that it is hit for certain takes as long as to meet it.
#[inline(always)]
pub fn surely_hits<L: Lane>(_: &RayLanes<L>, _: &Lanes<L>, _limit: L) -> L::Mask {
    L::Mask::splat(false)
}
