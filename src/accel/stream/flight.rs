//! Rays that go anywhere: one by one, but many at a time.
//!
//! Plainly: a ray pops the nearest child off its stack and tests eight boxes or eight primitives, until its stack is empty.
//! Alone it waits for memory and for branches that nobody can predict. So many rays are under way, and the loops go over
//! them by kind of work instead of along one ray:
//! - the *node pass* moves each ray whose next child is a node one step, without a branch;
//! - the *leaf pass* tests the leaves that have gathered;
//! - the *refill* hands out answers and starts waiting rays, eight at a time.
//!
//! Each ray visits what it would visit alone, in the same order. On its way into an instance it leaves a note on its stack
//! that brings it back out.

mod leaves;
mod seeds;
mod slot;
mod slots;
mod spaces;
mod view;

use super::answers::Answers;
use super::candidates::{Candidates, room_for};
use super::columns::RayColumns;
use super::numbers;
use crate::accel::Accel;
use crate::accel::block::{CylinderBlock, SphereBlock, TriangleBlock};
use crate::accel::node::{ChildRef, Node8};
use crate::accel::query::Query;
use crate::accel::unchecked::{self, Stacks};
use crate::intersect::{PrimKind, Tier};
use crate::math::{Lane, Stored, WIDTH};
use seeds::Seeds;
use slot::Slot;
use slots::{SLOTS, SlotSet};

pub(super) use seeds::Alone;

/// Rays out of nodes that gather before they are seen to.
const GATHER: usize = 24;
/// Rays in nodes below which the others are seen to however few.
const FEW: usize = 4;

/// What lies on the stack below what a ray visits in the space of an instance.
const LEAVE: ChildRef = ChildRef::leaf(ChildRef::LAST_KIND, 0);

/// Scratch for rays under way.
pub(super) struct Flight<T: Tier, Q> {
    /// None until rays go alone.
    slots: Vec<Slot<T, Q>>,
    /// Hold a ray.
    taken: SlotSet,
    /// Of these, the next child is a node.
    in_nodes: SlotSet,
    /// Found something in the leaf that is next.
    found: SlotSet,
    candidates: Box<Candidates<{ room_for(SLOTS) }>>,
    stacks: Stacks,
}

impl<T: Tier, Q: Query<T::Real> + Copy> Flight<T, Q> {
    pub(super) fn new(accel: &Accel) -> Self {
        Self {
            slots: Vec::new(),
            taken: SlotSet::default(),
            in_nodes: SlotSet::default(),
            found: SlotSet::default(),
            candidates: Box::default(),
            stacks: Stacks::new(accel.stack_bound),
        }
    }

    /// Answers the rays that go alone.
    pub(super) fn trace<A: Answers<T, One = Q>, S: Stored<T::Wide>>(
        &mut self,
        accel: &Accel,
        rays: &RayColumns<S>,
        alone: &Alone,
        answers: &mut A,
    ) {
        self.stacks.make(SLOTS);
        let mut waiting = alone.runs();
        loop {
            while (!self.taken).len() >= WIDTH {
                let Some(run) = waiting.next() else { break };
                self.start(accel, &Seeds::<T, A>::new(accel, rays, run), alone.entry(run));
            }
            if self.taken.is_empty() {
                return;
            }
            while {
                self.node_pass(accel);
                (self.taken & !self.in_nodes).len() < GATHER && self.in_nodes.len() >= FEW
            } {}
            self.leaf_pass(accel, answers);
        }
    }

    /// Starts up to eight rays, at the root or at a node that stands for the tree to them. **Needs:** eight slots that are free.
    #[inline(always)]
    fn start<A: Answers<T, One = Q>>(&mut self, accel: &Accel, seeds: &Seeds<T, A>, entry: Option<&Node8>) {
        if self.slots.is_empty() {
            self.slots.resize(SLOTS, Slot::of(seeds, 0));
        }
        let mut started = SlotSet::default();
        for (i, at) in numbers(u32::from(seeds.lanes)).map(|i| i % WIDTH).zip(!self.taken) {
            self.slots[at].start(seeds, i, accel.world.node, self.stacks.bottom(at));
            started.insert_if(true, at);
        }
        self.taken |= started;
        let in_nodes = entry.map_or(started, |node| self.enter(accel, node, started));
        self.in_nodes |= in_nodes;
    }

    /// Takes rays through a node that stands for the tree; gives those that are in a node next.
    #[inline(never)]
    fn enter(&mut self, accel: &Accel, node: &Node8, started: SlotSet) -> SlotSet {
        let mut in_nodes = SlotSet::default();
        for at in started {
            let slot = &mut self.slots[at];
            slot.step(node, accel, &mut self.stacks);
            in_nodes.insert_if(slot.next.is_node(), at);
        }
        in_nodes
    }

    /// Moves each ray that is in a node one step. In a function of its own, whose loop has all registers to itself.
    #[inline(never)]
    fn node_pass(&mut self, accel: &Accel) {
        let Ok(slots) = <&mut [Slot<T, Q>; SLOTS]>::try_from(&mut self.slots[..]) else { return };
        let stacks = &mut self.stacks;
        let mut still = SlotSet::default();
        for at in self.in_nodes {
            let slot = &mut slots[at];
            let node = unchecked::node(accel, slot.next);
            slot.step(node, accel, stacks);
            still.insert_if(slot.next.is_node(), at);
        }
        self.in_nodes = still;
    }

    /// Tests the leaves that have gathered, first all for triangles that may be hit, then those, eight at a time; answers
    /// the rays that are done.
    #[inline(always)]
    fn leaf_pass<A: Answers<T, One = Q>>(&mut self, accel: &Accel, answers: &mut A) {
        let [done, at_triangles, at_others] = self.sort();
        for at in done {
            let slot = &self.slots[at];
            answers.store_one(slot.row as usize, &slot.query);
        }
        self.taken = self.taken & !done;
        self.found = SlotSet::default();
        self.test_leaves::<TriangleBlock>(accel, at_triangles);
        if !at_others.is_empty() {
            self.visit_others(accel, at_others);
        }
        self.draw_in(self.found);
        self.leave_leaves(accel, at_triangles | at_others);
    }

    /// The rays out of nodes: those that are done, those at leaves of triangles, and those at anything else.
    #[inline(always)]
    fn sort(&self) -> [SlotSet; 3] {
        let out = self.taken & !self.in_nodes;
        let (mut done, mut at_triangles) = (SlotSet::default(), SlotSet::default());
        for at in out {
            let next = self.slots[at].next;
            done.insert_if(next == Stacks::END, at);
            at_triangles.insert_if(next.is_triangles(), at);
        }
        [done, at_triangles, out & !(done | at_triangles)]
    }

    /// Visits leaves of anything but triangles, and goes in and out of instances.
    #[inline(never)]
    fn visit_others(&mut self, accel: &Accel, at_others: SlotSet) {
        let [mut at_spheres, mut at_cylinders, mut at_instances] = [SlotSet::default(); 3];
        for at in at_others {
            let slot = &mut self.slots[at];
            // Where the slabs of huge scenes overflow, a ray may seem to meet even the box of a free slot.
            at_spheres.insert_if(slot.next.kind() == PrimKind::Sphere as u8, at);
            at_cylinders.insert_if(slot.next.kind() == PrimKind::Cylinder as u8, at);
            at_instances.insert_if(slot.next.kind() == Accel::INSTANCE, at);
            if slot.next == LEAVE {
                slot.leave();
            }
        }
        if !(at_spheres | at_cylinders).is_empty() {
            self.test_leaves::<SphereBlock>(accel, at_spheres);
            self.test_leaves::<CylinderBlock>(accel, at_cylinders);
        }
        if !at_instances.is_empty() {
            self.enter_instances(accel, at_instances);
        }
    }

    /// Draws limits in to what was found, and drops what lies beyond them.
    #[inline(always)]
    fn draw_in(&mut self, found: SlotSet) {
        for at in found {
            let slot = &mut self.slots[at];
            slot.limit = T::above_f32(T::Wide::splat(slot.query.limit())).get(0);
            let (bottom, top) = (self.stacks.bottom(at), slot.top as usize);
            slot.top = match slot.query.is_done() {
                true => bottom + 1,
                false => self.stacks.keep_within(bottom, top, slot.limit),
            } as u32;
        }
    }

    /// Goes on from leaves to what stands on the stacks.
    #[inline(always)]
    fn leave_leaves(&mut self, accel: &Accel, at_leaves: SlotSet) {
        for at in at_leaves {
            let slot = &mut self.slots[at];
            let top = slot.top as usize - 1;
            slot.go_on(self.stacks.child(top), top, accel);
            self.in_nodes.insert_if(slot.next.is_node(), at);
        }
    }
}
