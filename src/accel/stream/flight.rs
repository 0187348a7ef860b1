//! Rays that go anywhere: one by one, but many at a time.
//!
//! Plainly: a ray pops the nearest child off its stack and tests eight boxes or eight primitives, until its stack is empty.
//! Alone it waits for memory and for branches that nobody can predict. So many rays are under way, and the loops go over
//! them by kind of work instead of along one ray:
//! - the *node pass* moves each ray whose next child is a node one step, without a branch;
//! - the *leaf pass* tests the leaves that have gathered;
//! - the *refill* hands out answers and starts waiting rays.
//!
//! Each ray visits what it would visit alone, in the same order. On its way into an instance it leaves a note on its stack
//! that brings it back out.

mod seeds;
mod slot;
mod spaces;
mod view;

use wide::u32x8;

use super::Answers;
use super::candidates::{Candidates, room_for};
use super::columns::RayColumns;
use crate::accel::Accel;
use crate::accel::block::{Block, TriangleBlock};
use crate::accel::node::ChildRef;
use crate::accel::order::far_first;
use crate::accel::query::Query;
use crate::accel::unchecked::{self, Slots, Stacks};
use crate::intersect::{LaneHit, RayLanes, Tier, TriangleTest};
use crate::math::{Lane, Mask, Stored, WIDTH, eight};
use seeds::Waiting;
use slot::Slot;

pub(super) use seeds::Alone;

/// Rays under way.
const SLOTS: usize = 32;
/// Room in the lists: one more than slots, as a list is written before it is known whether the slot belongs there.
const LIST: usize = SLOTS + 1;
/// Rays out of nodes that gather before they are seen to.
const GATHER: usize = 24;
/// Rays in nodes below which the others are seen to however few.
const FEW: usize = 4;
/// Rays that are done before others start in their place.
const DONE: usize = 8;

/// What lies on the stack below what a ray visits in the space of an instance.
const LEAVE: ChildRef = ChildRef::leaf(ChildRef::LAST_KIND, 0);

/// Scratch for rays under way.
pub(super) struct Flight<T: Tier, Q> {
    slots: Vec<Slot<T, Q>>,
    in_nodes: Slots<LIST>,
    /// At a leaf, or done.
    out_of_nodes: Slots<LIST>,
    in_leaves: Slots<LIST>,
    /// At leaves of anything but triangles.
    at_others: Slots<LIST>,
    at_instances: Slots<LIST>,
    candidates: Box<Candidates<{ room_for(SLOTS) }>>,
    done: Slots<LIST>,
    stacks: Stacks,
}

impl<T: Tier, Q: Query<T::Real> + Copy> Flight<T, Q> {
    pub(super) fn new(accel: &Accel) -> Self {
        Self {
            slots: Vec::new(),
            in_nodes: Slots::new(),
            out_of_nodes: Slots::new(),
            in_leaves: Slots::new(),
            at_others: Slots::new(),
            at_instances: Slots::new(),
            candidates: Box::default(),
            done: Slots::new(),
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
        let Some(mut waiting) = Waiting::<T, A, S>::new(accel, rays, alone) else { return };
        self.fill(accel, &mut waiting);
        loop {
            self.node_pass(accel);
            if self.out_of_nodes.len() < GATHER && self.in_nodes.len() >= FEW {
                continue;
            }
            self.leaf_pass(accel);
            if self.done.len() >= DONE || self.in_nodes.len() == 0 {
                self.refill(accel, &mut waiting, answers);
                if self.in_nodes.len() + self.out_of_nodes.len() == 0 {
                    return;
                }
            }
        }
    }

    /// Starts as many rays as there are slots.
    fn fill<A: Answers<T, One = Q>, S: Stored<T::Wide>>(
        &mut self,
        accel: &Accel,
        waiting: &mut Waiting<T, A, S>,
    ) {
        self.stacks.make(SLOTS);
        for at in 0..SLOTS {
            let Some((seeds, i)) = waiting.next() else { return };
            if self.slots.len() == at {
                self.slots.push(Slot::of(seeds, i));
            }
            self.slots[at].start(seeds, i, accel.world.node, self.stacks.bottom(at));
            self.in_nodes.push_if(true, at);
        }
    }

    /// Moves each ray that is in a node one step.
    #[inline(always)]
    fn node_pass(&mut self, accel: &Accel) {
        let count = self.in_nodes.len();
        self.in_nodes.clear();
        for i in 0..count {
            let at = self.in_nodes.get(i);
            let slot = &mut self.slots[at];
            let node = unchecked::node(accel, slot.next);
            let (enter, meets) = slot.children(node);
            let (order, count) = (far_first(slot.octant(), meets), meets.count_ones());
            let top = slot.top as usize;
            // Not read back from the stack, which would wait for what is written there.
            let (nearest, below) = (node.child[order.last(count)], self.stacks.child(top - 1));
            let next = if count == 0 { below } else { nearest };
            let child = u32x8::new(eight(|i| node.child[i].bits())).shuffle_wrapping(order.lanes());
            self.stacks.write(top, child, enter.shuffle_wrapping(order.lanes()));
            self.go_on(at, next, top + count as usize - 1, accel);
        }
    }

    /// Takes a ray to the child that stands, or would, at place `top` of the stacks.
    #[inline(always)]
    fn go_on(&mut self, at: usize, next: ChildRef, top: usize, accel: &Accel) {
        let slot = &mut self.slots[at];
        slot.top = top as u32;
        slot.next = next;
        unchecked::prefetch(accel, next);
        self.in_nodes.push_if(next.is_node(), at);
        self.out_of_nodes.push_if(!next.is_node(), at);
    }

    /// Tests the leaves that have gathered: first all for triangles that may be hit, then those, eight at a time.
    #[inline(always)]
    fn leaf_pass(&mut self, accel: &Accel) {
        self.find_candidates(accel);
        for first in (0..self.candidates.len()).step_by(WIDTH) {
            self.test_candidates(accel, first);
        }
        for i in 0..self.at_others.len() {
            let at = self.at_others.get(i);
            let slot = &mut self.slots[at];
            let next = slot.next;
            self.at_instances.push_if(next.kind() == Accel::INSTANCE, at);
            if next == LEAVE {
                slot.leave();
            } else if next.kind() < Accel::INSTANCE {
                // Where the slabs of huge scenes overflow, a ray may seem to meet even the box of a free slot.
                slot.test_block(accel);
            }
        }
        if self.at_instances.len() > 0 {
            self.enter_instances(accel);
        }
        for i in 0..self.in_leaves.len() {
            self.leave_leaf(accel, self.in_leaves.get(i));
        }
    }

    /// Tells the rays at leaves from those that are done, and finds out which triangles of the leaves may be hit.
    #[inline(always)]
    fn find_candidates(&mut self, accel: &Accel) {
        self.in_leaves.clear();
        for i in 0..self.out_of_nodes.len() {
            let at = self.out_of_nodes.get(i);
            let is_done = self.slots[at].next == Stacks::END;
            self.done.push_if(is_done, at);
            self.in_leaves.push_if(!is_done, at);
        }
        self.out_of_nodes.clear();
        self.candidates.clear();
        self.at_others.clear();
        for i in 0..self.in_leaves.len() {
            let at = self.in_leaves.get(i);
            let slot = &self.slots[at];
            self.candidates.push(at, slot.candidates(accel));
            self.at_others.push_if(!slot.is_at_triangles(), at);
        }
    }

    /// Tests up to eight candidates, whosever they are.
    #[inline(always)]
    fn test_candidates(&mut self, accel: &Accel, first: usize) {
        let (pairs, count) = self.candidates.eight(first);
        let slots = eight(|i| &self.slots[pairs[i].row()]);
        let blocks = eight(|i| unchecked::triangles(accel, slots[i].next));
        let rays = RayLanes::<T::Wide>::gather(|i| slots[i].ray());
        let corners = TriangleBlock::gather(&blocks, &eight(|i| pairs[i].lane()));
        let limit = T::Wide::from_fn(|i| slots[i].query.limit());
        let hits = T::Triangle::test_candidates(&rays, corners, limit);
        let mut left = hits.mask.bits() & ((1 << count) - 1);
        while left != 0 {
            let i = left.trailing_zeros() as usize & 7;
            left &= left - 1;
            let slot = &mut self.slots[pairs[i].row()];
            let id = blocks[i].ids()[pairs[i].lane()];
            let hit = LaneHit { mask: true, t: hits.t.get(i), u: hits.u.get(i), v: hits.v.get(i) };
            slot.accept(&hit, id);
        }
    }

    /// Draws the limit in to what was found in a leaf, and goes on.
    #[inline(always)]
    fn leave_leaf(&mut self, accel: &Accel, at: usize) {
        let slot = &mut self.slots[at];
        let mut top = slot.top as usize;
        if slot.accepted {
            slot.accepted = false;
            slot.limit = T::above_f32(T::Wide::splat(slot.query.limit())).get(0);
            let bottom = self.stacks.bottom(at);
            top = match slot.query.is_done() {
                true => bottom + 1,
                false => self.stacks.keep_within(bottom, top, slot.limit),
            };
        }
        self.go_on(at, self.stacks.child(top - 1), top - 1, accel);
    }

    /// Hands out the answers of the rays that are done and starts waiting ones.
    fn refill<A: Answers<T, One = Q>, S: Stored<T::Wide>>(
        &mut self,
        accel: &Accel,
        waiting: &mut Waiting<T, A, S>,
        answers: &mut A,
    ) {
        for i in 0..self.done.len() {
            let at = self.done.get(i);
            let slot = &mut self.slots[at];
            answers.store_one(slot.row as usize, &slot.query);
            if let Some((seeds, i)) = waiting.next() {
                slot.start(seeds, i, accel.world.node, self.stacks.bottom(at));
                self.in_nodes.push_if(true, at);
            }
        }
        self.done.clear();
    }
}
