//! How rays are put to the primitives of a block of each kind.

use super::{OneForTriangles, TestRays};
use crate::accel::block::{
    Block, CylinderBlock, Picks, PrimitivesByRay, RaysByPrimitive, SphereBlock, TriangleBlock, Walk,
};
use crate::accel::node::ChildRef;
use crate::accel::query::Query;
use crate::accel::{Accel, unchecked};
use crate::intersect::triangle::Glimpse;
use crate::intersect::{Curved, LaneHit, RayLanes, Tier, TriangleTest, cylinder, sphere};
use crate::math::{Lane, Mask};

/// Lanes of eight rays of a tier.
pub(in crate::accel) type Lanes<T> = <<T as Tier>::Wide as Lane>::Mask;

/// A block that rays of a tier can be tested against.
pub(in crate::accel) trait Testable: Block + Sized {
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

    /// Up to how many candidates cost less when each is met by itself.
    const FEW: usize = 0;

    /// Meets one ray with primitive `i`, which it may hit.
    fn hit_one<T: Tier>(&self, i: usize, ray: &RayLanes<T::Real>, limit: T::Real) -> LaneHit<T::Real>;

    /// Meets those lanes with such primitives, each of a block of its own.
    fn hit_candidates<T: Tier>(
        picks: Picks<Self>,
        lanes: Lanes<T>,
        rays: &RayLanes<T::Wide>,
        limit: T::Wide,
    ) -> LaneHit<T::Wide>;

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
    fn hit_one<T: Tier>(&self, i: usize, ray: &RayLanes<T::Real>, limit: T::Real) -> LaneHit<T::Real> {
        T::Triangle::test_candidates(ray, self.corners::<RaysByPrimitive, _>(i), limit)
    }

    #[inline(always)]
    fn hit_candidates<T: Tier>(
        picks: Picks<Self>,
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
    ($block:ty, $primitives:ident, $kind:ident, $hit:ident) => {
        impl Testable for $block {
            #[inline(always)]
            fn may_hit<T: Tier, W: Walk>(&self, step: usize, rays: &TestRays<T>) -> Lanes<T> {
                $kind::may_hit(rays.ray, &self.$primitives::<W, _>(step))
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
                let lanes = $kind::may_hit(&ray, &primitives) & self.there::<T>();
                if lanes.any() { (lanes & !$kind::is_behind(&ray, &primitives)).bits() } else { 0 }
            }

            const FEW: usize = 2;

            #[inline(always)]
            fn hit_one<T: Tier>(&self, i: usize, ray: &RayLanes<T::Real>, _: T::Real) -> LaneHit<T::Real> {
                T::Curved::$hit(true, ray, &self.$primitives::<RaysByPrimitive, _>(i))
            }

            #[inline(always)]
            fn hit_candidates<T: Tier>(
                picks: Picks<Self>,
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
                lanes & $kind::surely_hits(rays.ray, &self.$primitives::<W, _>(step), limit)
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
                let (ray, primitives, limit) = (rays.ray, self.$primitives::<W, _>(step), query.limit());
                let lanes = lanes & !$kind::is_behind(ray, &primitives);
                if Q::ANY {
                    return lanes & limit.gt(ray.t_min);
                }
                // Nothing lies beyond what has not been found.
                let found = limit.lt(ray.t_max).any();
                if found { lanes & !$kind::is_beyond(ray, &primitives, limit) } else { lanes }
            }
        }
    };
}

curved!(SphereBlock, spheres, sphere, hit_sphere);
curved!(CylinderBlock, cylinders, cylinder, hit_cylinder);
