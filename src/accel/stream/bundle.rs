//! Up to 64 rays down the tree together: their pyramid against eight children a test.
//!
//! Plainly: each packet of eight rays is tested against every primitive that the pyramid of all rays meets. Departures:
//! - in a leaf the pyramid is tested against eight primitives at once, then a primitive against the pyramids of eight
//!   packets at once; only the pairs that are left run the primitive test;
//! - a bundle that meets many primitives is given up: its rays are too far apart for the size of the primitives, and the
//!   packets go on from what they have found.

use super::frustum::{Boxes, Frustum};
use crate::accel::Accel;
use crate::accel::block::RaysByPrimitive;
use crate::accel::descend::descend;
use crate::accel::leaf::{BlockVisitor, TestRays, Testable, with_block};
use crate::accel::node::ChildRef;
use crate::accel::query::Query;
use crate::accel::{packet, single};
use crate::intersect::{RayLanes, Tier};
use crate::math::WIDTH;

/// Primitives met by the pyramid after which a bundle is given up: two a ray.
const BUDGET: usize = 2 * WIDTH * WIDTH;

/// Packets of a bundle with what they ask.
pub(super) struct Bundle<'a, T: Tier, Q> {
    pub(super) frustum: Frustum,
    pub(super) rays: &'a [RayLanes<T::Wide>],
    /// Prepared when first tested: many packets meet nothing.
    pub(super) prepared: &'a mut [Option<TestRays<T>>; WIDTH],
    pub(super) queries: &'a mut [Q],
    /// Primitives that the pyramid met.
    pub(super) met: usize,
}

/// Stacks of a worker, empty between calls.
pub(super) struct Stacks<'a> {
    pub(super) bundle: &'a mut Vec<single::Entry>,
    pub(super) packet: &'a mut Vec<packet::Entry>,
}

impl<T: Tier, Q: Query<T::Wide>> Bundle<'_, T, Q> {
    /// Puts everything below `root` to the queries that their rays may hit; false if given up.
    pub(super) fn descend(&mut self, accel: &Accel, root: u32, stacks: Stacks) -> bool {
        let stack = stacks.bundle;
        stack.push(single::Entry::new(f32::NEG_INFINITY, ChildRef::node(root)));
        while let Some(entry) = stack.pop() {
            let child = entry.child;
            if entry.near > self.frustum.reach {
                continue;
            }
            if child.is_node() {
                self.push_children(accel, child, stack);
            } else if child.kind() == Accel::INSTANCE {
                self.visit_instances(accel, child, stacks.packet);
            } else {
                with_block(accel, child, self);
                if self.met > BUDGET {
                    stack.clear();
                    return false;
                }
            }
        }
        true
    }

    #[inline(always)]
    fn push_children(&self, accel: &Accel, child: ChildRef, stack: &mut Vec<single::Entry>) {
        let node = &accel.nodes[child.index() as usize];
        let (meets, near) = self.frustum.children(node);
        let near = near.to_array();
        for slot in (0..WIDTH).rev().map(|i| i ^ self.frustum.octant) {
            if meets >> slot & 1 != 0 && !node.child[slot].is_empty() {
                stack.push(single::Entry::new(near[slot], node.child[slot]));
            }
        }
    }

    #[inline(never)]
    fn visit_instances(&mut self, accel: &Accel, leaf: ChildRef, stack: &mut Vec<packet::Entry>) {
        for (j, (rays, query)) in self.rays.iter().zip(&mut *self.queries).enumerate() {
            accel.visit_instances::<T, Q>(leaf, rays, query, |root, local, query| {
                descend::<T, RaysByPrimitive, Q>(accel, root, local, query, stack)
            });
            self.frustum.look(j, T::above_f32(query.limit()));
        }
        self.frustum.update_reach();
    }

    /// Tests the primitives of a block that the pyramid meets, each against the packets that may meet it.
    #[inline(always)]
    fn visit_primitives<B: Testable>(
        &mut self,
        block: &B,
        met: u32,
        packets: impl Fn(&Frustum, usize) -> u32,
    ) -> bool {
        let mut left = met & ((1 << block.count()) - 1);
        self.met += left.count_ones() as usize;
        let mut accepted = 0;
        while left != 0 {
            let i = left.trailing_zeros() as usize & 7;
            left &= left - 1;
            accepted |= self.visit_packets(block, i, packets(&self.frustum, i));
        }
        if accepted != 0 {
            self.look_again(accepted);
        }
        accepted != 0
    }

    /// Draws in what packets that found something look for.
    #[inline(always)]
    fn look_again(&mut self, packets: u32) {
        let mut left = packets;
        while left != 0 {
            let j = left.trailing_zeros() as usize & 7;
            left &= left - 1;
            self.frustum.look(j, T::above_f32(self.queries[j].limit()));
        }
        self.frustum.update_reach();
    }

    /// Tests primitive `i` of a block against packets; gives those that accepted a hit.
    #[inline(always)]
    fn visit_packets<B: Testable>(&mut self, block: &B, i: usize, packets: u32) -> u32 {
        let mut accepted = 0;
        let mut left = packets & ((1 << self.rays.len()) - 1);
        while left != 0 {
            let j = left.trailing_zeros() as usize & 7;
            left &= left - 1;
            let rays = self.prepared[j].get_or_insert_with(|| TestRays::new(self.rays[j]));
            accepted |= u32::from(block.visit::<T, RaysByPrimitive, Q>(i, rays, &mut self.queries[j])) << j;
        }
        accepted
    }
}

impl<T: Tier, Q: Query<T::Wide>> BlockVisitor for Bundle<'_, T, Q> {
    #[inline(always)]
    fn visit<B: Testable>(&mut self, block: &B) -> bool {
        match block.corners_of_triangles() {
            Some(corners) => {
                let edges = self.frustum.edges(corners);
                self.visit_primitives(block, self.frustum.triangles(&edges), |f, i| f.packets_at(&edges, i))
            }
            None => {
                let extent = [0, 1, 2].map(|k| block.extent(k));
                let boxes: Boxes = self.frustum.view().boxes(|k| extent[k][0], |k| extent[k][1]);
                self.visit_primitives(block, self.frustum.primitives(&boxes), |f, i| f.packets(&boxes, i))
            }
        }
    }
}
