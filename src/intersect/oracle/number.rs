//! Floating-point numbers as whole numbers of a common unit.

use dashu::integer::IBig;
use dashu::rational::Relaxed;

/// Mantissa and exponent of the last bit that is set; nothing for zero.
fn parts(x: f64) -> Option<(u64, i32)> {
    debug_assert!(x.is_finite());
    let bits = x.to_bits();
    let biased = (bits >> 52 & 0x7ff) as i32;
    let mantissa = (bits & ((1 << 52) - 1)) | if biased == 0 { 0 } else { 1 << 52 };
    let zeros = mantissa.trailing_zeros();
    (mantissa != 0).then(|| (mantissa >> zeros, biased.max(1) - 1075 + zeros as i32))
}

/// A power of two, of which all numbers of a question are multiples.
#[derive(Clone, Copy)]
pub(in crate::intersect) struct Unit(i32);

impl Unit {
    /// The largest unit for these numbers, which keeps the whole numbers small.
    pub(in crate::intersect) fn of(numbers: impl IntoIterator<Item = f64>) -> Self {
        Self(numbers.into_iter().filter_map(|x| Some(parts(x)?.1)).min().unwrap_or(0))
    }
    /// How often the unit goes into the number.
    pub(in crate::intersect) fn lift(self, x: f64) -> IBig {
        let Some((mantissa, exponent)) = parts(x) else { return IBig::ZERO };
        let magnitude = IBig::from(mantissa) << (exponent - self.0) as usize;
        if x < 0.0 { -magnitude } else { magnitude }
    }
    /// The number that so many are of products of this unit and another, each so often a factor. Rounded once.
    pub(in crate::intersect) fn drop(
        self,
        times: usize,
        other: Self,
        other_times: usize,
        whole: IBig,
    ) -> f64 {
        let exponent = self.0 * times as i32 + other.0 * other_times as i32;
        let power = |exponent: i32| exponent.max(0) as usize;
        ratio(whole << power(exponent), IBig::ONE << power(-exponent))
    }
    pub(super) fn point(self, p: [f64; 3]) -> Point {
        Point(p.map(|x| self.lift(x)))
    }
}

/// A point or direction.
#[derive(Clone)]
pub(super) struct Point(pub(super) [IBig; 3]);

impl Point {
    pub(super) fn minus(&self, o: &Self) -> Self {
        Self(std::array::from_fn(|k| &self.0[k] - &o.0[k]))
    }
    pub(super) fn times(&self, s: &IBig) -> Self {
        Self(std::array::from_fn(|k| &self.0[k] * s))
    }
    pub(super) fn dot(&self, o: &Self) -> IBig {
        (0..3).map(|k| &self.0[k] * &o.0[k]).sum()
    }
    pub(super) fn cross(&self, o: &Self) -> Self {
        let term = |i: usize, j: usize| &self.0[i] * &o.0[j] - &self.0[j] * &o.0[i];
        Self([term(1, 2), term(2, 0), term(0, 1)])
    }
}

/// The quotient, rounded once. **Needs:** a denominator that is not zero.
pub(super) fn ratio(numerator: IBig, denominator: IBig) -> f64 {
    Relaxed::from_parts_signed(numerator, denominator).to_f64().value()
}
