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

mod exactly;
pub mod oracle;
mod products;

use self::products::{Fused, Plain, Products};
use crate::intersect::doubt;
use crate::intersect::{LaneHit, RayLanes};
use crate::math::{Aabb, Lane, Mask, Real, Vec3, fused_dot, gamma};

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

/// A line and an infinite cylinder, from the parts of offset and direction across its axis.
struct Side<L> {
    /// Squared lengths of `f` and `d`, and their product.
    f2: L,
    a: L,
    b: L,
    radius: L,
    /// What the origin is outside: `f2 - r^2`.
    outside: L,
    /// Squared distance of the line from the axis.
    across2: L,
    discriminant: L,
    /// `(a discriminant)^1/2`.
    root: L,
}

/// Roundoffs by which lengths across the axis, and heights, may be off: at most forty are counted.
const ROUNDINGS: f64 = 128.0;

impl<L: Lane> Side<L> {
    #[inline(always)]
    fn new<P: Products>(f: Vec3<L>, d: Vec3<L>, radius: L) -> Self {
        let (f2, a, b) = (P::dot(f, f), P::dot(d, d), P::dot(f, d));
        let across = P::less(f, d, b / a);
        let across2 = P::dot(across, across);
        let discriminant = radius * radius - across2;
        let (outside, root) = (f2 - radius * radius, (a * discriminant).sqrt());
        Self { f2, a, b, radius, outside, across2, discriminant, root }
    }

    #[inline(always)]
    fn is_met(&self) -> L::Mask {
        self.discriminant.ge(L::zero())
    }

    /// When the ray is inside.
    #[inline(always)]
    fn inside(&self) -> Interval<L> {
        let (a, b) = (self.a, self.b);
        let q = -(b + self.root.with_sign_of(b));
        let (far, near) = (q / a, self.outside / q);
        // Of a ray along the axis the root may be lost to underflow in `f32`, and `far` with it.
        let is_f64 = <L::Scalar as Real>::ROUNDOFF <= f64::ROUNDOFF;
        let near = if is_f64 { doubt::no_farther(near, far) } else { near };
        // In this order a NaN of `near`, from a ray that starts at the point where it touches, gives the other root.
        let crossing = Interval { first: near.min(far), last: near.max(far) };
        let meets = Interval::select(self.is_met(), crossing, Interval::all_where(L::Mask::splat(false)));
        let parallel = Interval::all_where(self.outside.le(L::zero()));
        Interval::select(a.gt(L::zero()), meets, parallel)
    }

    /// Lanes in which rounding could change whether the line meets it, those along the axis among them: what is lost of
    /// `d` turns it, the more the less of it is across the axis. A way across that is off by `e` changes the discriminant
    /// by no more than `4 e max(r, |across|)` while that matters. In squares, so that nothing is divided and no root taken;
    /// NaN counts as open.
    #[inline(always)]
    fn is_open(&self, sizes: &Sizes<L>) -> L::Mask {
        let reach2 = self.radius * self.radius + self.across2;
        let e2 = sizes.offset2 * self.a + self.f2 * sizes.direction2;
        !(self.discriminant * self.discriminant * self.a).gt(reach2 * e2 * roundoffs_squared::<L>(32.0))
    }

    /// Lanes that start so near to the side that rounding could put them on the other side of it, or leave too little of a `t` ahead.
    /// What a way across is off by, `e`, changes its square by `2 e |f|` and `e^2`. Else the roots have the signs that they have
    /// exactly.
    #[inline(always)]
    fn is_started_at(&self, sizes: &Sizes<L>) -> L::Mask {
        let e = doubt::clearance(L::constant(start_roundoffs::<L>()), (self.outside * self.b).lt(L::zero()));
        let (e2, reach2) = (sizes.offset2 * e * e, self.f2 + self.radius * self.radius);
        !(self.outside * self.outside).gt((reach2 + e2) * e2)
    }
}

/// Squared lengths.
struct Sizes<L> {
    offset2: L,
    direction2: L,
}

/// Of what lengths across the axis, and heights, may be off by.
#[inline(always)]
fn roundoffs_squared<L: Lane>(times: f64) -> L {
    let e = ROUNDINGS * <L::Scalar as Real>::ROUNDOFF;
    L::constant(times * e * e)
}

/// Of lengths where a ray starts, counted closely: rays that have left a surface start a hundred roundoffs away from it, and are to be
/// in no doubt. Four of a way across add up along it and twelve across it, up to fourteen make a height.
#[inline(always)]
fn start_roundoffs<L: Lane>() -> f64 {
    16.0 * <L::Scalar as Real>::ROUNDOFF
}

/// Heights along the axis, times its length.
struct Rims<L> {
    along_f: L,
    along_d: L,
    axis2: L,
}

impl<L: Lane> Rims<L> {
    /// Lanes in which the line meets the side so near the height of a cap that rounding could change which comes first. What
    /// a length is off by moves a root by `e r / root`, and its height by that times the speed along the axis; multiplied by
    /// the root, so that a ray that touches divides nothing by zero, and in squares. NaN counts as near.
    #[inline(always)]
    fn are_close(&self, sizes: &Sizes<L>, side: &Side<L>, at: Interval<L>) -> L::Mask {
        let half = self.axis2 * L::constant(0.5);
        let beside = |t: L| ((self.along_f + t * self.along_d - half).abs() - half).abs();
        let clear = beside(at.first).min(beside(at.last));
        let (root2, last) = (side.root * side.root, at.first.abs().max(at.last.abs()));
        let e2 = sizes.offset2 + last * last * sizes.direction2;
        let steepness = side.radius * self.along_d;
        let moved2 = e2 * (self.axis2 * root2 + steepness * steepness);
        !(clear * clear * root2).gt(moved2 * roundoffs_squared::<L>(4.0))
    }

    /// Lanes in which the plane of a cap, met at `t`, is so near to where the ray starts that rounding could put it on the other
    /// side, or leave too little of `t`.
    #[inline(always)]
    fn are_started_at(&self, sizes: &Sizes<L>, t: L) -> L::Mask {
        let e = doubt::clearance(L::constant(start_roundoffs::<L>()), t.gt(L::zero()));
        let height = t * self.along_d;
        !(height * height).gt(sizes.offset2 * self.axis2 * (e * e))
    }
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

/// The part of a line inside a capped cylinder.
#[derive(Clone, Copy, Debug)]
struct Chord<L: Lane> {
    first: L,
    last: L,
    /// Empty elsewhere.
    inside: L::Mask,
    enters_on_side: L::Mask,
    leaves_on_side: L::Mask,
}

impl<L: Lane> Chord<L> {
    #[inline(always)]
    fn of(side: Interval<L>, slab: Interval<L>) -> Self {
        let (first, last) = (side.first.max(slab.first), side.last.min(slab.last));
        Self {
            first,
            last,
            inside: first.le(last),
            enters_on_side: side.first.ge(slab.first),
            leaves_on_side: side.last.le(slab.last),
        }
    }

    /// Lanes in which the ray starts so near to an end that rounding could change on which side of it that is, or too much
    /// of `t`.
    #[inline(always)]
    fn starts_at_an_end(&self, sizes: &Sizes<L>, side: &Side<L>, rims: &Rims<L>) -> L::Mask {
        let at_side = (self.enters_on_side | self.leaves_on_side) & side.is_started_at(sizes);
        let at_first = rims.are_started_at(sizes, self.first) & !self.enters_on_side;
        let at_last = rims.are_started_at(sizes, self.last) & !self.leaves_on_side;
        self.inside & (at_side | at_first | at_last)
    }

    /// The first boundary beyond `t_min`: `(hit, t, on the side rather than a cap)`.
    #[inline(always)]
    fn first_beyond(self, t_min: L, capped: L::Mask, round: impl Fn(L) -> L) -> (L::Mask, L, L::Mask) {
        let (first, last) = (round(self.first), round(self.last));
        // An open cylinder has no surface where the ray enters or leaves through a cap.
        let enters = first.gt(t_min) & (capped | self.enters_on_side);
        let leaves = last.gt(t_min) & (capped | self.leaves_on_side);
        let on_side = (enters & self.enters_on_side) | (!enters & self.leaves_on_side);
        (self.inside & (enters | leaves), L::select(enters, first, last), on_side)
    }

    /// With some lanes as exact arithmetic finds them.
    #[cold]
    fn settled(self, lanes: u32, chord: impl Fn(usize) -> Option<exactly::Chord>) -> Self {
        (0..L::WIDTH).filter(|i| lanes >> i & 1 != 0).fold(self, |all, i| {
            let here = L::Mask::from_bits(1 << i);
            let Some(chord) = chord(i) else { return Self { inside: all.inside & !here, ..all } };
            let real = |t: f64| L::constant(t);
            let set = |mask: L::Mask, value: bool| if value { mask | here } else { mask & !here };
            Self {
                first: L::select(here, real(chord.first), all.first),
                last: L::select(here, real(chord.last), all.last),
                inside: all.inside | here,
                enters_on_side: set(all.enters_on_side, chord.on_side[0]),
                leaves_on_side: set(all.leaves_on_side, chord.on_side[1]),
            }
        })
    }
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
    let mut hit =
        LaneHit::narrow(solve_rounded::<_, Plain>(&wide_ray, &wide, |t| L::narrow(t).widen(), settle));
    hit.mask = hit.mask & lanes;
    hit
}

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
