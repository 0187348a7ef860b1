//! `f32` and `f64` as lanes of width one.

use super::{BitLane, Lane, Mask, Real};

impl Mask for bool {
    #[inline(always)]
    fn splat(value: bool) -> Self {
        value
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        self as u32
    }
    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        bits & 1 != 0
    }
}

impl BitLane for u32 {
    #[inline(always)]
    fn splat(value: u32) -> Self {
        value
    }
    #[inline(always)]
    fn from_fn(mut words: impl FnMut(usize) -> u32) -> Self {
        words(0)
    }
    #[inline(always)]
    fn get(&self, _: usize) -> u32 {
        *self
    }
    #[inline(always)]
    fn wrapping_add(self, other: Self) -> Self {
        u32::wrapping_add(self, other)
    }
    #[inline(always)]
    fn wrapping_mul(self, other: Self) -> Self {
        u32::wrapping_mul(self, other)
    }
    #[inline(always)]
    fn shl(self, by: u32) -> Self {
        self << by
    }
    #[inline(always)]
    fn shr(self, by: u32) -> Self {
        self >> by
    }
}

macro_rules! scalar_lane {
    ($t:ty) => {
        impl Lane for $t {
            type Scalar = $t;
            type Mask = bool;
            type Bits = u32;
            type Double = f64;
            const WIDTH: usize = 1;

            #[inline(always)]
            fn splat(value: $t) -> Self {
                value
            }
            #[inline(always)]
            fn constant(value: f64) -> Self {
                value as $t
            }
            #[inline(always)]
            fn from_fn(mut values: impl FnMut(usize) -> $t) -> Self {
                values(0)
            }
            #[inline(always)]
            fn get(&self, _: usize) -> $t {
                *self
            }
            #[inline(always)]
            fn load(values: &[$t]) -> Self {
                values[0]
            }
            #[inline(always)]
            fn store(self, values: &mut [$t]) {
                values[0] = self;
            }
            #[inline(always)]
            fn load_f32(values: &[f32; 8]) -> Self {
                values[0] as $t
            }
            #[inline(always)]
            fn from_bits(words: u32) -> Self {
                words as $t
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                if self < other { self } else { other }
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                if self > other { self } else { other }
            }
            #[inline(always)]
            fn abs(self) -> Self {
                <$t>::abs(self)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                <$t>::sqrt(self)
            }
            #[inline(always)]
            fn floor(self) -> Self {
                <$t>::floor(self)
            }
            #[inline(always)]
            fn mul_add_fast(self, a: Self, b: Self) -> Self {
                if cfg!(target_feature = "fma") { self.mul_add(a, b) } else { self * a + b }
            }
            #[inline(always)]
            fn lt(self, other: Self) -> bool {
                self < other
            }
            #[inline(always)]
            fn le(self, other: Self) -> bool {
                self <= other
            }
            #[inline(always)]
            fn eq(self, other: Self) -> bool {
                self == other
            }
            #[inline(always)]
            fn select(mask: bool, yes: Self, no: Self) -> Self {
                if mask { yes } else { no }
            }
            #[inline(always)]
            fn select_bits(mask: bool, yes: u32, no: u32) -> u32 {
                if mask { yes } else { no }
            }
            #[inline(always)]
            fn widen(self) -> f64 {
                self as f64
            }
            #[inline(always)]
            fn narrow(value: f64) -> Self {
                value as $t
            }
            #[inline(always)]
            fn narrow_mask(mask: bool) -> bool {
                mask
            }
            #[inline(always)]
            fn widen_mask(mask: bool) -> bool {
                mask
            }
        }

        impl Real for $t {
            const ROUNDOFF: f64 = <$t>::EPSILON as f64 / 2.0;
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self as f64
            }
            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as $t
            }
            #[inline(always)]
            fn to_f32(self) -> f32 {
                self as f32
            }
            #[inline(always)]
            fn from_f32(value: f32) -> Self {
                value as $t
            }
            #[inline(always)]
            fn of_f32_mut(values: &mut [f32]) -> Option<&mut [Self]> {
                match size_of::<$t>() == size_of::<f32>() {
                    true => bytemuck::checked::try_cast_slice_mut(values).ok(),
                    false => None,
                }
            }
        }
    };
}
scalar_lane!(f32);
scalar_lane!(f64);
