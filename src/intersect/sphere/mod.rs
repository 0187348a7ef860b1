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
mod sift;

pub use self::sift::{is_behind, is_beyond, may_hit, surely_hits};

use crate::intersect::doubt::{self, Doubt};
use crate::intersect::{LaneHit, RayLanes};
use crate::math::{Aabb, Lane, Mask, Real, Vec3, gamma_of};

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

/// The box of a sphere, rounded outwards.
pub fn bounds(center: [f32; 3], radius: f32) -> Aabb {
    let at = |sign: f64| center.map(|c| f64::from(c) + sign * f64::from(radius));
    Aabb::around([at(-1.0), at(1.0)])
}

#[cfg(test)]
mod tests;
