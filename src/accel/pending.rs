//! Hits that are certain but for their exact distance.
//!
//! Plainly: of each hit the distance is found in `f64`, and the nearest counts. Departure: where bounds on the distance
//! tell which of two hits is nearer, the distance waits, and is found for the nearest alone.

use super::block::{RaysByPrimitive, Walk};
use super::leaf::{Lanes, TestRays, Testable};
use super::query::Query;
use crate::intersect::triangle::Glimpse;
use crate::intersect::{LaneHit, RayLanes, Tier, TriangleTest};
use crate::math::{BitLane, Lane, Mask, Vec3, three};

/// The hits of a packet whose distance waits. The query of the packet holds a bound from above in its place.
#[derive(Clone, Copy)]
pub(super) struct Pending<T: Tier> {
    lanes: Lanes<T>,
    /// Bounds from below.
    near: T::Wide,
    /// The triangles that were hit.
    corners: [Vec3<T::Wide>; 3],
}

impl<T: Tier> Default for Pending<T> {
    fn default() -> Self {
        Self { lanes: Mask::splat(false), near: T::Wide::zero(), corners: [Vec3::zero(); 3] }
    }
}

impl<T: Tier> Pending<T> {
    /// Puts lanes that may hit primitive `i` of a block to the query, in full only where what was seen of it says too
    /// little; true if any was accepted.
    #[inline(always)]
    pub(super) fn ask<B: Testable, Q: Query<T::Wide>>(
        &mut self,
        (block, i): (&B, usize),
        lanes: Lanes<T>,
        rays: &TestRays<T>,
        query: &mut Q,
    ) -> bool {
        let Some(mut seen) = block.glimpse::<T, RaysByPrimitive>(i, rays) else {
            let mut needed = block.needed::<T, RaysByPrimitive, Q>(i, lanes, rays, query);
            let mut accepted = false;
            if Q::ANY {
                let sure = block.surely::<T, RaysByPrimitive>(i, needed, rays, query.limit());
                query.take(sure, T::Wide::zero(), BitLane::splat(block.ids()[i]));
                (accepted, needed) = (sure.any(), needed & !sure);
            }
            return needed.any() && self.meet((block, i), needed, rays, query) || accepted;
        };
        seen.inside = lanes & seen.inside;
        let (certain, mut unclear) = self.sort(&seen, rays.ray.t_min, query.limit());
        if let Some(corners) = block.corners_of_triangles().filter(|_| unclear.any()) {
            unclear =
                unclear & !T::Triangle::is_left(rays.ray, &seen, three(|v| three(|k| corners[v][k][i])));
        }
        let mut accepted = false;
        if unclear.any() {
            self.settle(rays.ray, query);
            accepted = block.ask::<T, RaysByPrimitive, Q>(i, unclear, rays, query);
        }
        self.take((block, i), certain, &seen, query) | accepted
    }

    /// Puts lanes that need primitive `i` of a block to the query. Distances go on waiting where their bounds tell which is nearer.
    #[inline(always)]
    pub(super) fn meet<B: Testable, Q: Query<T::Wide>>(
        &mut self,
        (block, i): (&B, usize),
        lanes: Lanes<T>,
        rays: &TestRays<T>,
        query: &mut Q,
    ) -> bool {
        let hit = block.hit::<T, RaysByPrimitive>(i, lanes, rays, query.limit());
        if T::Triangle::GLIMPSES && !Q::ANY {
            let reached = self.lanes & hit.mask & hit.t.le(query.limit());
            if (reached & hit.t.ge(self.near)).any() {
                self.settle(rays.ray, query);
            } else {
                // Hits at or before `t_min` do not count.
                self.lanes = self.lanes & !(reached & hit.t.gt(rays.ray.t_min));
            }
        }
        query.accept(rays.ray, &hit, RaysByPrimitive::ids(block.ids(), i))
    }

    /// Takes lanes that certainly hit primitive `i` of a block, nearer than anything so far; true if there are any.
    #[inline(always)]
    pub(super) fn take<B: Testable, Q: Query<T::Wide>>(
        &mut self,
        (block, i): (&B, usize),
        certain: Lanes<T>,
        seen: &Glimpse<T::Wide>,
        query: &mut Q,
    ) -> bool {
        query.take(certain, seen.far, BitLane::splat(block.ids()[i]));
        if let Some(corners) = block.corners_of_triangles().filter(|_| !Q::ANY) {
            self.put(certain, seen.near, three(|v| RaysByPrimitive::vec3(&corners[v], i)));
        }
        certain.any()
    }

    /// Of lanes that may be hit, those that certainly are, nearer than anything so far; and those that bounds say too
    /// little about. The others need nothing.
    #[inline(always)]
    pub(super) fn sort(
        &self,
        seen: &Glimpse<T::Wide>,
        t_min: T::Wide,
        limit: T::Wide,
    ) -> (Lanes<T>, Lanes<T>) {
        let lanes = seen.inside;
        let nearest = Lane::select(self.lanes, self.near, limit);
        let out = seen.near.gt(limit) | seen.far.le(t_min);
        let certain = lanes & seen.far.lt(nearest) & seen.near.gt(t_min) & !out;
        (certain, lanes & !(certain | out))
    }

    /// Takes hits in place of what their lanes held.
    #[inline(always)]
    fn put(&mut self, lanes: Lanes<T>, near: T::Wide, corners: [Vec3<T::Wide>; 3]) {
        self.lanes = self.lanes | lanes;
        self.near.put(lanes, near);
        for (kept, corner) in self.corners.iter_mut().zip(corners) {
            kept.x.put(lanes, corner.x);
            kept.y.put(lanes, corner.y);
            kept.z.put(lanes, corner.z);
        }
    }

    fn is_within_bounds(&self, hit: &LaneHit<T::Wide>, far: T::Wide) -> bool {
        !(self.lanes & !(self.near.le(hit.t) & hit.t.le(far))).any()
    }

    /// Finds the distances that wait.
    #[inline(always)]
    pub(super) fn settle(&mut self, ray: &RayLanes<T::Wide>, query: &mut impl Query<T::Wide>) {
        if !self.lanes.any() {
            return;
        }
        let hit = T::Triangle::settle(ray, self.corners);
        debug_assert!(self.is_within_bounds(&hit, query.limit()), "{ray:?} {:?}", self.corners);
        query.settle(self.lanes, &hit);
        self.lanes = Mask::splat(false);
    }
}
