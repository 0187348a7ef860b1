//! What rounding could change of where lines meet curved surfaces.

use crate::math::{Lane, Real, Vec3, gamma_of};

/// What a line leaves of a radius: `r^2 - |a|^2` with `a` the way from the axis to the line, and how far that may be off.
#[derive(Clone, Copy, Debug)]
pub(super) struct Doubt<L> {
    pub(super) value: L,
    /// Squared.
    error2: L,
}

/// Roundings that a component of the way across may have seen; at most twenty are counted.
const ROUNDINGS: u32 = 32;

impl<L: Lane> Doubt<L> {
    /// Of the squared radius, the squared length of the way across, and that of the offset `f` it was computed from.
    ///
    /// With `g` some roundoffs, a component across is off by at most `e = g (|fx| + |fy| + |fz|)`, at most `1.8 g |f|`, so the
    /// square of its length by `2 e (|ax| + |ay| + |az|) + 3 e^2`, at most `6 g |f| |a| + 9 g^2 |f|^2`. The sum of that and
    /// `g (r^2 + |a|^2)`, squared, is less than `108 g^2 (|f|^2 + m) (m + 3 g^2 |f|^2)` with `m = r^2 + |a|^2`. In squares no
    /// root is taken, and nothing of `f32` leaves the range of `f64`.
    #[inline(always)]
    pub(super) fn new(r2: L, across2: L, offset2: L) -> Self {
        let roundings = gamma_of(ROUNDINGS, <L::Scalar as Real>::ROUNDOFF).powi(2);
        let [of_offset, of_all] = [3.0, 128.0].map(|times| L::constant(times * roundings));
        let m = r2 + across2;
        Self { value: r2 - across2, error2: (offset2 + m) * (m + offset2 * of_offset) * of_all }
    }

    /// Lanes whose sign is uncertain, NaN among them.
    #[inline(always)]
    pub(super) fn is_open(&self) -> L::Mask {
        !(self.value * self.value).gt(self.error2)
    }
}

/// By how much a squared distance at `t` has to exceed a squared radius for no root, as it will be found, to lie before:
/// some thousand roundoffs of the squared way there, where those of points, roots and their distances are some hundred.
#[inline(always)]
pub(super) fn rounding_at<L: Lane>(t: L, offset2: L, direction2: L) -> L {
    (offset2 + t * t * direction2) * L::constant(gamma_of(4096, <L::Scalar as Real>::ROUNDOFF))
}

/// Of what the place of a ray's start may be off by, how many times as much it has to be away from a surface ahead for the way there
/// to be known to nine digits.
const CLOSE: f64 = (1u64 << 28) as f64;

/// By how much a start has to be away from a surface, of what its place may be off by: as much as makes `t` good where the surface is
/// ahead, and elsewhere no more than it takes to know that it is not.
#[inline(always)]
pub(super) fn clearance<L: Lane>(error: L, is_ahead: L::Mask) -> L {
    L::select(is_ahead, error * L::constant(CLOSE), error)
}

/// The sum of magnitudes.
#[inline(always)]
pub(super) fn size<L: Lane>(v: Vec3<L>) -> L {
    v.x.abs() + v.y.abs() + v.z.abs()
}

/// Lanes of the tier that promises what exact arithmetic says.
#[inline(always)]
pub(super) fn is_exact<L: Lane>() -> bool {
    <L::Scalar as Real>::ROUNDOFF <= f64::ROUNDOFF
}

/// The root of a quadratic that is nearer to zero, no farther than the other: rounding makes anything of it, or NaN, where a ray
/// starts at the point where it touches.
#[inline(always)]
pub(super) fn no_farther<L: Lane>(near: L, far: L) -> L {
    near.max(-far.abs()).min(far.abs())
}

/// The roots of `a t^2 + 2 b t + c`, the lesser first, from the root of the discriminant too: neither loses digits that these have,
/// nor its sign.
pub(super) fn roots([a, b, c]: [f64; 3], root: f64) -> [f64; 2] {
    let q = -(b + root.copysign(b));
    let (t0, t1) = (q / a, c / q);
    // A NaN of `c / q`, from a ray that starts at the point where it touches, gives the other root.
    [t1.min(t0), t1.max(t0)]
}
