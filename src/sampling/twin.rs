//! For tests: each lane of a packet against the scalar.

use wide::f32x8;

use crate::math::{Lane, WIDTH};

/// Fails unless lane `i` has the bits of `scalar(i)`; any NaN equals any other.
#[track_caller]
pub(crate) fn assert_lanes(wide: f32x8, scalar: impl Fn(usize) -> f32) {
    for i in 0..WIDTH {
        let (w, s) = (wide.get(i), scalar(i));
        assert!(w.to_bits() == s.to_bits() || (w.is_nan() && s.is_nan()), "lane {i}: {w:?} is not {s:?}");
    }
}

/// A packet from the same function that gives the scalars.
pub(crate) fn packet(scalar: impl Fn(usize) -> f32) -> f32x8 {
    f32x8::new(std::array::from_fn(scalar))
}
