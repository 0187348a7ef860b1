//! What is asked of a line and a curved shape where rounding in `f64` could change the answer.
//!
//! Plainly: a form, a sum of products of what the two are made of, is computed in whole numbers. Departure: in pairs of
//! `f64`, and in whole numbers where those cannot tell.

use std::cell::LazyCell;
use std::cmp::Ordering;

use dashu::integer::IBig;

use super::oracle::number::Unit;
use crate::math::{Pair, Ring, sign, value};

/// What is asked the sign or the value of.
pub(super) trait Form: Copy {
    /// The numbers and vectors that forms are made of.
    type Parts<N: Ring>;
    /// The form.
    fn of<N: Ring>(self, parts: &Self::Parts<N>) -> N;
    /// How often a length, the direction and an axis are factors.
    fn factors(self) -> [usize; 3];
}

/// Parts as whole numbers of a unit of lengths, axes among them, and one of the direction.
pub(super) struct Whole<F: Form> {
    pub(super) parts: F::Parts<IBig>,
    pub(super) units: [Unit; 2],
}

/// A line and a shape, in pairs and, when first needed, in whole numbers.
pub(super) struct Question<F: Form, W> {
    pub(super) pairs: F::Parts<Pair>,
    whole: LazyCell<Whole<F>, W>,
    /// Sums of magnitudes: of lengths, of the direction, and of an axis.
    sizes: [f64; 3],
}

impl<F: Form, W: FnOnce() -> Whole<F>> Question<F, W> {
    pub(super) fn new(pairs: F::Parts<Pair>, whole: W, sizes: [f64; 3]) -> Self {
        Self { pairs, whole: LazyCell::new(whole), sizes }
    }

    /// The product of the sizes of the factors.
    pub(super) fn size(&self, form: F) -> f64 {
        let factors = self.sizes.iter().zip(form.factors());
        factors.flat_map(|(size, times)| std::iter::repeat_n(size, times)).product()
    }

    /// The sign, which does not depend on the units.
    pub(super) fn sign(&self, form: F) -> Ordering {
        sign(form.of(&self.pairs), self.size(form), || form.of(&self.whole.parts))
    }

    /// As [`value`] gives it.
    pub(super) fn value(&self, form: F) -> f64 {
        value(form.of(&self.pairs), self.size(form), || {
            let ([lengths, directions, axes], Whole { parts, units }) = (form.factors(), &*self.whole);
            units[0].drop(lengths + axes, units[1], directions, form.of(parts))
        })
    }
}
