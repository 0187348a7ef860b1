//! Discriminants whose sign rounding could change, and what gives it to them in tier `Exact`.

use crate::math::{Lane, Mask, Real, Vec3, gamma_of};

/// What a line leaves of a radius: `r^2 - |a|^2` with `a` the way from the axis to the line, and how far that may be off.
#[derive(Clone, Copy, Debug)]
pub(super) struct Doubt<L> {
    pub(super) value: L,
    error: L,
}

/// Roundings that a component of the way across may have seen; at most twenty are counted, each of at most `size`.
const ROUNDINGS: u32 = 32;

impl<L: Lane> Doubt<L> {
    /// `size` is the sum of magnitudes that `across` was computed from: each of its components is off by at most `e`, some
    /// roundoffs of that, and so the square of its length by `2 e |a| + 3 e^2`, with the sum of magnitudes for `|a|`.
    #[inline(always)]
    pub(super) fn new(r2: L, across: Vec3<L>, size: L) -> Self {
        let roundings = L::constant(gamma_of(ROUNDINGS, <L::Scalar as Real>::ROUNDOFF));
        let (e, reach, a2) = (size * roundings, self::size(across), across.length_squared());
        Self { value: r2 - a2, error: e * (reach + reach + e * L::constant(3.0)) + (r2 + a2) * roundings }
    }

    /// Lanes whose sign is uncertain, NaN among them.
    #[inline(always)]
    pub(super) fn is_open(&self) -> L::Mask {
        !self.value.abs().gt(self.error)
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
