//! Precision as a type: three markers that fix number type, triangle test and how curved surfaces are decided.

use wide::{f32x8, f64x8};

use super::triangle::{ExactVolumes, FilteredVolumes, Glimpse, Woop};
use super::{LaneHit, RayLanes, cylinder, sphere};
use crate::math::{Lane, Mask, Real, Stored, Vec3, WIDTH, Wide};

/// A triangle test: what it prepares once a ray, and what it asks of a triangle.
pub trait TriangleTest: Copy + Send + Sync + 'static {
    /// What is computed once a ray.
    type Prepared<L: Lane>: Copy;
    /// Prepares rays.
    fn prepare<L: Lane>(ray: &RayLanes<L>) -> Self::Prepared<L>;
    /// Lanes whose rays may hit their triangles: cheap, and few of them do not.
    fn may_hit<L: Lane>(ray: &RayLanes<L>, prepared: &Self::Prepared<L>, vertices: [Vec3<L>; 3]) -> L::Mask;
    /// Meets those lanes with their triangles; `limit` is the nearest hit so far, and hits beyond it may be left out.
    fn hit<L: Lane>(
        lanes: L::Mask,
        ray: &RayLanes<L>,
        prepared: &Self::Prepared<L>,
        vertices: [Vec3<L>; 3],
        limit: L,
    ) -> LaneHit<L>;
    /// True if [`TriangleTest::glimpse`] tells anything.
    const GLIMPSES: bool = false;
    /// What is certain of a meeting without [`TriangleTest::hit`], where there is a cheap way to tell.
    #[inline(always)]
    fn glimpse<L: Lane>(
        _: &RayLanes<L>,
        _: &Self::Prepared<L>,
        _vertices: [Vec3<L>; 3],
    ) -> Option<Glimpse<L>> {
        None
    }
    /// Lanes whose rays have a triangle behind them for certain, as they have that which they left: one that a glimpse told
    /// too little of. [`TriangleTest::hit`] finds it at zero or before.
    #[inline(always)]
    fn is_left<L: Lane>(_: &RayLanes<L>, _seen: &Glimpse<L>, _triangle: [[f32; 3]; 3]) -> L::Mask {
        L::Mask::splat(false)
    }
    /// Where rays meet triangles that a glimpse told them to hit: as [`TriangleTest::hit`] finds it.
    #[inline(always)]
    fn settle<L: Lane>(_: &RayLanes<L>, _vertices: [Vec3<L>; 3]) -> LaneHit<L> {
        LaneHit::none()
    }
    /// Meets rays with triangles: [`TriangleTest::hit`] where they may.
    #[inline(always)]
    fn test<L: Lane>(
        ray: &RayLanes<L>,
        prepared: &Self::Prepared<L>,
        vertices: [Vec3<L>; 3],
        limit: L,
    ) -> LaneHit<L> {
        let lanes = Self::may_hit(ray, prepared, vertices);
        if !lanes.any() {
            return LaneHit::none();
        }
        Self::hit(lanes, ray, prepared, vertices, limit)
    }

    /// What is computed once for a ray that meets eight triangles at a time.
    type OneRay<R: Real>: Copy;
    /// What eight rays were prepared with, for each alone.
    fn each_of<L: Wide>(ray: &RayLanes<L>, prepared: &Self::Prepared<L>) -> [Self::OneRay<L::Scalar>; WIDTH];
    /// Of eight triangles, stored by corner and axis, the lanes that [`TriangleTest::test`] may accept, as bits.
    fn candidates<L: Lane>(
        ray: &RayLanes<L::Scalar>,
        prepared: &Self::OneRay<L::Scalar>,
        corners: &[[[f32; WIDTH]; 3]; 3],
    ) -> u32;
    /// [`TriangleTest::test`] of candidates, each with its ray.
    fn test_candidates<L: Lane>(ray: &RayLanes<L>, vertices: [Vec3<L>; 3], limit: L) -> LaneHit<L>;
}

/// How spheres and cylinders are decided: what certainly misses is sorted out without a quotient or a root, in the number type of
/// the lanes.
pub trait Curved: Copy + Send + Sync + 'static {
    /// Meets those lanes, which may hit, with their spheres.
    fn hit_sphere<L: Lane>(lanes: L::Mask, ray: &RayLanes<L>, sphere: &sphere::Lanes<L>) -> LaneHit<L>;
    /// Meets those lanes, which may hit, with their cylinders.
    fn hit_cylinder<L: Lane>(lanes: L::Mask, ray: &RayLanes<L>, cylinder: &cylinder::Lanes<L>) -> LaneHit<L>;

    /// Lanes whose rays may hit their spheres, as far as is cheap to tell.
    #[inline(always)]
    fn may_hit_sphere<L: Lane>(ray: &RayLanes<L>, s: &sphere::Lanes<L>) -> L::Mask {
        sphere::may_hit(ray, s)
    }
    /// Of those lanes, the ones that may hit before `limit`, if it costs little beside meeting them to tell: not where no ray
    /// has found anything yet.
    #[inline(always)]
    fn sphere_within<L: Lane>(lanes: L::Mask, ray: &RayLanes<L>, s: &sphere::Lanes<L>, limit: L) -> L::Mask {
        if limit.lt(ray.t_max).any() { lanes & !sphere::is_beyond(ray, s, limit) } else { lanes }
    }
    /// Of those lanes, the ones that do not certainly go away from their spheres.
    #[inline(always)]
    fn sphere_ahead<L: Lane>(lanes: L::Mask, _: &RayLanes<L>, _: &sphere::Lanes<L>) -> L::Mask {
        lanes
    }
    /// Of those lanes, the ones that certainly hit before `limit`, if it costs little beside meeting them to tell.
    #[inline(always)]
    fn sphere_surely<L: Lane>(lanes: L::Mask, ray: &RayLanes<L>, s: &sphere::Lanes<L>, limit: L) -> L::Mask {
        lanes & sphere::surely_hits(ray, s, limit)
    }
    /// Lanes whose rays may hit their cylinders, as far as is cheap to tell.
    #[inline(always)]
    fn may_hit_cylinder<L: Lane>(ray: &RayLanes<L>, c: &cylinder::Lanes<L>) -> L::Mask {
        cylinder::may_hit(ray, c)
    }
    /// As [`Curved::sphere_within`].
    #[inline(always)]
    fn cylinder_within<L: Lane>(
        lanes: L::Mask,
        ray: &RayLanes<L>,
        c: &cylinder::Lanes<L>,
        limit: L,
    ) -> L::Mask {
        if limit.lt(ray.t_max).any() { lanes & !cylinder::is_beyond(ray, c, limit) } else { lanes }
    }
    /// Of those lanes, the ones that do not certainly go away from their cylinders.
    #[inline(always)]
    fn cylinder_ahead<L: Lane>(lanes: L::Mask, ray: &RayLanes<L>, c: &cylinder::Lanes<L>) -> L::Mask {
        lanes & !cylinder::is_behind(ray, c)
    }
    /// As [`Curved::sphere_surely`]. To tell of a cylinder would take as long as to meet it.
    #[inline(always)]
    fn cylinder_surely<L: Lane>(_: L::Mask, _: &RayLanes<L>, _: &cylinder::Lanes<L>, _limit: L) -> L::Mask {
        L::Mask::splat(false)
    }

    /// Meets rays with spheres: the two of above.
    #[inline(always)]
    fn sphere<L: Lane>(ray: &RayLanes<L>, sphere: &sphere::Lanes<L>) -> LaneHit<L> {
        let lanes = Self::may_hit_sphere(ray, sphere);
        if lanes.any() { Self::hit_sphere(lanes, ray, sphere) } else { LaneHit::none() }
    }
    /// Meets rays with cylinders: the two of above.
    #[inline(always)]
    fn cylinder<L: Lane>(ray: &RayLanes<L>, cylinder: &cylinder::Lanes<L>) -> LaneHit<L> {
        let lanes = Self::may_hit_cylinder(ray, cylinder);
        if lanes.any() { Self::hit_cylinder(lanes, ray, cylinder) } else { LaneHit::none() }
    }
}

/// Solves in the number type of the lanes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Direct;

/// Solves in `f64`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Widened;

impl Curved for Direct {
    #[inline(always)]
    fn hit_sphere<L: Lane>(lanes: L::Mask, ray: &RayLanes<L>, s: &sphere::Lanes<L>) -> LaneHit<L> {
        let hit = sphere::solve(ray, s);
        LaneHit { mask: hit.mask & lanes, ..hit }
    }
    #[inline(always)]
    fn hit_cylinder<L: Lane>(lanes: L::Mask, ray: &RayLanes<L>, c: &cylinder::Lanes<L>) -> LaneHit<L> {
        let hit = cylinder::solve(ray, c);
        LaneHit { mask: hit.mask & lanes, ..hit }
    }
}

impl Curved for Widened {
    #[inline(always)]
    fn hit_sphere<L: Lane>(lanes: L::Mask, ray: &RayLanes<L>, s: &sphere::Lanes<L>) -> LaneHit<L> {
        sphere::solve_widened(lanes, ray, s)
    }
    #[inline(always)]
    fn hit_cylinder<L: Lane>(lanes: L::Mask, ray: &RayLanes<L>, c: &cylinder::Lanes<L>) -> LaneHit<L> {
        cylinder::solve_widened(lanes, ray, c)
    }
}

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
    /// How spheres and cylinders are decided.
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
