//! `f32x8` and `f64x8` of the `wide` crate as lanes of width eight.

use std::ops::{BitAnd, BitOr, BitXor, Not};

use wide::{f32x8, f64x8, i32x8, u32x8, u64x8};

use super::{BitLane, Lane, Mask, WIDTH, Wide, eight};

const LANE_BITS: [u32; WIDTH] = [1, 2, 4, 8, 16, 32, 64, 128];

impl BitLane for u32x8 {
    #[inline(always)]
    fn splat(value: u32) -> Self {
        u32x8::splat(value)
    }
    #[inline(always)]
    fn from_fn(words: impl FnMut(usize) -> u32) -> Self {
        u32x8::new(eight(words))
    }
    #[inline(always)]
    fn get(&self, i: usize) -> u32 {
        self.as_array()[i]
    }
    #[inline(always)]
    fn wrapping_add(self, other: Self) -> Self {
        self + other
    }
    #[inline(always)]
    fn wrapping_mul(self, other: Self) -> Self {
        self * other
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

macro_rules! wide_mask {
    ($name:ident, $v:ident, $from_bits:expr) => {
        /// Eight truth values: all bits of a lane set, or none.
        #[derive(Clone, Copy, Debug)]
        pub struct $name($v);

        impl BitAnd for $name {
            type Output = Self;
            #[inline(always)]
            fn bitand(self, other: Self) -> Self {
                Self(self.0 & other.0)
            }
        }
        impl BitOr for $name {
            type Output = Self;
            #[inline(always)]
            fn bitor(self, other: Self) -> Self {
                Self(self.0 | other.0)
            }
        }
        impl BitXor for $name {
            type Output = Self;
            #[inline(always)]
            fn bitxor(self, other: Self) -> Self {
                Self(self.0 ^ other.0)
            }
        }
        impl Not for $name {
            type Output = Self;
            #[inline(always)]
            fn not(self) -> Self {
                Self(!self.0)
            }
        }
        impl Mask for $name {
            #[inline(always)]
            fn splat(value: bool) -> Self {
                Self::from_bits(if value { 0xff } else { 0 })
            }
            #[inline(always)]
            fn bits(self) -> u32 {
                self.0.to_bitmask()
            }
            #[inline(always)]
            fn from_bits(bits: u32) -> Self {
                Self($from_bits(bits))
            }
        }
    };
}

#[inline(always)]
fn f32_mask(bits: u32) -> f32x8 {
    let lanes = u32x8::new(LANE_BITS);
    bytemuck::cast((u32x8::splat(bits) & lanes).simd_eq(lanes))
}

#[inline(always)]
fn f64_mask(bits: u32) -> f64x8 {
    let lanes = u64x8::new([1, 2, 4, 8, 16, 32, 64, 128]);
    bytemuck::cast((u64x8::splat(u64::from(bits)) & lanes).simd_eq(lanes))
}

wide_mask!(Mask32, f32x8, f32_mask);
wide_mask!(Mask64, f64x8, f64_mask);

macro_rules! wide_lane {
    ($v:ident, $s:ident, $mask:ident) => {
        type Scalar = $s;
        type Mask = $mask;
        type Bits = u32x8;
        type Double = f64x8;
        const WIDTH: usize = WIDTH;

        #[inline(always)]
        fn splat(value: $s) -> Self {
            $v::splat(value)
        }
        #[inline(always)]
        fn constant(value: f64) -> Self {
            $v::splat(value as $s)
        }
        #[inline(always)]
        fn from_fn(values: impl FnMut(usize) -> $s) -> Self {
            $v::new(eight(values))
        }
        #[inline(always)]
        fn get(&self, i: usize) -> $s {
            self.as_array()[i]
        }
        #[inline(always)]
        fn load(values: &[$s]) -> Self {
            let lanes: &[$s; WIDTH] = values[..WIDTH].try_into().expect("eight lanes");
            $v::new(*lanes)
        }
        #[inline(always)]
        fn store(self, values: &mut [$s]) {
            values[..WIDTH].copy_from_slice(&self.to_array());
        }
        #[inline(always)]
        fn min(self, other: Self) -> Self {
            self.fast_min(other)
        }
        #[inline(always)]
        fn max(self, other: Self) -> Self {
            self.fast_max(other)
        }
        #[inline(always)]
        fn abs(self) -> Self {
            $v::abs(self)
        }
        #[inline(always)]
        fn sqrt(self) -> Self {
            $v::sqrt(self)
        }
        #[inline(always)]
        fn floor(self) -> Self {
            $v::floor(self)
        }
        #[inline(always)]
        fn mul_add_fast(self, a: Self, b: Self) -> Self {
            self.mul_add(a, b)
        }
        #[inline(always)]
        fn lt(self, other: Self) -> $mask {
            $mask(self.simd_lt(other))
        }
        #[inline(always)]
        fn le(self, other: Self) -> $mask {
            $mask(self.simd_le(other))
        }
        #[inline(always)]
        fn eq(self, other: Self) -> $mask {
            $mask(self.simd_eq(other))
        }
        #[inline(always)]
        fn select(mask: $mask, yes: Self, no: Self) -> Self {
            mask.0.select(yes, no)
        }
        #[inline(always)]
        fn put(&mut self, mask: $mask, yes: Self) {
            *self = (mask.0 & yes) | (!mask.0 & *self);
        }
    };
}

impl Lane for f32x8 {
    wide_lane!(f32x8, f32, Mask32);

    #[inline(always)]
    fn select_bits(mask: Mask32, yes: u32x8, no: u32x8) -> u32x8 {
        let mask: u32x8 = bytemuck::cast(mask.0);
        (yes & mask) | (no & !mask)
    }
    #[inline(always)]
    fn load_f32(values: &[f32; 8]) -> Self {
        f32x8::new(*values)
    }
    #[inline(always)]
    fn from_bits(words: u32x8) -> Self {
        f32x8::from_i32x8(as_signed(words))
    }
    #[inline(always)]
    fn widen(self) -> f64x8 {
        let x = self.to_array();
        f64x8::new(eight(|i: usize| f64::from(x[i])))
    }
    #[inline(always)]
    fn narrow(value: f64x8) -> Self {
        let x = value.to_array();
        f32x8::new(eight(|i: usize| x[i] as f32))
    }
    #[inline(always)]
    fn narrow_mask(mask: Mask64) -> Mask32 {
        Mask32::from_bits(mask.bits())
    }
    #[inline(always)]
    fn widen_mask(mask: Mask32) -> Mask64 {
        Mask64::from_bits(mask.bits())
    }
}

impl Lane for f64x8 {
    wide_lane!(f64x8, f64, Mask64);

    #[inline(always)]
    fn select_bits(mask: Mask64, yes: u32x8, no: u32x8) -> u32x8 {
        f32x8::select_bits(f32x8::narrow_mask(mask), yes, no)
    }
    #[inline(always)]
    fn load_f32(values: &[f32; 8]) -> Self {
        f64x8::new(eight(|i: usize| f64::from(values[i])))
    }
    #[inline(always)]
    fn from_bits(words: u32x8) -> Self {
        f64x8::from_i32x8(as_signed(words))
    }
    #[inline(always)]
    fn widen(self) -> f64x8 {
        self
    }
    #[inline(always)]
    fn narrow(value: f64x8) -> Self {
        value
    }
    #[inline(always)]
    fn narrow_mask(mask: Mask64) -> Mask64 {
        mask
    }
    #[inline(always)]
    fn widen_mask(mask: Mask64) -> Mask64 {
        mask
    }
}

impl Wide for f32x8 {
    #[inline(always)]
    fn transpose(rows: [Self; WIDTH]) -> [Self; WIDTH] {
        f32x8::transpose(rows)
    }
    #[inline(always)]
    fn to_lanes(self) -> [f32; WIDTH] {
        self.to_array()
    }
    #[inline(always)]
    fn of_lanes(lanes: [f32; WIDTH]) -> Self {
        Self::new(lanes)
    }
}

impl Wide for f64x8 {
    #[inline(always)]
    fn transpose(rows: [Self; WIDTH]) -> [Self; WIDTH] {
        f64x8::transpose(rows)
    }
    #[inline(always)]
    fn to_lanes(self) -> [f64; WIDTH] {
        self.to_array()
    }
    #[inline(always)]
    fn of_lanes(lanes: [f64; WIDTH]) -> Self {
        Self::new(lanes)
    }
}

#[inline(always)]
fn as_signed(words: u32x8) -> i32x8 {
    bytemuck::cast(words)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masks_round_trip_through_bits() {
        for bits in 0..256 {
            assert_eq!(Mask32::from_bits(bits).bits(), bits);
            assert_eq!(Mask64::from_bits(bits).bits(), bits);
        }
    }

    #[test]
    fn transposing_swaps_rows_and_lanes() {
        let rows = eight(|i| f32x8::from_fn(|k| (10 * i + k) as f32));
        let doubles = rows.map(Lane::widen);
        for (i, (row, double)) in Wide::transpose(rows).iter().zip(Wide::transpose(doubles)).enumerate() {
            assert!((0..WIDTH).all(|k| Lane::get(row, k) == (10 * k + i) as f32));
            assert!((0..WIDTH).all(|k| Lane::get(&double, k) == (10 * k + i) as f64));
        }
    }

    /// Special values first: the order of NaN and zeros in `min` and `max` must be that of the scalar.
    #[test]
    fn min_max_and_compares_equal_the_scalar_on_special_values() {
        let special =
            [0.0, -0.0, 1.0, -1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MIN_POSITIVE / 2.0];
        for a in special {
            for i in 0..WIDTH {
                let (x, y) = (f32x8::splat(a), f32x8::new(special));
                let b = special[i];
                assert_eq!(Lane::min(x, y).get(i).to_bits(), Lane::min(a, b).to_bits(), "min {a} {b}");
                assert_eq!(Lane::max(x, y).get(i).to_bits(), Lane::max(a, b).to_bits(), "max {a} {b}");
                assert_eq!(Lane::lt(x, y).bits() >> i & 1 != 0, a < b);
                assert_eq!(Lane::le(x, y).bits() >> i & 1 != 0, a <= b);
                assert_eq!(Lane::eq(x, y).bits() >> i & 1 != 0, a == b);
            }
        }
    }
}
