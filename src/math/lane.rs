//! What a kernel may ask of its number type.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

use super::WIDTH;

/// One truth value a lane.
pub trait Mask:
    Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + BitXor<Output = Self> + Not<Output = Self>
{
    /// All lanes true, or all false.
    fn splat(value: bool) -> Self;
    /// Lane `i` in bit `i`; bits beyond the width are 0.
    fn bits(self) -> u32;
    /// The reverse of [`Mask::bits`]; bits beyond the width are ignored.
    fn from_bits(bits: u32) -> Self;
    /// True if any lane is.
    #[inline(always)]
    fn any(self) -> bool {
        self.bits() != 0
    }
}

/// Unsigned 32-bit words, as many as the float lane has: the arithmetic of hashes and counters, wrapping.
pub trait BitLane:
    Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + BitXor<Output = Self>
{
    /// The same word in each lane.
    fn splat(value: u32) -> Self;
    /// Lane `i` is `words(i)`.
    fn from_fn(words: impl FnMut(usize) -> u32) -> Self;
    /// Word `i`.
    fn get(&self, i: usize) -> u32;
    /// Sum modulo 2^32.
    fn wrapping_add(self, other: Self) -> Self;
    /// Product modulo 2^32.
    fn wrapping_mul(self, other: Self) -> Self;
    /// Logical shift left by a number below 32.
    fn shl(self, by: u32) -> Self;
    /// Logical shift right by a number below 32.
    fn shr(self, by: u32) -> Self;
}

/// A number, or eight of them: what every kernel is generic over.
///
/// `+ - * / sqrt` and the comparisons are IEEE on each lane, so a kernel built from them gives each lane the bits that
/// the scalar gives. [`Lane::mul_add_fast`] is the exception: it may differ between builds
/// and widths, and belongs in conservative culling and in the `Fast` tier only.
pub trait Lane:
    Copy
    + Debug
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
{
    /// The type of one lane.
    type Scalar: Real;
    /// One truth value a lane.
    type Mask: Mask;
    /// One 32-bit word a lane.
    type Bits: BitLane;
    /// As many lanes of `f64`.
    type Double: Lane<Scalar = f64, Double = Self::Double>;

    /// Number of lanes.
    const WIDTH: usize;

    /// The same value in each lane.
    fn splat(value: Self::Scalar) -> Self;
    /// A constant, rounded to the lane's number type, in each lane.
    fn constant(value: f64) -> Self;
    /// Lane `i` is `values(i)`.
    fn from_fn(values: impl FnMut(usize) -> Self::Scalar) -> Self;
    /// Lane `i`.
    fn get(&self, i: usize) -> Self::Scalar;
    /// The first `WIDTH` values of a slice. **Panics** if it is shorter.
    fn load(values: &[Self::Scalar]) -> Self;
    /// Writes the lanes to the first `WIDTH` values of a slice. **Panics** if it is shorter.
    fn store(self, values: &mut [Self::Scalar]);
    /// The first `WIDTH` values of eight stored `f32`, exactly.
    fn load_f32(values: &[f32; 8]) -> Self;
    /// Whole numbers below 2^24, exactly.
    fn from_bits(words: Self::Bits) -> Self;

    /// The smaller; the second if either is NaN.
    fn min(self, other: Self) -> Self;
    /// The larger; the second if either is NaN.
    fn max(self, other: Self) -> Self;
    /// Magnitude.
    fn abs(self) -> Self;
    /// Square root, correctly rounded.
    fn sqrt(self) -> Self;
    /// Largest whole number not above.
    fn floor(self) -> Self;
    /// `self * a + b`, fused where the build fuses: for conservative culling and the `Fast` tier.
    fn mul_add_fast(self, a: Self, b: Self) -> Self;

    /// `<` by lane, false on NaN.
    fn lt(self, other: Self) -> Self::Mask;
    /// `<=` by lane, false on NaN.
    fn le(self, other: Self) -> Self::Mask;
    /// `==` by lane, false on NaN.
    fn eq(self, other: Self) -> Self::Mask;
    /// `>` by lane, false on NaN.
    #[inline(always)]
    fn gt(self, other: Self) -> Self::Mask {
        other.lt(self)
    }
    /// `>=` by lane, false on NaN.
    #[inline(always)]
    fn ge(self, other: Self) -> Self::Mask {
        other.le(self)
    }
    /// True where the lane is neither NaN nor infinite.
    #[inline(always)]
    fn is_finite(self) -> Self::Mask {
        self.abs().lt(Self::constant(f64::INFINITY))
    }
    /// `yes` where the mask is true, `no` elsewhere.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// Takes `yes` where the mask is true. For what is read again soon: [`Lane::select`] to where one of both came from becomes
    /// a masked store, which a load waits for until it has reached the cache.
    #[inline(always)]
    fn put(&mut self, mask: Self::Mask, yes: Self) {
        *self = Self::select(mask, yes, *self);
    }

    /// `yes` where the mask is true, `no` elsewhere, for words.
    fn select_bits(mask: Self::Mask, yes: Self::Bits, no: Self::Bits) -> Self::Bits;

    /// The lanes as `f64`, exactly.
    fn widen(self) -> Self::Double;
    /// The nearest lanes of this type.
    fn narrow(value: Self::Double) -> Self;
    /// A mask over the `f64` lanes as a mask over these.
    fn narrow_mask(mask: <Self::Double as Lane>::Mask) -> Self::Mask;
    /// A mask over these lanes as a mask over the `f64` lanes.
    fn widen_mask(mask: Self::Mask) -> <Self::Double as Lane>::Mask;

    /// Zero in each lane.
    #[inline(always)]
    fn zero() -> Self {
        Self::constant(0.0)
    }
    /// One in each lane.
    #[inline(always)]
    fn one() -> Self {
        Self::constant(1.0)
    }
    /// Confines to `[low, high]`; NaN becomes `low`.
    #[inline(always)]
    fn clamp(self, low: Self, high: Self) -> Self {
        self.max(low).min(high)
    }
    /// The magnitude of `self` with the sign of `sign`; a zero `sign` of either kind counts as positive.
    #[inline(always)]
    fn with_sign_of(self, sign: Self) -> Self {
        let magnitude = self.abs();
        Self::select(sign.lt(Self::zero()), -magnitude, magnitude)
    }
}

/// Lanes of width eight.
pub trait Wide: Lane {
    /// Lane `k` of row `i` becomes lane `i` of row `k`.
    fn transpose(rows: [Self; WIDTH]) -> [Self; WIDTH];
    /// The lanes as they are stored.
    fn to_lanes(self) -> [Self::Scalar; WIDTH];
    /// The reverse.
    fn of_lanes(lanes: [Self::Scalar; WIDTH]) -> Self;
}

/// A number type that rays may be stored in, for lanes of the same or of a wider one.
pub trait Stored<L: Lane>: Real {
    /// The first eight values of a slice, exactly. **Panics** if it is shorter.
    fn lanes(values: &[Self]) -> L;
    /// The value as one lane holds it, exactly.
    fn lane(self) -> L::Scalar;
}

impl<L: Lane> Stored<L> for f32 {
    #[inline(always)]
    fn lanes(values: &[Self]) -> L {
        L::load_f32(values[..8].try_into().expect("eight lanes"))
    }
    #[inline(always)]
    fn lane(self) -> L::Scalar {
        L::Scalar::from_f32(self)
    }
}

impl<L: Lane<Scalar = f64>> Stored<L> for f64 {
    #[inline(always)]
    fn lanes(values: &[Self]) -> L {
        L::load(values)
    }
    #[inline(always)]
    fn lane(self) -> f64 {
        self
    }
}

/// A lane of width one: `f32` or `f64`.
pub trait Real:
    Lane<Scalar = Self, Mask = bool, Bits = u32, Double = f64> + PartialOrd + Default + bytemuck::Pod
{
    /// Unit roundoff: half the distance from 1 to the next larger number.
    const ROUNDOFF: f64;
    /// Exact for `f32`; rounds for nothing else.
    fn to_f64(self) -> f64;
    /// Nearest value.
    fn from_f64(value: f64) -> Self;
    /// Nearest value.
    fn to_f32(self) -> f32;
    /// Exact.
    fn from_f32(value: f32) -> Self;
    /// Stored `f32` as they are, to be written, if that is this type.
    fn of_f32_mut(values: &mut [f32]) -> Option<&mut [Self]>;
}
