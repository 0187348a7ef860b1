//! Precision as a type: three markers that fix number type, triangle test and how curved surfaces are met.

use wide::{f32x8, f64x8};

use super::TriangleTest;
use super::curved::{Curved, Direct, Widened};
use super::triangle::{ExactVolumes, FilteredVolumes, Woop};
use crate::math::{Lane, Real, Stored, Wide};

mod sealed {
    pub trait Sealed {}
}

/// A precision tier. The program matches on [`TierName`] once, at the door; behind it the tier is a type.
pub trait Tier: sealed::Sealed + Copy + Default + Send + Sync + 'static {
    /// Number type of rays, hits and shading.
    type Real: Real + Stored<Self::Wide>;
    /// Eight of them.
    type Wide: Wide<Scalar = Self::Real, Bits = wide::u32x8>;
    /// The triangle test.
    type Triangle: TriangleTest;
    /// How spheres and cylinders are met.
    type Curved: Curved;
    /// The name of the tier.
    const NAME: TierName;

    /// The nearest `f32` lanes: boxes are culled in `f32` in every tier.
    fn nearest_f32(x: Self::Wide) -> f32x8;
    /// `f32` lanes not below; negative numbers have to be of the range of `f32`.
    fn above_f32(x: Self::Wide) -> f32x8;
    /// `f32` lanes not above; positive numbers have to be of the range of `f32`.
    fn below_f32(x: Self::Wide) -> f32x8;
}

/// `f32` rays, fused operations, triangles decided in `f64` and curved surfaces in `f32`; may leak at shared edges.
#[derive(Clone, Copy, Debug, Default)]
pub struct Fast;

/// `f32` rays, edge decisions that no closed mesh leaks through, `t` decided in `f64`; the same bits everywhere.
#[derive(Clone, Copy, Debug, Default)]
pub struct Watertight;

/// `f64` rays, tests and shading on the `f32` scene; which triangles a ray meets is decided without rounding.
#[derive(Clone, Copy, Debug, Default)]
pub struct Exact;

macro_rules! tier {
    ($tier:ident, $real:ty, $wide:ty, $triangle:ty, $curved:ty, $nearest:expr, $above:expr, $below:expr) => {
        impl sealed::Sealed for $tier {}
        impl Tier for $tier {
            type Real = $real;
            type Wide = $wide;
            type Triangle = $triangle;
            type Curved = $curved;
            const NAME: TierName = TierName::$tier;

            #[inline(always)]
            fn nearest_f32(x: $wide) -> f32x8 {
                $nearest(x)
            }
            #[inline(always)]
            fn above_f32(x: $wide) -> f32x8 {
                $above(x)
            }
            #[inline(always)]
            fn below_f32(x: $wide) -> f32x8 {
                $below(x)
            }
        }
    };
}
tier!(Fast, f32, f32x8, FilteredVolumes, Direct, as_is, as_is, as_is);
tier!(Watertight, f32, f32x8, Woop, Widened, as_is, as_is, as_is);
tier!(Exact, f64, f64x8, ExactVolumes, Widened, f32x8::narrow, above, below);

#[inline(always)]
fn as_is(x: f32x8) -> f32x8 {
    x
}

/// The nearest number, and two of the roundoffs it may be off by: never below.
#[inline(always)]
fn above(x: f64x8) -> f32x8 {
    let nearest = f32x8::narrow(x);
    nearest + beyond(nearest)
}

#[inline(always)]
fn below(x: f64x8) -> f32x8 {
    let nearest = f32x8::narrow(x);
    nearest - beyond(nearest)
}

/// More than rounding to `f32` takes away. Finite, so that infinities stay as they are.
#[inline(always)]
fn beyond(x: f32x8) -> f32x8 {
    let size = Lane::abs(x) * f32x8::splat(f32::EPSILON) + f32x8::splat(f32::MIN_POSITIVE);
    Lane::min(size, f32x8::splat(f32::MAX))
}

/// The name of a tier, as users choose it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TierName {
    /// [`Fast`].
    Fast,
    /// [`Watertight`].
    #[default]
    Watertight,
    /// [`Exact`].
    Exact,
}

impl TierName {
    /// As written in scene files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fast => "fast",
            Self::Watertight => "watertight",
            Self::Exact => "exact",
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn limits(x: f64) -> [f64; 2] {
        let [low, high] = [Exact::below_f32, Exact::above_f32].map(|round| round(f64x8::splat(x)).get(0));
        [low, high].map(f64::from)
    }

    #[test]
    fn infinities_stay_and_the_rest_of_f64_lies_between() {
        for x in [f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(limits(x), [x, x]);
        }
        assert_eq!(limits(1e300)[1], f64::INFINITY);
        for x in [0.0, 1e-320, -1e-320, 1e-45, 1e38, -1e38, f64::MIN_POSITIVE] {
            let [low, high] = limits(x);
            assert!(low < x && x < high, "{low} < {x} < {high}");
        }
    }

    proptest! {
        #[test]
        fn numbers_lie_between_close_ones_of_f32(x in -1e30f64..1e30, scale in -36i32..8) {
            let x = x * 10f64.powi(scale);
            let [low, high] = limits(x);
            prop_assert!(low <= x && x <= high, "{} <= {} <= {}", low, x, high);
            prop_assert!(high - low <= 4.0 * (f64::from(f32::EPSILON) * x.abs() + f64::from(f32::MIN_POSITIVE)));
        }
    }
}
