//! Exact sums and products of `f64`: for the few questions whose answer rounding could change.
//!
//! A number is a sum of `f64` that do not overlap, smallest first. Exact as long as nothing overflows and no product of two
//! terms falls below the least normal number, which holds for products of three numbers of `f32`'s range.
//!
//! **Source:** Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates, 1997.

/// Terms that a determinant of sums of two can have: six products of three, eight terms each, four parts a term.
const MOST: usize = 6 * 8 * 4;

/// A sum of two numbers, the second below the roundoff of the first.
pub(crate) type Pair = [f64; 2];

/// A sum of numbers that do not overlap, smallest first, without zeros.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Expansion {
    terms: [f64; MOST],
    len: usize,
}

/// The rounded sum and what rounding lost.
pub(crate) fn two_sum(a: f64, b: f64) -> Pair {
    let sum = a + b;
    let b_part = sum - a;
    [sum, (a - (sum - b_part)) + (b - b_part)]
}

/// The rounded product and what rounding lost. The fused operation of `std` rounds once on every machine.
pub(crate) fn two_product(a: f64, b: f64) -> Pair {
    let product = a * b;
    [product, a.mul_add(b, -product)]
}

impl Expansion {
    /// Zero.
    pub(crate) const ZERO: Self = Self { terms: [0.0; MOST], len: 0 };

    /// Adds a number.
    pub(crate) fn add(&mut self, x: f64) {
        let (mut rest, mut kept) = (x, 0);
        for i in 0..self.len {
            let [sum, lost] = two_sum(rest, self.terms[i]);
            rest = sum;
            if lost != 0.0 {
                self.terms[kept] = lost;
                kept += 1;
            }
        }
        if rest != 0.0 {
            self.terms[kept] = rest;
            kept += 1;
        }
        self.len = kept;
    }

    /// Its sign as 1, 0 or -1: that of the largest term.
    pub(crate) fn sign(&self) -> i32 {
        match self.len {
            0 => 0,
            n if self.terms[n - 1] > 0.0 => 1,
            _ => -1,
        }
    }

    /// The number, within a roundoff.
    pub(crate) fn value(&self) -> f64 {
        self.terms[..self.len].iter().sum()
    }

    /// The determinant of three rows.
    pub(crate) fn determinant(a: &[Pair; 3], b: &[Pair; 3], c: &[Pair; 3]) -> Self {
        let mut sum = Self::ZERO;
        for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
            sum.add_product(a[i], b[j], c[k], 1.0);
            sum.add_product(a[i], b[k], c[j], -1.0);
        }
        sum
    }

    fn add_product(&mut self, a: Pair, b: Pair, c: Pair, sign: f64) {
        for x in a.into_iter().filter(|&x| x != 0.0) {
            for y in b.into_iter().filter(|&y| y != 0.0) {
                for part in two_product(sign * x, y).into_iter().filter(|&part| part != 0.0) {
                    for z in c.into_iter().filter(|&z| z != 0.0) {
                        two_product(part, z).into_iter().for_each(|term| self.add(term));
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dashu::integer::IBig;
    use proptest::prelude::*;

    /// Whole numbers of every length up to 2^80, as sums of two.
    fn whole() -> impl Strategy<Value = (Pair, IBig)> {
        (any::<i64>(), 0..63u32, any::<i16>()).prop_map(|(high, shift, low)| {
            let high = ((high >> shift) & !0x7ff) as f64 * 65536.0;
            let pair = two_sum(high, f64::from(low));
            (pair, IBig::from(high as i128) + IBig::from(low))
        })
    }

    proptest! {
        #[test]
        fn determinants_are_those_of_whole_numbers(rows in prop::array::uniform9(whole())) {
            let pair = |i: usize| rows[i].0;
            let big = |i: usize| rows[i].1.clone();
            let row = |i: usize| [pair(i), pair(i + 1), pair(i + 2)];
            let got = Expansion::determinant(&row(0), &row(3), &row(6));
            let minor = |i: usize, j: usize| big(3 + i) * big(6 + j) - big(3 + j) * big(6 + i);
            let want = big(0) * minor(1, 2) + big(1) * minor(2, 0) + big(2) * minor(0, 1);
            let sum: IBig = got.terms[..got.len].iter().map(|&t| IBig::try_from(t).unwrap()).sum();
            prop_assert_eq!(&sum, &want);
            prop_assert_eq!(got.sign(), i32::from(want > IBig::ZERO) - i32::from(want < IBig::ZERO));
            let nearest = want.to_f64().value();
            prop_assert!((got.value() - nearest).abs() <= nearest.abs() * f64::EPSILON);
        }
    }

    #[test]
    fn sums_of_opposites_vanish() {
        let mut sum = Expansion::ZERO;
        for x in [1e100, 1.0, -1e100, 1e-300, -1.0, -1e-300] {
            sum.add(x);
        }
        assert_eq!((sum.len, sum.sign(), sum.value()), (0, 0, 0.0));
    }
}
