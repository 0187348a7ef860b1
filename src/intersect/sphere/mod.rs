//! Ray against sphere.
//!
//! Plainly: `|o + t d - c|^2 = r^2` is a quadratic in `t`. Departures:
//! - the discriminant comes from the part of `o - c` perpendicular to the ray, `r^2 - |f - d (f.d / d.d)|^2`, because
//!   `b^2 - 4ac` cancels for far or huge spheres (Haines et al., Precision Improvements for Ray/Sphere Intersection,
//!   Ray Tracing Gems, ch. 7, 2019);
//! - the root nearer to zero comes from `c / q`, not from a difference (same source);
//! - in the `Watertight` tier `f32` lanes only sort out what certainly misses and `f64` decides, which also holds radii
//!   from 1e-30 to 1e30 and directions of length 1e-20 to 1e20;
//! - in tier `Exact` lanes in which rounding could change whether the line meets the sphere, or whether that is before or
//!   behind where the ray starts, are decided without rounding ([`exactly`]).

mod exactly;
pub mod oracle;

use crate::intersect::doubt::{self, Doubt};
use crate::intersect::{LaneHit, RayLanes};
use crate::math::{Aabb, Lane, Mask, Real, Vec3, fused_dot, gamma, gamma_of};

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
    let chord = chord(ray, s, |_, chord| chord);
    first_beyond(ray.t_min, chord.inside, [chord.first, chord.last])
}

/// The part of a line inside a sphere.
#[derive(Clone, Copy, Debug)]
struct Chord<L: Lane> {
    first: L,
    last: L,
    /// Empty elsewhere.
    inside: L::Mask,
}

/// Where lines are inside their spheres. `settle` is given the lanes in which rounding could change whether they are at all, or on
/// which side of zero that ends.
#[inline(always)]
fn chord<L: Lane>(
    ray: &RayLanes<L>,
    s: &Lanes<L>,
    settle: impl Fn(L::Mask, Chord<L>) -> Chord<L>,
) -> Chord<L> {
    let (f, d) = (ray.origin - s.center, ray.direction);
    let (a, b) = (d.length_squared(), f.dot(d));
    let start = Start::new(f, s.radius);
    let across2 = (f - d * (b / a)).length_squared();
    let doubt = Doubt::new(start.r2, across2, start.offset2);
    let inside = doubt.value.ge(L::zero());
    let q = -(b + (a * doubt.value).sqrt().with_sign_of(b));
    let far = q / a;
    let near = doubt::no_farther(start.outside / q, far);
    let chord = Chord { first: near.min(far), last: near.max(far), inside };
    settle(doubt.is_open() | (inside & start.is_open(b)), chord)
}

/// The root beyond `t_min`, chosen by the `t` that the caller will see.
#[inline(always)]
fn first_beyond<L: Lane>(t_min: L, mask: L::Mask, [first, last]: [L; 2]) -> LaneHit<L> {
    LaneHit { mask, t: L::select(first.gt(t_min), first, last), u: L::zero(), v: L::zero() }
}

/// Where a ray starts: outside of the sphere, or inside.
struct Start<L> {
    offset2: L,
    r2: L,
    /// `|f|^2 - r^2`
    outside: L,
}

impl<L: Lane> Start<L> {
    #[inline(always)]
    fn new(offset: Vec3<L>, radius: L) -> Self {
        let (offset2, r2) = (offset.length_squared(), radius * radius);
        Self { offset2, r2, outside: offset2 - r2 }
    }

    /// More than what `outside` may be off by: five roundings of one square and two of the other.
    #[inline(always)]
    fn error(&self) -> L {
        (self.offset2 + self.r2) * L::constant(gamma_of(8, <L::Scalar as Real>::ROUNDOFF))
    }

    /// Lanes that start so near to the surface that rounding could put them on its other side, or leave too little of a `t` ahead. Else
    /// the roots have the signs that they have exactly. `away` is `f . d`.
    #[inline(always)]
    fn is_open(&self, away: L) -> L::Mask {
        let is_ahead = (self.outside * away).lt(L::zero());
        !self.outside.abs().gt(doubt::clearance(self.error(), is_ahead))
    }
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
    let settle = |open: <L::Double as Lane>::Mask, chord: Chord<L::Double>| {
        let open = open & wide_lanes;
        if !doubt::is_exact::<L>() || !open.any() {
            return chord;
        }
        chord
            .settled(open.bits(), |i| exactly::ends(&wide_ray.get(i), wide.center.get(i), wide.radius.get(i)))
    };
    let chord = chord(&wide_ray, &wide, settle);
    let roots = [chord.first, chord.last].map(L::narrow);
    first_beyond(ray.t_min, lanes & L::narrow_mask(chord.inside), roots)
}

impl<L: Lane> Chord<L> {
    /// With some lanes as exact arithmetic finds them.
    #[cold]
    fn settled(self, lanes: u32, ends: impl Fn(usize) -> Option<[f64; 2]>) -> Self {
        (0..L::WIDTH).filter(|i| lanes >> i & 1 != 0).fold(self, |all, i| {
            let here = L::Mask::from_bits(1 << i);
            let Some(ends) = ends(i) else { return Self { inside: all.inside & !here, ..all } };
            let [first, last] = ends.map(L::constant);
            Self {
                first: L::select(here, first, all.first),
                last: L::select(here, last, all.last),
                inside: all.inside | here,
            }
        })
    }
}

/// Lanes that certainly start outside and go away from it, as most rays do that left it: as [`chord`] finds them,
/// neither root is positive.
#[inline(always)]
fn leaves<L: Lane>(ray: &RayLanes<L>, s: &Lanes<L>) -> L::Mask {
    let (f, zero) = (ray.origin - s.center, L::zero());
    let start = Start::new(f, s.radius);
    f.dot(ray.direction).ge(zero) & start.outside.gt(start.error()) & ray.t_min.ge(zero)
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
