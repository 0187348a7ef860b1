//! Testing the primitives of a leaf, for every walk, query and tier.

use super::Accel;
use super::block::{Block, Walk};
use super::node::ChildRef;
use super::query::Query;
use crate::intersect::aabb::CullRay;
use crate::intersect::{Curved, LaneHit, PrimKind, RayLanes, Tier, TriangleTest};
use crate::math::Vec3;

/// Rays with all that the tests of a tier prepare once a ray.
#[derive(Clone, Copy)]
pub(super) struct PreparedRays<T: Tier> {
    pub(super) ray: RayLanes<T::Wide>,
    pub(super) cull: CullRay<wide::f32x8>,
    pub(super) triangle: <T::Triangle as TriangleTest>::Prepared<T::Wide>,
}

impl<T: Tier> PreparedRays<T> {
    /// Prepares rays for a tree whose coordinates are at most `scale`.
    #[inline(always)]
    pub(super) fn new(ray: RayLanes<T::Wide>, scale: f32) -> Self {
        let narrow = |v: Vec3<T::Wide>| Vec3 {
            x: T::nearest_f32(v.x),
            y: T::nearest_f32(v.y),
            z: T::nearest_f32(v.z),
        };
        let cull = CullRay::new(narrow(ray.origin), narrow(ray.direction), wide::f32x8::splat(scale));
        Self { cull, triangle: T::Triangle::prepare(&ray), ray }
    }
}

/// Puts the primitives of a leaf to the query; true if any was accepted.
#[inline(always)]
pub(super) fn visit_leaf<T: Tier, W: Walk, Q: Query<T::Wide>>(
    accel: &Accel,
    leaf: ChildRef,
    rays: &PreparedRays<T>,
    query: &mut Q,
) -> bool {
    const TRIANGLE: u8 = PrimKind::Triangle as u8;
    const SPHERE: u8 = PrimKind::Sphere as u8;
    let ray = &rays.ray;
    match leaf.kind() {
        TRIANGLE => {
            let block = &accel.triangles[leaf.index() as usize];
            visit_block::<T, W, Q, _>(block, ray, query, |step, limit| {
                T::Triangle::test(ray, &rays.triangle, block.corners::<W, _>(step), limit)
            })
        }
        SPHERE => {
            let block = &accel.spheres[leaf.index() as usize];
            visit_block::<T, W, Q, _>(block, ray, query, |step, _| {
                T::Curved::sphere(ray, &block.spheres::<W, _>(step))
            })
        }
        _ => {
            let block = &accel.cylinders[leaf.index() as usize];
            visit_block::<T, W, Q, _>(block, ray, query, |step, _| {
                T::Curved::cylinder(ray, &block.cylinders::<W, _>(step))
            })
        }
    }
}

#[inline(always)]
fn visit_block<T: Tier, W: Walk, Q: Query<T::Wide>, B: Block>(
    block: &B,
    ray: &RayLanes<T::Wide>,
    query: &mut Q,
    test: impl Fn(usize, T::Wide) -> LaneHit<T::Wide>,
) -> bool {
    let mut accepted = false;
    for step in 0..W::steps(block.count()) {
        let hit = test(step, query.limit());
        accepted |= query.accept(ray, &hit, W::ids(block.ids(), step));
    }
    accepted
}
