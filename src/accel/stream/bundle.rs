//! Up to 64 rays down the tree together: their pyramid against eight children a test.
//!
//! Plainly: each packet of eight rays is tested against every primitive that the pyramid of all rays meets. Departures:
//! - leaves: see [`leaf`];
//! - a bundle that meets many primitives is given up: its rays are too far apart for the size of the primitives, and the
//!   packets go on from what they have found.

mod leaf;

use super::candidates::{Candidate, Candidates, room_for};
use super::frustum::{Apex, Frustum};
use crate::accel::Accel;
use crate::accel::block::RaysByPrimitive;
use crate::accel::descend::descend;
use crate::accel::instance::TreeRoot;
use crate::accel::leaf::{ForTriangles, PreparedRays, with_block};
use crate::accel::node::ChildRef;
use crate::accel::pending::Pending;
use crate::accel::query::Query;
use crate::accel::{packet, single, unchecked};
use crate::intersect::{RayLanes, Tier, TriangleTest};
use crate::math::{Lane, Mask, WIDTH};

/// Primitives met by the pyramid up to which a bundle pays: six a ray.
const PAYS: usize = 6 * WIDTH * WIDTH;
/// Those after which it is given up: by then it costs less to go on than to begin otherwise, unless there are many more.
const BUDGET: usize = 8 * WIDTH * WIDTH;
/// How many a triangle counts as where any hit will do: rays that go alone seldom need all that a pyramid meets, and are fast
/// at triangles.
const TRIANGLE_FOR_ANY: usize = 2;

/// Primitives that an instance counts as for rays that start on surfaces: what is near for a camera's rays is far apart
/// for those, so a bundle of them goes into most instances for a few rays' sake.
const SCATTERED: usize = 3 * WIDTH * WIDTH;

/// How many entries of the stack may come before the last.
const CHOICE: usize = 3;

/// What a worker keeps for bundles.
pub(super) struct Workplace<T: Tier> {
    /// Packets prepared for triangles when first tested, as many meet none; which of them are, as bits.
    prepared: [ForTriangles<T>; WIDTH],
    is_prepared: u32,
    /// Packets of which distances may wait, as bits.
    waits: u32,
    /// True if the last triangles met cover more than the pyramid in some direction: then edges tell more than boxes do.
    meets_wide: bool,
    /// Lanes of packets that still ask whether they hit anything, as bits.
    asks: [u32; WIDTH],
    /// Pairs of a primitive of a block and a packet.
    pairs: Candidates<{ room_for(WIDTH) }>,
    /// Those that may hit, with the lanes that may.
    likely: [(Candidate, u32); room_for(WIDTH)],
    pending: [Pending<T>; WIDTH],
    /// For bundles inside of instances.
    inner: Option<Box<(Frustum, Self)>>,
}

impl<T: Tier> Default for Workplace<T> {
    fn default() -> Self {
        Self {
            prepared: [T::Triangle::prepare(&super::no_rays()); WIDTH],
            is_prepared: 0,
            waits: 0,
            meets_wide: false,
            asks: [0; WIDTH],
            pairs: Candidates::default(),
            likely: [(Candidate::default(), 0); room_for(WIDTH)],
            pending: [Pending::default(); WIDTH],
            inner: None,
        }
    }
}

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

    /// True if its rays had better go together, and its neighbours' rays too.
    pub(super) fn has_paid(&self) -> bool {
        self.met <= PAYS
    }

    /// Puts everything below `root` to the queries that their rays may hit; false if given up.
    pub(super) fn descend(&mut self, accel: &Accel, root: u32, stacks: &mut Stacks) -> bool {
        let done = self.visit_all(accel, root, stacks);
        self.settle_all();
        done
    }

    /// [`Self::descend`] but for the distances that wait.
    #[inline(always)]
    fn visit_all(&mut self, accel: &Accel, root: u32, stacks: &mut Stacks) -> bool {
        let base = stacks.bundle.len();
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
            if self.met > BUDGET {
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
            // Where its pads overflow, the pyramid seems to meet even the box of a free slot.
            if meets >> slot & 1 != 0 && !node.child[slot].is_empty() {
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
        let (root, count) = (placed.tree.node, self.rays.len());
        let local: [RayLanes<T::Wide>; WIDTH] =
            std::array::from_fn(|j| Accel::local_rays(&placed.to_world, &self.rays[j.min(count - 1)]));
        let (rays, apex) = (&local[..count], self.frustum.apex().in_space_of(&placed.to_world));
        self.queries.iter_mut().for_each(|query| query.enter_instance(placed.row + 1));
        self.settle_all();
        let mut work = self.work.inner.take().unwrap_or_default();
        let inside = Bundle::<T, Q>::new(rays, apex, placed.tree, (&mut work.0, &mut work.1), self.queries);
        let done = inside.is_some_and(|mut inside| {
            let done = inside.descend(accel, root, stacks);
            // Rays that go alone are slower at instances: in there a triangle counts as any primitive.
            self.met += inside.met / if Q::ANY { TRIANGLE_FOR_ANY } else { 1 };
            done
        });
        self.work.inner = Some(work);
        for (j, ray) in local[..count].iter().enumerate() {
            let query = &mut self.queries[j];
            if !done {
                let rays = PreparedRays::new(*ray, placed.tree);
                let _ =
                    descend::<T, RaysByPrimitive, Q>(accel, placed.tree, None, &rays, query, stacks.packet);
            }
            query.enter_instance(0);
            self.look(j);
        }
        self.frustum.update_reach();
    }

    /// Finds all distances that wait.
    fn settle_all(&mut self) {
        let mut left = if Q::ANY { 0 } else { std::mem::take(&mut self.work.waits) };
        while left != 0 {
            let j = left.trailing_zeros() as usize & 7;
            left &= left - 1;
            self.work.pending[j].settle(&self.rays[j], &mut self.queries[j]);
        }
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
