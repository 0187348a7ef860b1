//! Ray against cylinder, capped or open, any axis.
//!
//! Plainly: the ray is inside the infinite cylinder during one interval of `t` and between the planes of the caps during
//! another; it is inside the capped cylinder during their intersection. The hit is where that begins, or where it ends
//! for a ray that starts inside. Since side and caps are decided by the same two intervals there is no rim gap, which
//! separate tests of side (by height) and caps (by radius) have.
//! - The side's quadratic uses perpendicular components, as [`super::sphere`] does.
//! - In tier `Fast` products are added fused: fewer roundings, and quicker ([`products`]).
//! - A ray along the axis, or across it, makes one interval all or nothing instead of dividing by zero.
//! - In tier `Exact` lanes in which rounding could change whether the chord is there, whether a cap or the side ends it, or
//!   whether it ends before or behind where the ray starts, are decided without rounding ([`exactly`]).

mod chord;
mod exactly;
pub mod oracle;
mod products;
mod sift;

use self::chord::{Chord, Rims, Side, Sizes, between_caps};
use self::products::{Fused, Plain, Products};
pub use self::sift::{is_behind, is_beyond, may_hit, surely_hits};
use crate::intersect::doubt;
use crate::intersect::{LaneHit, RayLanes};
use crate::math::{Aabb, Lane, Mask, Vec3};

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

impl<L: Lane> Lanes<L> {
    /// Lane `i`.
    fn get(&self, i: usize) -> Lanes<L::Scalar> {
        let one = |v: Vec3<L>| Vec3::splat(v.get(i));
        let capped = self.capped.bits() >> i & 1 != 0;
        Lanes { from: one(self.from), to: one(self.to), radius: self.radius.get(i), capped }
    }
}

/// The first point of each cylinder beyond `t_min`, in the number type of the lanes.
#[inline(always)]
pub fn solve<L: Lane>(ray: &RayLanes<L>, c: &Lanes<L>) -> LaneHit<L> {
    solve_rounded::<L, Fused>(ray, c, |t| t, |_, chord| chord)
}

/// `round` is what becomes of `t` later: the end beyond `t_min` is chosen by the `t` that the caller will see. `settle` is
/// given the lanes in which rounding could change whether the chord is there, what ends it, and on which side of zero.
#[inline(always)]
fn solve_rounded<L: Lane, P: Products>(
    ray: &RayLanes<L>,
    c: &Lanes<L>,
    round: impl Fn(L) -> L,
    settle: impl Fn(L::Mask, Chord<L>) -> Chord<L>,
) -> LaneHit<L> {
    let axis = c.to - c.from;
    let f = ray.origin - c.from;
    let (axis2, along_f, along_d) = (P::dot(axis, axis), P::dot(f, axis), P::dot(ray.direction, axis));
    // Not fused: where the axis is parallel to one of the world's, what is along it cancels without rest, or that of a ray far
    // along a wire would be more than its radius.
    let f_across = f - axis * (along_f / axis2);
    let d_across = P::less(ray.direction, axis, along_d / axis2);
    let side = Side::new::<P>(f_across, d_across, c.radius);
    let (within, between) = (side.inside(), between_caps(along_f, along_d, axis2));
    let sizes = Sizes { offset2: f.length_squared(), direction2: ray.direction.length_squared() };
    let rims = Rims { along_f, along_d, axis2 };
    let open = side.is_open(&sizes) | (side.is_met() & rims.are_close(&sizes, &side, within));
    let chord = Chord::of(within, between);
    let chord = settle(open | chord.starts_at_an_end(&sizes, &side, &rims), chord);
    let (mask, t, on_side) = chord.first_beyond(ray.t_min, c.capped, round);
    let height = (along_f + t * along_d) / axis2;
    let (zero, half, one) = (L::zero(), L::constant(0.5), L::one());
    let cap = L::select(height.lt(half), one, one + one);
    LaneHit { mask, t, u: L::select(on_side, zero, cap), v: height.clamp(zero, one) }
}

/// Lanes that start outside of the side and go away from the axis, as most rays do that left it: as [`solve_rounded`] finds it
/// where nothing is settled, their chord ends at zero or before.
#[inline(always)]
fn leaves<L: Lane>(ray: &RayLanes<L>, c: &Lanes<L>) -> L::Mask {
    let (axis, f, d, zero) = (c.to - c.from, ray.origin - c.from, ray.direction, L::zero());
    let axis2 = axis.length_squared();
    let f_across = f - axis * (f.dot(axis) / axis2);
    let d_across = d - axis * (d.dot(axis) / axis2);
    let is_outside = (f_across.length_squared() - c.radius * c.radius).gt(zero);
    f_across.dot(d_across).ge(zero) & is_outside & ray.t_min.ge(zero)
}

/// The same in `f64`, for the lanes that [`may_hit`].
#[inline(always)]
pub fn solve_widened<L: Lane>(lanes: L::Mask, ray: &RayLanes<L>, c: &Lanes<L>) -> LaneHit<L> {
    let wide = Lanes {
        from: c.from.widen(),
        to: c.to.widen(),
        radius: c.radius.widen(),
        capped: L::widen_mask(c.capped),
    };
    let wide_ray = ray.widen();
    let lanes = match doubt::is_exact::<L>() {
        true => lanes,
        false => lanes & !L::narrow_mask(leaves(&wide_ray, &wide)),
    };
    if !lanes.any() {
        return LaneHit::none();
    }
    // Free lanes hold NaN, of which nothing is asked.
    let wide_lanes = L::widen_mask(lanes & c.radius.gt(L::zero()));
    let settle = |open: <L::Double as Lane>::Mask, chord: Chord<L::Double>| {
        let open = open & wide_lanes;
        if !doubt::is_exact::<L>() || !open.any() {
            return chord;
        }
        chord.settled(open.bits(), |i| exactly::chord(&wide_ray.get(i), &wide.get(i)))
    };
    let hit = solve_rounded::<_, Plain>(&wide_ray, &wide, |t| L::narrow(t).widen(), settle);
    LaneHit::narrow(hit).among(lanes)
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
