//! How much of a tree a ray visits: the measure of a tree apart from the speed of a machine.

use wide::f32x8;

use super::Accel;
use super::block::PrimitivesByRay;
use super::node::ChildRef;
use crate::intersect::aabb::CullRay;
use crate::intersect::{PrimKind, Ray, RayLanes, Tier, TriangleTest, Watertight};
use crate::math::{Aabb, Lane, Mask, Vec3, WIDTH};

/// What one ray, or many, visited on the way to the nearest triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Visits {
    /// Nodes.
    pub nodes: u64,
    /// Leaf blocks.
    pub blocks: u64,
    /// Rays that hit a triangle.
    pub hits: u64,
}

impl std::ops::AddAssign for Visits {
    fn add_assign(&mut self, o: Self) {
        self.nodes += o.nodes;
        self.blocks += o.blocks;
        self.hits += o.hits;
    }
}

impl Accel {
    /// What a ray visits that traverses alone, front to back, through the world's own triangles; blocks of other kinds and
    /// of instances count, but are not entered.
    pub fn visits(&self, ray: &Ray) -> Visits {
        type Prepared = <<Watertight as Tier>::Triangle as TriangleTest>::Prepared<f32x8>;
        let lanes = RayLanes::<f32x8>::splat(&RayLanes::from(ray));
        let cull = CullRay::new(lanes.origin, lanes.direction, self.world.scale_for(lanes.origin));
        let prepared: Prepared = <Watertight as Tier>::Triangle::prepare(&lanes);
        let octant = (0..3).map(|k| usize::from(ray.direction[k] < 0.0) << k).sum::<usize>();
        let (mut visits, mut limit) = (Visits::default(), ray.t_max);
        let mut stack = vec![(f32::NEG_INFINITY, ChildRef::node(self.world.node))];
        while let Some((near, child)) = stack.pop() {
            if near > limit {
                continue;
            }
            if child.is_node() {
                visits.nodes += 1;
                let node = &self.nodes[child.index() as usize];
                for slot in (0..WIDTH).rev().map(|i| i ^ octant).filter(|&slot| !node.child[slot].is_empty())
                {
                    let enter = enters(&cull, &node.bounds(slot), ray.t_min, limit);
                    stack.extend(enter.map(|near| (near, node.child[slot])));
                }
                continue;
            }
            visits.blocks += 1;
            if child.kind() == PrimKind::Triangle as u8 {
                let corners = self.triangles[child.index() as usize].corners::<PrimitivesByRay, _>(0);
                let hit =
                    <Watertight as Tier>::Triangle::test(&lanes, &prepared, corners, f32x8::splat(limit));
                let nearer = (hit.mask & hit.t.gt(lanes.t_min)).bits();
                let t = (0..WIDTH).filter(|lane| nearer >> lane & 1 != 0).map(|lane| hit.t.get(lane));
                limit = t.fold(limit, f32::min);
            }
        }
        visits.hits = u64::from(limit < ray.t_max);
        visits
    }
}

/// Where a ray enters a box, if it does before `limit`.
fn enters(cull: &CullRay<f32x8>, bounds: &Aabb, t_min: f32, limit: f32) -> Option<f32> {
    let (lo, hi) = (Vec3::splat_f32(bounds.min), Vec3::splat_f32(bounds.max));
    let (enter, leave) = cull.interval_any(lo, hi, f32x8::splat(t_min), f32x8::splat(limit));
    let (enter, leave) = (Lane::get(enter, 0), Lane::get(leave, 0));
    (enter <= leave).then_some(enter)
}
