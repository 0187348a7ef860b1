//! The fast triangle test: one determinant, fused where the build fuses.
//!
//! Plainly: solve `o + t d = v0 + u e1 + v e2` by Cramer's rule and ask `u, v >= 0`, `u + v <= 1`. No departures but the
//! order of operations; edges shared by two triangles may be missed by both.
//!
//! **Source:** Moeller and Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997.

use crate::intersect::{LaneHit, RayLanes, TriangleTest};
use crate::math::{Lane, Mask, Real, Vec3, WIDTH, Wide, fused_cross, fused_dot, three};

/// See the module.
#[derive(Clone, Copy, Debug, Default)]
pub struct MollerTrumbore;

impl TriangleTest for MollerTrumbore {
    type Prepared<L: Lane> = ();

    #[inline(always)]
    fn prepare<L: Lane>(_: &RayLanes<L>) {}

    #[inline(always)]
    fn may_hit<L: Lane>(ray: &RayLanes<L>, _: &(), v: [Vec3<L>; 3]) -> L::Mask {
        solve(ray, v).mask
    }

    #[inline(always)]
    fn hit<L: Lane>(_: L::Mask, ray: &RayLanes<L>, _: &(), v: [Vec3<L>; 3], _: L) -> LaneHit<L> {
        solve(ray, v)
    }

    type OneRay<R: Real> = ();

    #[inline(always)]
    fn each_of<L: Wide>(_: &RayLanes<L>, (): &()) -> [(); WIDTH] {
        [(); WIDTH]
    }

    #[inline(always)]
    fn candidates<L: Lane>(ray: &RayLanes<L::Scalar>, _: &(), corners: &[[[f32; WIDTH]; 3]; 3]) -> u32 {
        let corners = three(|v| Vec3::<L>::load_f32(&corners[v]));
        Self::test(&RayLanes::splat(ray), &(), corners, L::zero()).mask.bits()
    }

    #[inline(always)]
    fn test_candidates<L: Lane>(ray: &RayLanes<L>, vertices: [Vec3<L>; 3], limit: L) -> LaneHit<L> {
        Self::test(ray, &(), vertices, limit)
    }
}

/// Where rays meet the planes of triangles, in the lanes where that is inside.
#[inline(always)]
fn solve<L: Lane>(ray: &RayLanes<L>, v: [Vec3<L>; 3]) -> LaneHit<L> {
    let (e1, e2, s) = (v[1] - v[0], v[2] - v[0], ray.origin - v[0]);
    let p = fused_cross(ray.direction, e2);
    let det = fused_dot(e1, p);
    let q = fused_cross(s, e1);
    let scale = L::one() / det;
    let (u, v) = (fused_dot(s, p) * scale, fused_dot(ray.direction, q) * scale);
    let zero = L::zero();
    let mask = u.ge(zero) & v.ge(zero) & (u + v).le(L::one());
    LaneHit { mask, t: fused_dot(e2, q) * scale, u, v }
}
