//! Up to 256 rays down the tree together: their pyramid against eight children a test.
//!
//! Plainly: each packet of eight rays is tested against every primitive that the pyramid of all rays meets. Departures:
//! - leaves: see [`leaf`];
//! - a bundle that meets many primitives is given up: its rays are too far apart for the size of the primitives, and the
//!   packets go on from what they have found.

mod leaf;
mod planes;
mod workplace;

use super::frustum::{Apex, Frustum};
use super::{GROUP, first_packets, numbers};
use crate::accel::Accel;
use crate::accel::block::RaysByPrimitive;
use crate::accel::descend::descend;
use crate::accel::instance::TreeRoot;
use crate::accel::leaf::{PreparedRays, with_block};
use crate::accel::node::ChildRef;
use crate::accel::query::Query;
use crate::accel::{packet, single, unchecked};
use crate::intersect::{RayLanes, Tier};
use crate::math::{Lane, Mask, WIDTH};
use workplace::Inside;
pub(super) use workplace::Workplace;

/// Primitives met by the pyramid, a ray, up to which a bundle pays, and those after which it is given up: by then it costs less
/// to go on than to begin otherwise, unless there are many more.
const PAYS: usize = 6;
const BUDGET: usize = 8;
/// The same for a large bundle where any hit will do: parts of it often have all they need.
const LARGE_PAYS_FOR_ANY: usize = 2;
const LARGE_BUDGET_FOR_ANY: usize = 4;
/// Primitives a ray up to which a small bundle says that a large one would pay.
const LITTLE: usize = 2;
/// How many a triangle counts as where any hit will do: rays that go alone seldom need all that a pyramid meets, and are fast
/// at triangles.
const TRIANGLE_FOR_ANY: usize = 2;

/// Primitives that an instance counts as for rays that start on surfaces: what is near for a camera's rays is far apart
/// for those, so a bundle of them goes into most instances for a few rays' sake.
const SCATTERED: usize = 3 * GROUP * WIDTH;

/// How many entries of the stack may come before the last.
const CHOICE: usize = 3;

/// Packets of a bundle with what they ask.
pub(super) struct Bundle<'a, T: Tier, Q> {
    frustum: &'a mut Frustum,
    rays: &'a [RayLanes<T::Wide>],
    work: &'a mut Workplace<T>,
    queries: &'a mut [Q],
    /// Primitives that the pyramid met, by what they count as.
    met: usize,
}

/// Stacks of a worker, empty between calls.
pub(super) struct Stacks<'a> {
    pub(super) bundle: &'a mut Vec<single::Entry>,
    pub(super) packet: &'a mut Vec<packet::Entry>,
}

impl<'a, T: Tier, Q: Query<T::Wide>> Bundle<'a, T, Q> {
    /// The bundle of some rays; `None` where they do not make one.
    #[inline(always)]
    pub(super) fn new(
        rays: &'a [RayLanes<T::Wide>],
        apex: Apex,
        tree: TreeRoot,
        (frustum, work): (&'a mut Frustum, &'a mut Workplace<T>),
        queries: &'a mut [Q],
    ) -> Option<Self> {
        frustum.surround::<T>(rays, apex, tree)?;
        (work.is_prepared, work.waits) = (0, 0);
        let mut bundle = Self { frustum, rays, work, queries, met: 0 };
        (0..rays.len()).for_each(|j| bundle.look(j));
        bundle.frustum.update_reach();
        Some(bundle)
    }

    /// True if it met so little that a large one in its place would pay.
    pub(super) fn has_met_little(&self) -> bool {
        self.met <= LITTLE * self.rays.len() * WIDTH
    }

    /// True if its rays had better go together, and its neighbours' rays too.
    pub(super) fn has_paid(&self) -> bool {
        self.met <= self.per_ray(PAYS, LARGE_PAYS_FOR_ANY)
    }

    /// So many primitives a ray, or so many in a large bundle where any hit will do.
    fn per_ray(&self, count: usize, large_for_any: usize) -> usize {
        let is_large = self.rays.len() > GROUP;
        self.rays.len() * WIDTH * if is_large && Q::ANY { large_for_any } else { count }
    }

    /// Puts everything below `root` to the queries that their rays may hit; false if given up.
    pub(super) fn descend(&mut self, accel: &Accel, root: u32, stacks: &mut Stacks) -> bool {
        let done = self.visit_all(accel, root, stacks);
        while self.work.ahead.step() {}
        self.settle_all();
        done
    }

    /// [`Self::descend`] but for the distances that wait.
    #[inline(always)]
    fn visit_all(&mut self, accel: &Accel, root: u32, stacks: &mut Stacks) -> bool {
        let (base, budget) = (stacks.bundle.len(), self.per_ray(BUDGET, LARGE_BUDGET_FOR_ANY));
        stacks.bundle.push(single::Entry::new(f32::NEG_INFINITY, ChildRef::node(root)));
        while stacks.bundle.len() > base
            && let Some(entry) = if Q::ANY { stacks.bundle.pop() } else { take_nearest(stacks.bundle, base) }
        {
            let child = entry.child;
            if entry.near > self.frustum.reach {
                continue;
            }
            if child.is_node() {
                self.push_children(accel, child, stacks.bundle);
            } else if child.kind() == Accel::INSTANCE {
                self.visit_instance(accel, child, stacks);
            } else {
                with_block(accel, child, self);
            }
            self.work.ahead.step();
            if self.met > budget {
                stacks.bundle.truncate(base);
                return false;
            }
        }
        true
    }

    #[inline(always)]
    fn push_children(&self, accel: &Accel, child: ChildRef, stack: &mut Vec<single::Entry>) {
        let node = &accel.nodes[child.index() as usize];
        let (meets, near) = self.frustum.children(node);
        let (near, octant) = (near.to_array(), self.frustum.octant);
        // Which come next is guessed from the branches: looked up, they would be waited for.
        for slot in (0..WIDTH).rev().map(|i| (i ^ octant) % WIDTH) {
            // Boxes of free slots are met by none.
            if meets >> slot & 1 != 0 {
                debug_assert!(!node.child[slot].is_empty());
                unchecked::prefetch(accel, node.child[slot]);
                stack.push(single::Entry::new(near[slot], node.child[slot]));
            }
        }
    }

    /// Goes through an instance: with the pyramid of its rays in there, or else packet by packet.
    #[inline(never)]
    fn visit_instance(&mut self, accel: &Accel, leaf: ChildRef, stacks: &mut Stacks) {
        if !matches!(self.frustum.apex(), Apex::Origin(_)) {
            self.met += SCATTERED;
        }
        let placed = accel.placed(leaf);
        let mut inner = self.work.inner.take().unwrap_or_default();
        let Inside { rays, frustum, work } = &mut *inner;
        let rays = &mut rays[..self.rays.len()];
        rays.iter_mut()
            .zip(self.rays)
            .for_each(|(local, ray)| *local = Accel::local_rays(&placed.to_world, ray));
        let apex = self.frustum.apex().in_space_of(&placed.to_world);
        self.queries.iter_mut().for_each(|query| query.enter_instance(placed.row + 1));
        self.settle_all();
        let inside = Bundle::<T, Q>::new(rays, apex, placed.tree, (frustum, work), self.queries);
        let done = inside.is_some_and(|mut inside| {
            let done = inside.descend(accel, placed.tree.node, stacks);
            // Rays that go alone are slower at instances: in there a triangle counts as any primitive.
            self.met += inside.met / if Q::ANY { TRIANGLE_FOR_ANY } else { 1 };
            done
        });
        for (j, ray) in rays.iter().enumerate() {
            let query = &mut self.queries[j];
            if !done {
                let rays = PreparedRays::new(*ray, placed.tree);
                let _ =
                    descend::<T, RaysByPrimitive, Q>(accel, placed.tree, None, &rays, query, stacks.packet);
            }
            query.enter_instance(0);
            self.look(j);
        }
        self.work.inner = Some(inner);
        self.frustum.update_reach();
    }

    /// Finds all distances that wait.
    fn settle_all(&mut self) {
        for j in numbers(if Q::ANY { 0 } else { std::mem::take(&mut self.work.waits) }) {
            self.work.pending[j].settle(&self.rays[j], &mut self.queries[j]);
        }
    }

    /// All packets, as bits.
    #[inline(always)]
    fn all(&self) -> u32 {
        first_packets(self.rays.len())
    }

    /// Draws in what packet `j` looks for; [`Frustum::update_reach`] must follow.
    #[inline(always)]
    fn look(&mut self, j: usize) {
        let limit = self.queries[j].limit();
        self.frustum.look(j, T::above_f32(limit));
        if Q::ANY {
            self.work.asks[j] = limit.gt(T::Wide::zero()).bits();
        }
    }
}

/// Takes what starts nearest among the last few. Hits found early spare what lies behind them; to look at all would cost more.
#[inline(always)]
fn take_nearest(stack: &mut Vec<single::Entry>, base: usize) -> Option<single::Entry> {
    let mut last = stack.pop()?;
    let from = base.max(stack.len().saturating_sub(CHOICE));
    for entry in &mut stack[from..] {
        if entry.near < last.near {
            std::mem::swap(entry, &mut last);
        }
    }
    Some(last)
}
