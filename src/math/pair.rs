//! Vectors of sums of two `f64`: twice the digits, where those of one would not tell.

use super::expansion::{Pair, add, multiply};

/// Three pairs.
pub(crate) type PairVector = [Pair; 3];

/// Numbers as they are.
pub(crate) fn pairs(v: [f64; 3]) -> PairVector {
    v.map(|x| [x, 0.0])
}

/// The sum of products.
pub(crate) fn pair_dot(a: &PairVector, b: &PairVector) -> Pair {
    let [x, y, z] = [0, 1, 2].map(|k| multiply(a[k], b[k]));
    add(add(x, y), z)
}

/// The vector product.
pub(crate) fn pair_cross(a: &PairVector, b: &PairVector) -> PairVector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| add(multiply(a[i], b[j]), multiply(a[j], b[i]).map(|x| -x)))
}

/// The product.
pub(crate) fn pair_product(a: Pair, b: Pair) -> Pair {
    multiply(a, b)
}

/// Whether `a <= b`.
pub(crate) fn pair_at_most(a: Pair, b: Pair) -> bool {
    add(b, a.map(|x| -x))[0] >= 0.0
}
