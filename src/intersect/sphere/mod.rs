//! Ray against sphere.
//!
//! Plainly: `|o + t d - c|^2 = r^2` is a quadratic in `t`. Departures:
//! - the discriminant comes from the part of `o - c` perpendicular to the ray, `r^2 - |f - d (f.d / d.d)|^2`, because
//!   `b^2 - 4ac` cancels for far or huge spheres (Haines et al., Precision Improvements for Ray/Sphere Intersection,
//!   Ray Tracing Gems, ch. 7, 2019);
//! - the root nearer to zero comes from `c / q`, not from a difference (same source);
//! - in the `Watertight` tier `f32` lanes only sort out what certainly misses and `f64` decides, which also holds radii
//!   from 1e-30 to 1e30 and directions of length 1e-20 to 1e20.

pub mod oracle;

use crate::intersect::doubt::{self, Doubt};
use crate::intersect::oracle::number::Unit;
use crate::intersect::{LaneHit, RayLanes};
use crate::math::{
    Aabb, Lane, Mask, Ring, Vec3, fused_dot, gamma, pairs, ring_cross, ring_dot, sign, two_sum,
};

/// Spheres as lanes.
#[derive(Clone, Copy, Debug)]
pub struct Lanes<L> {
    /// Centres.
    pub center: Vec3<L>,
    /// Radii, positive.
    pub radius: L,
}

impl<L: Lane> Lanes<L> {
    #[inline(always)]
    fn widen(&self) -> Lanes<L::Double> {
        Lanes { center: self.center.widen(), radius: self.radius.widen() }
    }
}

/// The first point of each sphere beyond `t_min`, in the number type of the lanes.
#[inline(always)]
pub fn solve<L: Lane>(ray: &RayLanes<L>, s: &Lanes<L>) -> LaneHit<L> {
    let (mask, roots) = roots(ray, s, |doubt| doubt.value);
    first_beyond(ray.t_min, mask, roots)
}

/// The lanes that meet their spheres, and where they enter and leave. `settle` gives the discriminant its sign where that is
/// in doubt.
#[inline(always)]
fn roots<L: Lane>(ray: &RayLanes<L>, s: &Lanes<L>, settle: impl Fn(Doubt<L>) -> L) -> (L::Mask, [L; 2]) {
    let (f, d) = (ray.origin - s.center, ray.direction);
    let (a, b) = (d.length_squared(), f.dot(d));
    let (r2, ff) = (s.radius * s.radius, f.length_squared());
    let across2 = (f - d * (b / a)).length_squared();
    let discriminant = settle(Doubt::new(r2, across2, ff));
    let mask = discriminant.ge(L::zero());
    let q = -(b + (a * discriminant).sqrt().with_sign_of(b));
    let c = ff - r2;
    let (near, far) = (q / a, c / q);
    // In this order a NaN of `c / q`, from a ray that starts at the point where it touches, gives the other root.
    (mask, [far.min(near), far.max(near)])
}

/// The root beyond `t_min`, chosen by the `t` that the caller will see.
#[inline(always)]
fn first_beyond<L: Lane>(t_min: L, mask: L::Mask, [near, far]: [L; 2]) -> LaneHit<L> {
    LaneHit { mask, t: L::select(near.gt(t_min), near, far), u: L::zero(), v: L::zero() }
}

/// The same in `f64`, for the lanes that [`may_hit`].
#[inline(always)]
pub fn solve_widened<L: Lane>(lanes: L::Mask, ray: &RayLanes<L>, s: &Lanes<L>) -> LaneHit<L> {
    // Free lanes hold NaN, of which nothing is asked.
    let (wide_ray, wide) = (ray.widen(), s.widen());
    let lanes = lanes & !L::narrow_mask(leaves(&wide_ray, &wide));
    if !lanes.any() {
        return LaneHit::none();
    }
    let wide_lanes = L::widen_mask(lanes & s.radius.gt(L::zero()));
    let settle = |doubt: Doubt<L::Double>| match doubt::is_exact::<L>() {
        true => {
            doubt.settle(wide_lanes, |i| is_met(&wide_ray.get(i), wide.center.get(i), wide.radius.get(i)))
        }
        false => doubt.value,
    };
    let (met, roots) = roots(&wide_ray, &wide, settle);
    first_beyond(ray.t_min, lanes & L::narrow_mask(met), roots.map(L::narrow))
}

/// Lanes that start outside or at the surface and go away from it, as most rays do that left it: neither of their [`roots`] is
/// positive.
#[inline(always)]
fn leaves<L: Lane>(ray: &RayLanes<L>, s: &Lanes<L>) -> L::Mask {
    let (f, zero) = (ray.origin - s.center, L::zero());
    let is_outside = (f.length_squared() - s.radius * s.radius).ge(zero);
    f.dot(ray.direction).ge(zero) & is_outside & ray.t_min.ge(zero)
}

/// Whether the line meets the sphere, exactly; NaN, infinities and rays that go nowhere meet nothing.
fn is_met(ray: &RayLanes<f64>, center: [f64; 3], radius: f64) -> bool {
    let (origin, d) = (ray.origin.get(0), ray.direction.get(0));
    let f: [_; 3] = std::array::from_fn(|k| two_sum(origin[k], -center[k]));
    let size = (doubt::size(ray.direction) * (f.iter().map(|x| x[0].abs()).sum::<f64>() + radius)).powi(2);
    size.is_finite()
        && d != [0.0; 3]
        && sign(inside(&f, &pairs(d), &[radius, 0.0]), size, || {
            let unit = Unit::of(origin.into_iter().chain(center).chain([radius]));
            let f = std::array::from_fn(|k| unit.lift(origin[k]) - unit.lift(center[k]));
            inside(&f, &d.map(|x| Unit::of(d).lift(x)), &unit.lift(radius))
        })
        .is_ge()
}

/// `r^2 |d|^2 - |f x d|^2`: what the squares of radius and distance leave, times that of the direction's length.
fn inside<N: Ring>(f: &[N; 3], d: &[N; 3], radius: &N) -> N {
    let n = ring_cross(f, d);
    radius.squared().times(&ring_dot(d, d)).minus(&ring_dot(&n, &n))
}

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

/// The box of a sphere, rounded outwards.
pub fn bounds(center: [f32; 3], radius: f32) -> Aabb {
    let at = |sign: f64| center.map(|c| f64::from(c) + sign * f64::from(radius));
    Aabb::around([at(-1.0), at(1.0)])
}

#[cfg(test)]
mod tests;
