//! Ray against cylinder, capped or open, any axis.
//!
//! Plainly: the ray is inside the infinite cylinder during one interval of `t` and between the planes of the caps during
//! another; it is inside the capped cylinder during their intersection. The hit is where that begins, or where it ends
//! for a ray that starts inside. Since side and caps are decided by the same two intervals there is no rim gap, which
//! separate tests of side (by height) and caps (by radius) have.
//! - The side's quadratic uses perpendicular components, as [`super::sphere`] does.
//! - A ray along the axis, or across it, makes one interval all or nothing instead of dividing by zero.

pub mod oracle;

use crate::intersect::{LaneHit, RayLanes};
use crate::math::{Aabb, Lane, Mask, Vec3, gamma};

/// Cylinders as lanes.
#[derive(Clone, Copy, Debug)]
pub struct Lanes<L: Lane> {
    /// Centre of the first cap.
    pub from: Vec3<L>,
    /// Centre of the second cap.
    pub to: Vec3<L>,
    /// Radius, positive.
    pub radius: L,
    /// Closed by caps, or open at both ends.
    pub capped: L::Mask,
}

/// An interval of `t`, empty where `first > last`.
#[derive(Clone, Copy, Debug)]
struct Interval<L> {
    first: L,
    last: L,
}

impl<L: Lane> Interval<L> {
    /// Everything where the mask is true, nothing elsewhere.
    #[inline(always)]
    fn all_where(mask: L::Mask) -> Self {
        let inf = L::constant(f64::INFINITY);
        Self { first: L::select(mask, -inf, inf), last: L::select(mask, inf, -inf) }
    }
    #[inline(always)]
    fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self { first: L::select(mask, yes.first, no.first), last: L::select(mask, yes.last, no.last) }
    }
}

/// The first point of each cylinder beyond `t_min`, in the number type of the lanes.
#[inline(always)]
pub fn solve<L: Lane>(ray: &RayLanes<L>, c: &Lanes<L>) -> LaneHit<L> {
    solve_rounded(ray, c, |t| t)
}

/// `round` is what becomes of `t` later: the end beyond `t_min` is chosen by the `t` that the caller will see.
#[inline(always)]
fn solve_rounded<L: Lane>(ray: &RayLanes<L>, c: &Lanes<L>, round: impl Fn(L) -> L) -> LaneHit<L> {
    let axis = c.to - c.from;
    let f = ray.origin - c.from;
    let (axis2, along_f, along_d) = (axis.length_squared(), f.dot(axis), ray.direction.dot(axis));
    let side = inside_side(f - axis * (along_f / axis2), ray.direction - axis * (along_d / axis2), c.radius);
    let slab = between_caps(along_f, along_d, axis2);
    let (mask, t, on_side) = first_beyond(ray.t_min, side, slab, c.capped, round);
    let height = (along_f + t * along_d) / axis2;
    let (zero, half, one) = (L::zero(), L::constant(0.5), L::one());
    let cap = L::select(height.lt(half), one, one + one);
    LaneHit { mask, t, u: L::select(on_side, zero, cap), v: height.clamp(zero, one) }
}

/// When the ray is inside the infinite cylinder, from the parts of offset and direction across its axis.
#[inline(always)]
fn inside_side<L: Lane>(f: Vec3<L>, d: Vec3<L>, radius: L) -> Interval<L> {
    let (a, b) = (d.length_squared(), f.dot(d));
    let across = f - d * (b / a);
    let discriminant = radius * radius - across.length_squared();
    let q = -(b + (a * discriminant).sqrt().with_sign_of(b));
    let c = f.length_squared() - radius * radius;
    let (t0, t1) = (q / a, c / q);
    // In this order a NaN of `c / q`, from a ray that starts at the point where it touches, gives the other root.
    let crossing = Interval { first: t1.min(t0), last: t1.max(t0) };
    let meets =
        Interval::select(discriminant.ge(L::zero()), crossing, Interval::all_where(L::Mask::splat(false)));
    let parallel = Interval::all_where(c.le(L::zero()));
    Interval::select(a.gt(L::zero()), meets, parallel)
}

/// When the ray is between the planes of the caps.
#[inline(always)]
fn between_caps<L: Lane>(along_f: L, along_d: L, axis2: L) -> Interval<L> {
    let zero = L::zero();
    let (t0, t1) = (-along_f / along_d, (axis2 - along_f) / along_d);
    let crossing = Interval { first: t0.min(t1), last: t0.max(t1) };
    let parallel = Interval::all_where(along_f.ge(zero) & along_f.le(axis2));
    Interval::select(along_d.eq(zero), parallel, crossing)
}

/// The first boundary beyond `t_min`: `(hit, t, on the side rather than a cap)`.
#[inline(always)]
fn first_beyond<L: Lane>(
    t_min: L,
    side: Interval<L>,
    slab: Interval<L>,
    capped: L::Mask,
    round: impl Fn(L) -> L,
) -> (L::Mask, L, L::Mask) {
    let (first, last) = (side.first.max(slab.first), side.last.min(slab.last));
    let inside = first.le(last);
    let (first, last) = (round(first), round(last));
    let enter_on_side = side.first.ge(slab.first);
    let leave_on_side = side.last.le(slab.last);
    // An open cylinder has no surface where the ray enters or leaves through a cap.
    let enters = first.gt(t_min) & (capped | enter_on_side);
    let leaves = last.gt(t_min) & (capped | leave_on_side);
    let mask = inside & (enters | leaves);
    let on_side = (enters & enter_on_side) | (!enters & leave_on_side);
    (mask, L::select(enters, first, last), on_side)
}

/// The same, with `f32` lanes as a filter before `f64`.
#[inline(always)]
pub fn filter_and_solve<L: Lane>(ray: &RayLanes<L>, c: &Lanes<L>) -> LaneHit<L> {
    let candidates = may_hit(ray, c);
    if !candidates.any() {
        return LaneHit::none();
    }
    let wide = Lanes {
        from: c.from.widen(),
        to: c.to.widen(),
        radius: c.radius.widen(),
        capped: L::widen_mask(c.capped),
    };
    let mut hit = LaneHit::narrow(solve_rounded(&ray.widen(), &wide, |t| L::narrow(t).widen()));
    hit.mask = hit.mask & candidates;
    hit
}

/// False only where the ray's line certainly passes the axis line at more than the radius: the distance is
/// `|f . n| / |n|` with `n` the product of direction and axis. The sum of magnitudes stands for `|n|`: up to 1.7 times
/// too large, but safe from underflow. NaN and overflow count as doubt.
#[inline(always)]
fn may_hit<L: Lane>(ray: &RayLanes<L>, c: &Lanes<L>) -> L::Mask {
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

/// The box of a cylinder, rounded outwards: along each axis a cap reaches `r sqrt(1 - a^2)` with `a` the share of the
/// cylinder's axis in it.
pub fn bounds(from: [f32; 3], to: [f32; 3], radius: f32) -> Aabb {
    let (from, to) = (from.map(f64::from), to.map(f64::from));
    let axis: [f64; 3] = std::array::from_fn(|k| to[k] - from[k]);
    let length2: f64 = axis.iter().map(|a| a * a).sum();
    let reach = axis.map(|a| f64::from(radius) * (1.0 - a * a / length2).max(0.0).sqrt() * (1.0 + 1e-14));
    let around = |c: [f64; 3], sign: f64| std::array::from_fn(|k| c[k] + sign * reach[k]);
    Aabb::around([around(from, -1.0), around(from, 1.0), around(to, -1.0), around(to, 1.0)])
}

#[cfg(test)]
mod tests;
