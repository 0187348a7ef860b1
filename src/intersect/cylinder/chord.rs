//! When a ray is inside of a closed cylinder: inside of the side and between the planes of the caps.

use super::exactly;
use super::products::Products;
use crate::intersect::doubt;
use crate::math::{Lane, Mask, Real, Vec3};

/// An interval of `t`, empty where `first > last`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interval<L> {
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

/// A line and an infinite cylinder, from the parts of offset and direction across its axis.
pub(super) struct Side<L> {
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
    pub(super) fn new<P: Products>(f: Vec3<L>, d: Vec3<L>, radius: L) -> Self {
        let (f2, a, b) = (P::dot(f, f), P::dot(d, d), P::dot(f, d));
        let across = P::less(f, d, b / a);
        let across2 = P::dot(across, across);
        let discriminant = radius * radius - across2;
        let (outside, root) = (f2 - radius * radius, (a * discriminant).sqrt());
        Self { f2, a, b, radius, outside, across2, discriminant, root }
    }

    #[inline(always)]
    pub(super) fn is_met(&self) -> L::Mask {
        self.discriminant.ge(L::zero())
    }

    /// When the ray is inside.
    #[inline(always)]
    pub(super) fn inside(&self) -> Interval<L> {
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
    pub(super) fn is_open(&self, sizes: &Sizes<L>) -> L::Mask {
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
pub(super) struct Sizes<L> {
    pub(super) offset2: L,
    pub(super) direction2: L,
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
pub(super) struct Rims<L> {
    pub(super) along_f: L,
    pub(super) along_d: L,
    pub(super) axis2: L,
}

impl<L: Lane> Rims<L> {
    /// Lanes in which the line meets the side so near the height of a cap that rounding could change which comes first. What
    /// a length is off by moves a root by `e r / root`, and its height by that times the speed along the axis; multiplied by
    /// the root, so that a ray that touches divides nothing by zero, and in squares. NaN counts as near.
    #[inline(always)]
    pub(super) fn are_close(&self, sizes: &Sizes<L>, side: &Side<L>, at: Interval<L>) -> L::Mask {
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
pub(super) fn between_caps<L: Lane>(along_f: L, along_d: L, axis2: L) -> Interval<L> {
    let zero = L::zero();
    let (t0, t1) = (-along_f / along_d, (axis2 - along_f) / along_d);
    let crossing = Interval { first: t0.min(t1), last: t0.max(t1) };
    let parallel = Interval::all_where(along_f.ge(zero) & along_f.le(axis2));
    Interval::select(along_d.eq(zero), parallel, crossing)
}

/// The part of a line inside a capped cylinder.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chord<L: Lane> {
    first: L,
    last: L,
    /// Empty elsewhere.
    inside: L::Mask,
    enters_on_side: L::Mask,
    leaves_on_side: L::Mask,
}

impl<L: Lane> Chord<L> {
    #[inline(always)]
    pub(super) fn of(side: Interval<L>, slab: Interval<L>) -> Self {
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
    pub(super) fn starts_at_an_end(&self, sizes: &Sizes<L>, side: &Side<L>, rims: &Rims<L>) -> L::Mask {
        let at_side = (self.enters_on_side | self.leaves_on_side) & side.is_started_at(sizes);
        let at_first = rims.are_started_at(sizes, self.first) & !self.enters_on_side;
        let at_last = rims.are_started_at(sizes, self.last) & !self.leaves_on_side;
        self.inside & (at_side | at_first | at_last)
    }

    /// The first boundary beyond `t_min`: `(hit, t, on the side rather than a cap)`.
    #[inline(always)]
    pub(super) fn first_beyond(
        self,
        t_min: L,
        capped: L::Mask,
        round: impl Fn(L) -> L,
    ) -> (L::Mask, L, L::Mask) {
        let (first, last) = (round(self.first), round(self.last));
        // An open cylinder has no surface where the ray enters or leaves through a cap.
        let enters = first.gt(t_min) & (capped | self.enters_on_side);
        let leaves = last.gt(t_min) & (capped | self.leaves_on_side);
        let on_side = (enters & self.enters_on_side) | (!enters & self.leaves_on_side);
        (self.inside & (enters | leaves), L::select(enters, first, last), on_side)
    }

    /// With some lanes as exact arithmetic finds them.
    #[cold]
    pub(super) fn settled(self, lanes: u32, chord: impl Fn(usize) -> Option<exactly::Chord>) -> Self {
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
