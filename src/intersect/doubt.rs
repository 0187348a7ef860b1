//! Discriminants whose sign rounding could change, and what gives it to them in tier `Exact`.

use crate::math::{Lane, Mask, Real, Vec3, gamma_of};

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

    /// The value, with the sign that `is_met` gives to lanes in doubt: zero, or less.
    #[inline(always)]
    pub(super) fn settle(self, lanes: L::Mask, is_met: impl Fn(usize) -> bool) -> L {
        let doubtful = lanes & self.is_open();
        if doubtful.any() { self.settle_lanes(doubtful.bits(), is_met) } else { self.value }
    }

    #[cold]
    fn settle_lanes(self, lanes: u32, is_met: impl Fn(usize) -> bool) -> L {
        let zero = L::zero();
        (0..L::WIDTH).filter(|i| lanes >> i & 1 != 0).fold(self.value, |value, i| {
            let settled = if is_met(i) { value.max(zero) } else { -L::one() };
            L::select(L::Mask::from_bits(1 << i), settled, value)
        })
    }
}

/// By how much a squared distance at `t` has to exceed a squared radius for no root, as it will be found, to lie before:
/// some thousand roundoffs of the squared way there, where those of points, roots and their distances are some hundred.
#[inline(always)]
pub(super) fn rounding_at<L: Lane>(t: L, offset2: L, direction2: L) -> L {
    (offset2 + t * t * direction2) * L::constant(gamma_of(4096, <L::Scalar as Real>::ROUNDOFF))
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
