//! Powers of cosines, with the same bits on every machine and in every lane.

use crate::math::{BitLane, Lane, Mask};

/// Fractional bits of a [`Shininess`].
const FRACTION_BITS: u32 = 8;

/// A specular exponent as 24.8 fixed point: one word a lane can test bit by bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Shininess(u32);

impl Shininess {
    /// The greatest exponent.
    pub const MAX: f32 = 65_536.0;

    /// An exponent rounded to a multiple of 1/256 and confined to `[0, 65536]`; NaN gives 0.
    pub fn new(exponent: f32) -> Self {
        Self((exponent.clamp(0.0, Self::MAX) * (1 << FRACTION_BITS) as f32).round_ties_even() as u32)
    }

    /// The fixed-point word, to be put into lanes.
    pub fn word(self) -> u32 {
        self.0
    }

    /// The exponent as used.
    pub fn exponent(self) -> f32 {
        self.0 as f32 / (1 << FRACTION_BITS) as f32
    }

    /// Bits of the integer part: the squarings that [`pow_clamped`] needs.
    pub fn bits(self) -> u32 {
        (self.0 >> FRACTION_BITS).checked_ilog2().map_or(0, |top| top + 1)
    }

    /// True if square roots are needed, too.
    pub fn has_fraction(self) -> bool {
        !self.0.is_multiple_of(1 << FRACTION_BITS)
    }
}

/// `x` to the power `exponent`; `x` is confined to `[0, 1]` (NaN counts as 0), and anything to the power 0 is 1.
///
/// `exponent`: the [`Shininess::word`] of each lane. `bits`: the largest [`Shininess::bits`] of any lane; more give the same
/// result. `FRACTION`: whether any lane [has a fraction](Shininess::has_fraction); if not, the square roots are left out.
///
/// Square and multiply over the bits of the integer part, then square roots for the bits of the fraction: each lane keeps
/// the products its own bits ask for.
///
/// **Accuracy:** relative error at most `gamma(exponent + 24)` above the underflow of the number type: squaring doubles an
/// error, so `k` squarings have `2^k - 1` roundings; the eight roots add three each. 1e-5 at exponent 100.
#[inline(always)]
pub fn pow_clamped<L: Lane, const FRACTION: bool>(x: L, exponent: L::Bits, bits: u32) -> L {
    let x = x.clamp(L::zero(), L::one());
    let first = exponent.get(0);
    let differing = L::from_bits(exponent ^ L::Bits::splat(first));
    if !FRACTION && !differing.gt(L::zero()).any() {
        return whole_power(x, first >> FRACTION_BITS);
    }
    let mut power = L::one();
    let mut square = x;
    for bit in FRACTION_BITS..FRACTION_BITS + bits {
        power = L::select(has_bit::<L>(exponent, bit), power * square, power);
        square = square * square;
    }
    if FRACTION { power * root_power(x, exponent) } else { power }
}

/// `x` to a power that all lanes share, as they do where neighbours are of the same material.
#[inline(always)]
fn whole_power<L: Lane>(x: L, exponent: u32) -> L {
    let (mut power, mut square, mut rest) = (L::one(), x, exponent);
    while rest != 0 {
        if rest & 1 != 0 {
            power = power * square;
        }
        square = square * square;
        rest >>= 1;
    }
    power
}

/// `x` to the power of the fraction.
#[inline(always)]
fn root_power<L: Lane>(x: L, exponent: L::Bits) -> L {
    let mut power = L::one();
    let mut root = x;
    for bit in (0..FRACTION_BITS).rev() {
        root = root.sqrt();
        power = L::select(has_bit::<L>(exponent, bit), power * root, power);
    }
    power
}

#[inline(always)]
fn has_bit<L: Lane>(word: L::Bits, bit: u32) -> L::Mask {
    !L::from_bits(word & L::Bits::splat(1 << bit)).eq(L::zero())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use wide::{f32x8, u32x8};

    use super::*;
    use crate::math::gamma_of;
    use crate::sampling::twin::assert_lanes;

    fn pow(x: f32, shininess: Shininess) -> f32 {
        pow_clamped::<f32, true>(x, shininess.word(), shininess.bits())
    }

    #[test]
    fn shininess_rounds_and_confines() {
        for (given, used) in
            [(100.0, 100.0), (0.3, 77.0 / 256.0), (-4.0, 0.0), (f32::NAN, 0.0), (1e9, 65_536.0)]
        {
            assert_eq!(Shininess::new(given).exponent(), used);
        }
        let (plain, broken) = (Shininess::new(100.0), Shininess::new(0.5));
        assert_eq!((plain.bits(), plain.has_fraction()), (7, false));
        assert_eq!((broken.bits(), broken.has_fraction()), (0, true));
    }

    #[test]
    fn ends_and_special_values() {
        let hundred = Shininess::new(100.0);
        for (x, expected) in [(0.0, 0.0), (1.0, 1.0), (-0.5, 0.0), (1.5, 1.0), (f32::NAN, 0.0), (1e-30, 0.0)]
        {
            assert_eq!(pow(x, hundred), expected, "{x}");
        }
        assert_eq!(pow(0.0, Shininess::new(0.0)), 1.0);
        assert_eq!(pow(0.25, Shininess::new(0.5)), 0.5);
        assert_eq!(pow(0.5, Shininess::new(3.0)), 0.125);
    }

    proptest! {
        #[test]
        fn is_as_accurate_as_stated(x in 0.0f32..1.0, exponent in 0.0f32..2000.0) {
            let shininess = Shininess::new(exponent);
            let exact = libm::pow(f64::from(x), f64::from(shininess.exponent()));
            let roundings = shininess.exponent().ceil() as u32 + 24;
            let bound = exact * gamma_of(roundings, f64::from(f32::EPSILON) / 2.0) + 1e-36;
            prop_assert!((f64::from(pow(x, shininess)) - exact).abs() <= bound);
        }

        #[test]
        fn lanes_with_their_own_exponents_equal_the_scalar(
            x in prop::array::uniform8(0.0f32..1.0), exponents in prop::array::uniform8(0.0f32..70_000.0),
        ) {
            let own = exponents.map(Shininess::new);
            let whole = exponents.map(|e| Shininess::new(e.floor()));
            let words = |s: [Shininess; 8]| u32x8::new(s.map(Shininess::word));
            let bits = |s: [Shininess; 8]| s.iter().map(|s| s.bits()).max().unwrap();
            let wide = pow_clamped::<f32x8, true>(f32x8::new(x), words(own), bits(own));
            assert_lanes(wide, |i| pow(x[i], own[i]));
            let wide = pow_clamped::<f32x8, false>(f32x8::new(x), words(whole), bits(whole));
            assert_lanes(wide, |i| pow(x[i], whole[i]));
        }
    }
}
