//! What a triangle test is asked.

use super::triangle::Glimpse;
use super::{LaneHit, RayLanes};
use crate::math::{Lane, Mask, Real, Vec3, WIDTH, Wide};

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
