//! How much of a tree a ray visits: the measure of a tree apart from the speed of a machine.

use super::Accel;
use super::block::PrimitivesByRay;
use super::descend::{Descend, Heading, Octant};
use super::leaf::{AllPrimitives, PreparedRays, with_block};
use super::node::ChildRef;
use super::query::{Closest, Query};
use crate::intersect::{Ray, RayLanes, Tier, Watertight};

/// What one ray, or many, visited.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Visits {
    /// Nodes: eight boxes each.
    pub nodes: u64,
    /// Leaf blocks of up to eight primitives; instances count as one, and are not entered.
    pub blocks: u64,
    /// Rays that hit a primitive of the world's own.
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
    /// What a ray visits that traverses alone, on the way to its nearest hit or, if `any` will do, to the first it finds.
    ///
    /// A loop of its own, so that the one that is timed carries no counters.
    pub fn visits(&self, ray: &Ray, any: bool) -> Visits {
        let rays = PreparedRays::<Watertight>::new(RayLanes::splat(&RayLanes::from(ray)), self.world);
        let heading = Heading { octant: Octant::of(&rays.cull), region: () };
        let t_min = Watertight::below_f32(rays.ray.t_min);
        let (mut visits, mut query) = (Visits::default(), Closest::new(rays.ray.t_max));
        let mut stack = vec![PrimitivesByRay::entry(ChildRef::node(self.world.node))];
        while let Some(entry) = stack.pop() {
            let limit = query.limit();
            if any && visits.hits > 0 || PrimitivesByRay::reaching(&entry, limit) == 0 {
                continue;
            }
            let child = entry.child;
            if child.is_node() {
                visits.nodes += 1;
                let node = &self.nodes[child.index() as usize];
                PrimitivesByRay::push_children(self, node, &rays.cull, &heading, (t_min, limit), &mut stack);
                continue;
            }
            visits.blocks += 1;
            let mut all = AllPrimitives { rays: &rays, query: &mut query };
            if child.kind() != Self::INSTANCE && with_block(self, child, &mut all) {
                query.share_limit();
                visits.hits = 1;
            }
        }
        visits
    }
}
