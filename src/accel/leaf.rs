//! Testing the primitives of a leaf, for every walk, query and tier.

use super::Accel;
use super::block::{Block, CylinderBlock, SphereBlock, TriangleBlock, Walk};
use super::instance::TreeRoot;
use super::node::ChildRef;
use super::query::Query;
use crate::intersect::aabb::CullRay;
use crate::intersect::{Curved, LaneHit, PrimKind, RayLanes, Tier, TriangleTest};
use crate::math::{Lane, Mask, Vec3};
use std::marker::PhantomData;

/// Rays with all that the primitive tests of a tier prepare once a ray.
#[derive(Clone, Copy)]
pub(super) struct TestRays<T: Tier> {
    pub(super) ray: RayLanes<T::Wide>,
    pub(super) triangle: <T::Triangle as TriangleTest>::Prepared<T::Wide>,
}

impl<T: Tier> TestRays<T> {
    #[inline(always)]
    pub(super) fn new(ray: RayLanes<T::Wide>) -> Self {
        Self { triangle: T::Triangle::prepare(&ray), ray }
    }
}

/// Rays prepared for boxes and primitives.
#[derive(Clone, Copy)]
pub(super) struct PreparedRays<T: Tier> {
    pub(super) test: TestRays<T>,
    pub(super) cull: CullRay<wide::f32x8>,
}

impl<T: Tier> PreparedRays<T> {
    /// Prepares rays for a tree.
    #[inline(always)]
    pub(super) fn new(ray: RayLanes<T::Wide>, tree: TreeRoot) -> Self {
        Self { cull: cull_rays::<T>(&ray, tree), test: TestRays::new(ray) }
    }
}

/// Rays prepared for the boxes of a tree.
#[inline(always)]
pub(super) fn cull_rays<T: Tier>(ray: &RayLanes<T::Wide>, tree: TreeRoot) -> CullRay<wide::f32x8> {
    let narrow =
        |v: Vec3<T::Wide>| Vec3 { x: T::nearest_f32(v.x), y: T::nearest_f32(v.y), z: T::nearest_f32(v.z) };
    let origin = narrow(ray.origin);
    CullRay::new(origin, narrow(ray.direction), tree.scale_for(origin))
}

/// Lanes of eight rays of a tier.
pub(super) type Lanes<T> = <<T as Tier>::Wide as Lane>::Mask;

/// A block that rays of a tier can be tested against.
pub(super) trait Testable: Block {
    /// Lanes whose rays may hit the primitives at a step of the walk, as far as is cheap to tell.
    fn may_hit<T: Tier, W: Walk>(&self, step: usize, rays: &TestRays<T>) -> Lanes<T>;

    /// Meets those lanes with the primitives at a step of the walk.
    fn hit<T: Tier, W: Walk>(
        &self,
        step: usize,
        lanes: Lanes<T>,
        rays: &TestRays<T>,
        limit: T::Wide,
    ) -> LaneHit<T::Wide>;

    /// Puts lanes that may hit the primitives at a step of the walk to the query; true if any was accepted.
    #[inline(always)]
    fn ask<T: Tier, W: Walk, Q: Query<T::Wide>>(
        &self,
        step: usize,
        lanes: Lanes<T>,
        rays: &TestRays<T>,
        query: &mut Q,
    ) -> bool {
        let hit = self.hit::<T, W>(step, lanes, rays, query.limit());
        query.accept(&rays.ray, &hit, W::ids(self.ids(), step))
    }

    /// Puts the primitives at a step of the walk to the query; true if any was accepted.
    #[inline(always)]
    fn visit<T: Tier, W: Walk, Q: Query<T::Wide>>(
        &self,
        step: usize,
        rays: &TestRays<T>,
        query: &mut Q,
    ) -> bool {
        let lanes = self.may_hit::<T, W>(step, rays);
        lanes.any() && self.ask::<T, W, Q>(step, lanes, rays, query)
    }
}

impl Testable for TriangleBlock {
    #[inline(always)]
    fn may_hit<T: Tier, W: Walk>(&self, step: usize, rays: &TestRays<T>) -> Lanes<T> {
        T::Triangle::may_hit(&rays.ray, &rays.triangle, self.corners::<W, _>(step))
    }

    #[inline(always)]
    fn hit<T: Tier, W: Walk>(
        &self,
        step: usize,
        lanes: Lanes<T>,
        rays: &TestRays<T>,
        limit: T::Wide,
    ) -> LaneHit<T::Wide> {
        T::Triangle::hit(lanes, &rays.ray, &rays.triangle, self.corners::<W, _>(step), limit)
    }
}

impl Testable for SphereBlock {
    #[inline(always)]
    fn may_hit<T: Tier, W: Walk>(&self, step: usize, rays: &TestRays<T>) -> Lanes<T> {
        T::Curved::may_hit_sphere(&rays.ray, &self.spheres::<W, _>(step))
    }

    #[inline(always)]
    fn hit<T: Tier, W: Walk>(
        &self,
        step: usize,
        lanes: Lanes<T>,
        rays: &TestRays<T>,
        _: T::Wide,
    ) -> LaneHit<T::Wide> {
        T::Curved::hit_sphere(lanes, &rays.ray, &self.spheres::<W, _>(step))
    }
}

impl Testable for CylinderBlock {
    #[inline(always)]
    fn may_hit<T: Tier, W: Walk>(&self, step: usize, rays: &TestRays<T>) -> Lanes<T> {
        T::Curved::may_hit_cylinder(&rays.ray, &self.cylinders::<W, _>(step))
    }

    #[inline(always)]
    fn hit<T: Tier, W: Walk>(
        &self,
        step: usize,
        lanes: Lanes<T>,
        rays: &TestRays<T>,
        _: T::Wide,
    ) -> LaneHit<T::Wide> {
        T::Curved::hit_cylinder(lanes, &rays.ray, &self.cylinders::<W, _>(step))
    }
}

/// What is done with the block of a leaf, whatever its kind.
pub(super) trait BlockVisitor {
    /// Visits a block; true if a hit was accepted.
    fn visit<B: Testable>(&mut self, block: &B) -> bool;
}

/// Shows the visitor the block of a leaf.
#[inline(always)]
pub(super) fn with_block(accel: &Accel, leaf: ChildRef, visitor: &mut impl BlockVisitor) -> bool {
    const TRIANGLE: u8 = PrimKind::Triangle as u8;
    const SPHERE: u8 = PrimKind::Sphere as u8;
    let index = leaf.index() as usize;
    match leaf.kind() {
        TRIANGLE => visitor.visit(&accel.triangles[index]),
        SPHERE => visitor.visit(&accel.spheres[index]),
        _ => visitor.visit(&accel.cylinders[index]),
    }
}

/// Puts all primitives of a block to one query.
pub(super) struct AllSteps<'a, T: Tier, W, Q> {
    pub(super) rays: &'a TestRays<T>,
    pub(super) query: &'a mut Q,
    pub(super) walk: PhantomData<W>,
}

impl<T: Tier, W: Walk, Q: Query<T::Wide>> BlockVisitor for AllSteps<'_, T, W, Q> {
    #[inline(always)]
    fn visit<B: Testable>(&mut self, block: &B) -> bool {
        let mut accepted = false;
        for step in 0..W::steps(block.count()) {
            accepted |= block.visit::<T, W, Q>(step, self.rays, self.query);
        }
        accepted
    }
}
