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

/// The sum of two pairs, within 4 parts in 2^106.
pub(super) fn add([a, b]: Pair, [c, d]: Pair) -> Pair {
    let ([high, low], [middle, lowest]) = (two_sum(a, c), two_sum(b, d));
    let [high, low] = two_sum(high, low + middle);
    two_sum(high, low + lowest)
}

/// The product of two pairs, within 8 parts in 2^106.
pub(super) fn multiply([a, b]: Pair, [c, d]: Pair) -> Pair {
    let [high, low] = two_product(a, c);
    two_sum(high, low + (a * d + b * c))
}

/// The determinant of three rows, within a roundoff, and 0 only if it is.
pub(crate) fn determinant(a: &[Pair; 3], b: &[Pair; 3], c: &[Pair; 3]) -> f64 {
    let ([sum, rest], error) = pair_determinant(a, b, c);
    // Four bits more than a roundoff, so that rounding once more stays within one.
    let certain = sum.abs() > error * (16.0 / f64::EPSILON);
    if certain { sum + rest } else { Expansion::determinant(a, b, c).value() }
}

/// 1 or -1 as the determinant of three rows certainly has that sign, 0 where sums of two numbers cannot tell.
pub(crate) fn determinant_sign(a: &[Pair; 3], b: &[Pair; 3], c: &[Pair; 3]) -> f64 {
    let ([sum, _], error) = pair_determinant(a, b, c);
    if sum.abs() > error { sum.signum() } else { 0.0 }
}

/// The determinant of three rows, and a bound on its error.
fn pair_determinant(a: &[Pair; 3], b: &[Pair; 3], c: &[Pair; 3]) -> (Pair, f64) {
    // Six products of three, each within 2^-100 of itself, and their sums.
    const ERROR: f64 = 1.0 / (1u128 << 96) as f64;
    let minor = |i: usize, j: usize| add(multiply(b[i], c[j]), multiply(b[j], c[i].map(|x| -x)));
    let [x, y, z] = [(0, 1, 2), (1, 2, 0), (2, 0, 1)].map(|(i, j, k)| multiply(a[i], minor(j, k)));
    let size = |row: &[Pair; 3]| row.iter().map(|x| x[0].abs()).sum::<f64>();
    (add(add(x, y), z), size(a) * size(b) * size(c) * ERROR)
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

    /// The number, within a roundoff, and 0 only if it is.
    pub(crate) fn value(&self) -> f64 {
        self.terms[..self.len].iter().sum()
    }

    /// The determinant of three rows.
    fn determinant(a: &[Pair; 3], b: &[Pair; 3], c: &[Pair; 3]) -> Self {
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
                        two_product(part, z)
                            .into_iter()
                            .filter(|&term| term != 0.0)
                            .for_each(|term| self.add(term));
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

    fn sign(x: f64) -> i32 {
        i32::from(x > 0.0) - i32::from(x < 0.0)
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
            prop_assert_eq!(sign(got.value()), i32::from(want > IBig::ZERO) - i32::from(want < IBig::ZERO));
            let nearest = want.to_f64().value();
            prop_assert!((got.value() - nearest).abs() <= nearest.abs() * f64::EPSILON);
            let quick = determinant(&row(0), &row(3), &row(6));
            prop_assert!((quick - nearest).abs() <= nearest.abs() * f64::EPSILON, "{quick} for {nearest}");
            let told = determinant_sign(&row(0), &row(3), &row(6));
            prop_assert!(told == 0.0 || sign(told) == sign(nearest));
        }

        /// The third row is close to a sum of the others: most of the products cancels.
        #[test]
        fn small_determinants_of_large_rows_keep_their_digits(rows in prop::array::uniform6(whole()), by in -3..=3i32) {
            let pair = |i: usize| rows[i].0;
            let (a, b) = ([pair(0), pair(1), pair(2)], [pair(3), pair(4), pair(5)]);
            let mut c: [Pair; 3] = std::array::from_fn(|k| add(a[k], b[k]));
            c[0] = add(c[0], [f64::from(by), 0.0]);
            let exact = Expansion::determinant(&a, &b, &c);
            let quick = determinant(&a, &b, &c);
            prop_assert_eq!(sign(quick), sign(exact.value()));
            prop_assert!((quick - exact.value()).abs() <= exact.value().abs() * f64::EPSILON);
        }
    }

    #[test]
    fn sums_of_opposites_vanish() {
        let mut sum = Expansion::ZERO;
        for x in [1e100, 1.0, -1e100, 1e-300, -1.0, -1e-300] {
            sum.add(x);
        }
        assert_eq!((sum.len, sum.value()), (0, 0.0));
    }
}
