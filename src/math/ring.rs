//! Sums and products, written once for pairs of `f64`, which have twice the digits of one, and for whole numbers, which have
//! as many as it takes.

use std::cmp::Ordering;

use dashu::integer::IBig;

use super::expansion::{Pair, add, multiply};

/// Numbers that are added and multiplied.
pub(crate) trait Ring: Clone {
    /// The sum.
    fn plus(&self, other: &Self) -> Self;
    /// The difference.
    fn minus(&self, other: &Self) -> Self;
    /// The product.
    fn times(&self, other: &Self) -> Self;
    /// The product with itself.
    fn squared(&self) -> Self {
        self.times(self)
    }
}

/// **Accuracy:** some parts in 2^104 of the sum of magnitudes, unless products leave the range of `f64`.
impl Ring for Pair {
    fn plus(&self, other: &Self) -> Self {
        add(*self, *other)
    }
    fn minus(&self, other: &Self) -> Self {
        add(*self, other.map(|x| -x))
    }
    fn times(&self, other: &Self) -> Self {
        multiply(*self, *other)
    }
}

/// **Accuracy:** exact.
impl Ring for IBig {
    fn plus(&self, other: &Self) -> Self {
        self + other
    }
    fn minus(&self, other: &Self) -> Self {
        self - other
    }
    fn times(&self, other: &Self) -> Self {
        self * other
    }
}

/// The sum of products.
pub(crate) fn dot<N: Ring>(a: &[N; 3], b: &[N; 3]) -> N {
    a[0].times(&b[0]).plus(&a[1].times(&b[1])).plus(&a[2].times(&b[2]))
}

/// The vector product.
pub(crate) fn cross<N: Ring>(a: &[N; 3], b: &[N; 3]) -> [N; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i].times(&b[j]).minus(&a[j].times(&b[i])))
}

/// Numbers as they are.
pub(crate) fn pairs(v: [f64; 3]) -> [Pair; 3] {
    v.map(|x| [x, 0.0])
}

/// A thousand times what the roundings of a form of at most six factors may amount to, as a share of its size: the product of
/// the sums of magnitudes of its factors.
const ERROR: f64 = 1.0 / (1u128 << 90) as f64;

/// Whether a form is more than a share of its size.
fn is_clear([value, _]: Pair, size: f64, share: f64) -> bool {
    // Below, the second numbers of pairs may have been lost to underflow.
    const LEAST: f64 = 1e-200;
    value.abs() > size * share && size > LEAST && size < f64::INFINITY
}

/// The sign of a form, a pair where that is sure to tell and a whole number elsewhere.
pub(crate) fn sign(pair: Pair, size: f64, whole: impl FnOnce() -> IBig) -> Ordering {
    if is_clear(pair, size, ERROR) { pair[0].total_cmp(&0.0) } else { whole().cmp(&IBig::ZERO) }
}

/// The value of a form, from whole numbers where a pair does not tell it.
///
/// **Accuracy:** the sign is exact, and ten digits are right.
pub(crate) fn value(pair: Pair, size: f64, whole: impl FnOnce() -> f64) -> f64 {
    const SHARE: f64 = ERROR * (1u64 << 26) as f64;
    if is_clear(pair, size, SHARE) { pair[0] } else { whole() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_tell_signs_only_where_they_are_sure() {
        let told = |pair, size| sign(pair, size, || IBig::from(-7));
        assert_eq!(told([1e-20, 0.0], 1.0), Ordering::Greater);
        for (pair, size) in
            [([1e-28, 0.0], 1.0), ([0.0; 2], 1.0), ([1e-210, 0.0], 1e-209), ([1.0, 0.0], f64::NAN)]
        {
            assert_eq!(told(pair, size), Ordering::Less, "{pair:?} of {size}");
        }
        let value_of = |pair| value(pair, 1.0, || -7.0);
        assert_eq!([[1e-19, 0.0], [1e-20, 0.0], [0.0; 2]].map(value_of), [1e-19, -7.0, -7.0]);
    }

    #[test]
    fn pairs_and_whole_numbers_agree() {
        let (a, b) = ([3.0, -5.0, 7.0], [2.0, 11.0, -13.0]);
        let whole = |v: [f64; 3]| v.map(|x| IBig::from(x as i32));
        let [x, y, z] = cross(&whole(a), &whole(b));
        assert_eq!(cross(&pairs(a), &pairs(b)).map(|p| IBig::from(p[0] as i32)), [x, y, z]);
        assert_eq!(IBig::from(dot(&pairs(a), &pairs(b))[0] as i32), dot(&whole(a), &whole(b)));
    }
}
