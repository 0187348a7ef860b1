//! Testing the primitives of a leaf, for every walk, query and tier.

use std::cell::OnceCell;

use wide::f32x8;

use super::Accel;
use super::block::{
    Block, CylinderBlock, Picks, PrimitivesByRay, RaysByPrimitive, SphereBlock, TriangleBlock, Walk,
};
use super::instance::TreeRoot;
use super::node::ChildRef;
use super::pending::Pending;
use super::query::Query;
use super::region::Region;
use super::unchecked;
use crate::intersect::aabb::CullRay;
use crate::intersect::triangle::Glimpse;
use crate::intersect::{Curved, LaneHit, PrimKind, RayLanes, Tier, TriangleTest};
use crate::math::{Lane, Mask, Vec3, WIDTH};

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

/// Lanes of eight rays of a tier.
pub(super) type Lanes<T> = <<T as Tier>::Wide as Lane>::Mask;

/// A block that rays of a tier can be tested against.
pub(super) trait Testable: Block + Sized {
    /// Lanes whose rays may hit the primitives at a step of the walk, as far as is cheap to tell.
    fn may_hit<T: Tier, W: Walk>(&self, step: usize, rays: &TestRays<T>) -> Lanes<T>;

    /// Lanes that hold a primitive: of free ones, which hold NaN, no test is certain that they miss.
    #[inline(always)]
    fn there<T: Tier>(&self) -> Lanes<T> {
        Mask::from_bits((1 << self.count()) - 1)
    }

    /// Meets those lanes with the primitives at a step of the walk.
    fn hit<T: Tier, W: Walk>(
        &self,
        step: usize,
        lanes: Lanes<T>,
        rays: &TestRays<T>,
        limit: T::Wide,
    ) -> LaneHit<T::Wide>;

    /// The block that a reference leads to.
    fn of(accel: &Accel, leaf: ChildRef) -> &Self;

    /// Primitives that one ray may hit, as bits.
    fn candidates<T: Tier>(&self, ray: &RayLanes<T::Real>, triangle: &OneForTriangles<T>) -> u32;

    /// Meets those lanes with such primitives, each of a block of its own.
    fn hit_candidates<T: Tier>(
        picks: &Picks<Self>,
        lanes: Lanes<T>,
        rays: &RayLanes<T::Wide>,
        limit: T::Wide,
    ) -> LaneHit<T::Wide>;

    /// Of the lanes that may hit, those that do not certainly go away, as far as is cheap to tell beside meeting them.
    #[inline(always)]
    fn ahead<T: Tier, W: Walk>(&self, _: usize, lanes: Lanes<T>, _: &TestRays<T>) -> Lanes<T> {
        lanes
    }

    /// Of the lanes that may hit, those that a query needs, as far as is cheap to tell beside meeting them.
    #[inline(always)]
    fn needed<T: Tier, W: Walk, Q: Query<T::Wide>>(
        &self,
        _: usize,
        lanes: Lanes<T>,
        _: &TestRays<T>,
        _: &Q,
    ) -> Lanes<T> {
        lanes
    }

    /// Of the lanes that a query needs, those that certainly hit before `limit`, as far as is cheap to tell.
    #[inline(always)]
    fn surely<T: Tier, W: Walk>(&self, _: usize, _: Lanes<T>, _: &TestRays<T>, _limit: T::Wide) -> Lanes<T> {
        Mask::splat(false)
    }

    /// What is certain without meeting them, where there is a cheap way to tell.
    #[inline(always)]
    fn glimpse<T: Tier, W: Walk>(&self, _step: usize, _: &TestRays<T>) -> Option<Glimpse<T::Wide>> {
        None
    }

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
        query.accept(rays.ray, &hit, W::ids(self.ids(), step))
    }
}

impl Testable for TriangleBlock {
    #[inline(always)]
    fn may_hit<T: Tier, W: Walk>(&self, step: usize, rays: &TestRays<T>) -> Lanes<T> {
        let none = Mask::splat(false);
        rays.triangle.map_or(none, |t| T::Triangle::may_hit(rays.ray, t, self.corners::<W, _>(step)))
    }

    #[inline(always)]
    fn hit<T: Tier, W: Walk>(
        &self,
        step: usize,
        lanes: Lanes<T>,
        rays: &TestRays<T>,
        limit: T::Wide,
    ) -> LaneHit<T::Wide> {
        let Some(triangle) = rays.triangle else { return LaneHit::none() };
        T::Triangle::hit(lanes, rays.ray, triangle, self.corners::<W, _>(step), limit)
    }

    #[inline(always)]
    fn of(accel: &Accel, leaf: ChildRef) -> &Self {
        unchecked::triangles(accel, leaf)
    }

    #[inline(always)]
    fn candidates<T: Tier>(&self, ray: &RayLanes<T::Real>, triangle: &OneForTriangles<T>) -> u32 {
        T::Triangle::candidates::<T::Wide>(ray, triangle, self.corner_columns())
    }

    #[inline(always)]
    fn hit_candidates<T: Tier>(
        picks: &Picks<Self>,
        _: Lanes<T>,
        rays: &RayLanes<T::Wide>,
        limit: T::Wide,
    ) -> LaneHit<T::Wide> {
        T::Triangle::test_candidates(rays, Self::gather(picks), limit)
    }

    #[inline(always)]
    fn glimpse<T: Tier, W: Walk>(&self, step: usize, rays: &TestRays<T>) -> Option<Glimpse<T::Wide>> {
        T::Triangle::glimpse(rays.ray, rays.triangle?, self.corners::<W, _>(step))
    }
}

/// Curved primitives are met alike, each kind by functions of its own.
macro_rules! curved {
    ($block:ty, $primitives:ident, $may_hit:ident, $ahead:ident, $within:ident, $surely:ident, $hit:ident) => {
        impl Testable for $block {
            #[inline(always)]
            fn may_hit<T: Tier, W: Walk>(&self, step: usize, rays: &TestRays<T>) -> Lanes<T> {
                T::Curved::$may_hit(rays.ray, &self.$primitives::<W, _>(step))
            }

            #[inline(always)]
            fn hit<T: Tier, W: Walk>(
                &self,
                step: usize,
                lanes: Lanes<T>,
                rays: &TestRays<T>,
                _: T::Wide,
            ) -> LaneHit<T::Wide> {
                T::Curved::$hit(lanes, rays.ray, &self.$primitives::<W, _>(step))
            }

            #[inline(always)]
            fn of(accel: &Accel, leaf: ChildRef) -> &Self {
                &accel.$primitives[leaf.index() as usize]
            }

            #[inline(always)]
            fn candidates<T: Tier>(&self, ray: &RayLanes<T::Real>, _: &OneForTriangles<T>) -> u32 {
                let (ray, primitives) =
                    (RayLanes::<T::Wide>::splat(ray), self.$primitives::<PrimitivesByRay, _>(0));
                let lanes = T::Curved::$may_hit(&ray, &primitives) & self.there::<T>();
                if lanes.any() { T::Curved::$ahead(lanes, &ray, &primitives).bits() } else { 0 }
            }

            #[inline(always)]
            fn hit_candidates<T: Tier>(
                picks: &Picks<Self>,
                lanes: Lanes<T>,
                rays: &RayLanes<T::Wide>,
                _: T::Wide,
            ) -> LaneHit<T::Wide> {
                T::Curved::$hit(lanes, rays, &Self::gather(picks))
            }

            #[inline(always)]
            fn surely<T: Tier, W: Walk>(
                &self,
                step: usize,
                lanes: Lanes<T>,
                rays: &TestRays<T>,
                limit: T::Wide,
            ) -> Lanes<T> {
                T::Curved::$surely(lanes, rays.ray, &self.$primitives::<W, _>(step), limit)
            }

            #[inline(always)]
            fn ahead<T: Tier, W: Walk>(&self, step: usize, lanes: Lanes<T>, rays: &TestRays<T>) -> Lanes<T> {
                T::Curved::$ahead(lanes, rays.ray, &self.$primitives::<W, _>(step))
            }

            /// Lanes that still ask, or those that may hit before what was found.
            #[inline(always)]
            fn needed<T: Tier, W: Walk, Q: Query<T::Wide>>(
                &self,
                step: usize,
                lanes: Lanes<T>,
                rays: &TestRays<T>,
                query: &Q,
            ) -> Lanes<T> {
                let (lanes, limit) = (self.ahead::<T, W>(step, lanes, rays), query.limit());
                match Q::ANY {
                    true => lanes & limit.gt(rays.ray.t_min),
                    false => T::Curved::$within(lanes, rays.ray, &self.$primitives::<W, _>(step), limit),
                }
            }
        }
    };
}

curved!(SphereBlock, spheres, may_hit_sphere, sphere_ahead, sphere_within, sphere_surely, hit_sphere);
curved!(
    CylinderBlock,
    cylinders,
    may_hit_cylinder,
    cylinder_ahead,
    cylinder_within,
    cylinder_surely,
    hit_cylinder
);

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
