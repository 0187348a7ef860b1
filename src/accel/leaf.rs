//! Testing the primitives of a leaf, for every walk, query and tier.

mod testable;

pub(super) use testable::{Lanes, Testable};

use std::cell::OnceCell;

use wide::f32x8;

use super::Accel;
use super::block::{Block, PrimitivesByRay, RaysByPrimitive};
use super::instance::TreeRoot;
use super::node::ChildRef;
use super::pending::Pending;
use super::query::Query;
use super::region::Region;
use crate::intersect::aabb::CullRay;
use crate::intersect::{PrimKind, RayLanes, Tier, TriangleTest};
use crate::math::{Mask, Vec3, WIDTH};

/// What the triangle test of a tier prepares once a ray.
pub(super) type ForTriangles<T> = <<T as Tier>::Triangle as TriangleTest>::Prepared<<T as Tier>::Wide>;
/// The same for a ray that goes alone.
pub(super) type OneForTriangles<T> = <<T as Tier>::Triangle as TriangleTest>::OneRay<<T as Tier>::Real>;

/// Rays with all that the primitive tests of a tier prepare once a ray.
#[derive(Clone, Copy)]
pub(super) struct TestRays<'a, T: Tier> {
    pub(super) ray: &'a RayLanes<T::Wide>,
    /// None where they are put to other primitives alone.
    pub(super) triangle: Option<&'a ForTriangles<T>>,
}

/// Rays prepared for boxes and primitives.
pub(super) struct PreparedRays<T: Tier> {
    pub(super) ray: RayLanes<T::Wide>,
    /// Prepared when first asked for, as many rays meet none.
    triangle: OnceCell<ForTriangles<T>>,
    pub(super) cull: CullRay<f32x8>,
}

impl<T: Tier> PreparedRays<T> {
    /// Prepares rays for a tree.
    #[inline(always)]
    pub(super) fn new(ray: RayLanes<T::Wide>, tree: TreeRoot) -> Self {
        Self { cull: cull_rays::<T>(&ray, tree), triangle: OnceCell::new(), ray }
    }

    /// The same for the primitives of a block.
    #[inline(always)]
    fn test(&self, block: &impl Block) -> TestRays<'_, T> {
        let prepared = || self.triangle.get_or_init(|| T::Triangle::prepare(&self.ray));
        TestRays { ray: &self.ray, triangle: block.corners_of_triangles().map(|_| prepared()) }
    }
}

/// Rays prepared for the boxes of a tree.
#[inline(always)]
pub(super) fn cull_rays<T: Tier>(ray: &RayLanes<T::Wide>, tree: TreeRoot) -> CullRay<f32x8> {
    cull_rays_by::<T>(ray, |origin| tree.scale_for(origin))
}

/// Rays prepared for boxes, given what roundoffs are relative to for rays from such origins.
#[inline(always)]
pub(super) fn cull_rays_by<T: Tier>(
    ray: &RayLanes<T::Wide>,
    scale_for: impl Fn(Vec3<f32x8>) -> f32x8,
) -> CullRay<f32x8> {
    let narrow =
        |v: Vec3<T::Wide>| Vec3 { x: T::nearest_f32(v.x), y: T::nearest_f32(v.y), z: T::nearest_f32(v.z) };
    let origin = narrow(ray.origin);
    CullRay::new(origin, narrow(ray.direction), scale_for(origin))
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

/// Puts all primitives of a block to one query, eight rays to each.
pub(super) struct EachPrimitive<'a, T: Tier, Q> {
    pub(super) rays: &'a PreparedRays<T>,
    /// Around all rays, where that is worth knowing.
    pub(super) region: Option<&'a Region>,
    pub(super) query: &'a mut Q,
    pub(super) pending: &'a mut Pending<T>,
}

impl<T: Tier, Q: Query<T::Wide>> BlockVisitor for EachPrimitive<'_, T, Q> {
    /// First the cheap half of all tests, then what may hit.
    #[inline(always)]
    fn visit<B: Testable>(&mut self, block: &B) -> bool {
        let rays = self.rays.test(block);
        let (mut likely, mut count) = ([(0, 0); WIDTH + 1], 0);
        let there = (1 << block.count()) - 1;
        let near = self.region.map_or(u32::MAX, |region| region.overlapped(|k| block.extent(k)));
        let mut left = near & there;
        while left != 0 {
            let i = left.trailing_zeros() as usize & 7;
            left &= left - 1;
            let lanes = block.may_hit::<T, RaysByPrimitive>(i, &rays).bits();
            likely[count] = (i, lanes);
            count += usize::from(lanes != 0);
        }
        let mut accepted = false;
        for &(i, lanes) in &likely[..count] {
            accepted |= self.pending.ask((block, i), Mask::from_bits(lanes), &rays, self.query);
        }
        accepted
    }
}

/// Puts all primitives of a block to one query, at once to one ray.
pub(super) struct AllPrimitives<'a, T: Tier, Q> {
    pub(super) rays: &'a PreparedRays<T>,
    pub(super) query: &'a mut Q,
}

impl<T: Tier, Q: Query<T::Wide>> BlockVisitor for AllPrimitives<'_, T, Q> {
    #[inline(always)]
    fn visit<B: Testable>(&mut self, block: &B) -> bool {
        let rays = self.rays.test(block);
        let lanes = block.may_hit::<T, PrimitivesByRay>(0, &rays) & block.there::<T>();
        lanes.any() && block.ask::<T, PrimitivesByRay, Q>(0, lanes, &rays, self.query)
    }
}
