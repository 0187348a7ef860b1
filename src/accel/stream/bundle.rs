//! Up to 64 rays down the tree together: their pyramid against eight children a test.
//!
//! Plainly: each packet of eight rays is tested against every primitive that the pyramid of all rays meets. Departures:
//! - in a leaf the pyramid is tested against eight primitives at once, then a primitive against the pyramids of eight
//!   packets at once; only the pairs that are left run the primitive test;
//! - a bundle that meets many leaves is given up: its rays are too far apart for the size of the primitives, and the
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

/// Leaves after which a bundle is given up.
const LEAF_BUDGET: usize = 48;

/// Packets of a bundle with what they ask.
pub(super) struct Bundle<'a, T: Tier, Q> {
    pub(super) frustum: Frustum,
    pub(super) rays: &'a [RayLanes<T::Wide>],
    /// Prepared when first tested: many packets meet nothing.
    pub(super) prepared: &'a mut [Option<TestRays<T>>; WIDTH],
    pub(super) queries: &'a mut [Q],
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
        let mut leaves = 0;
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
                leaves += 1;
                if leaves > LEAF_BUDGET {
                    stack.clear();
                    return false;
                }
                with_block(accel, child, self);
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

    /// Tests primitive `i` of a block against those of the packets that are left.
    #[inline(always)]
    fn visit_packets<B: Testable>(&mut self, block: &B, i: usize, packets: u32) -> bool {
        let mut any = false;
        let mut left = packets & ((1 << self.rays.len()) - 1);
        while left != 0 {
            let j = left.trailing_zeros() as usize;
            left &= left - 1;
            let query = &mut self.queries[j];
            let rays = self.prepared[j].get_or_insert_with(|| TestRays::new(self.rays[j]));
            if block.visit::<T, RaysByPrimitive, Q>(i, rays, query) {
                self.frustum.look(j, T::above_f32(query.limit()));
                any = true;
            }
        }
        any
    }
}

impl<T: Tier, Q: Query<T::Wide>> BlockVisitor for Bundle<'_, T, Q> {
    #[inline(always)]
    fn visit<B: Testable>(&mut self, block: &B) -> bool {
        let extent = [0, 1, 2].map(|k| block.extent(k));
        let boxes: Boxes = self.frustum.view().boxes(|k| extent[k][0], |k| extent[k][1]);
        let mut left = self.frustum.primitives(&boxes) & ((1 << block.count()) - 1);
        if left == 0 {
            return false;
        }
        let edges = block.corners_of_triangles().map(|corner| self.frustum.edges(corner));
        if let Some(edges) = &edges {
            left &= self.frustum.triangles(edges);
        }
        let mut any = false;
        while left != 0 {
            let i = left.trailing_zeros() as usize;
            left &= left - 1;
            let mut packets = self.frustum.packets(&boxes, i);
            if let Some(edges) = &edges {
                packets &= self.frustum.packets_at_edges(edges, i);
            }
            any |= self.visit_packets(block, i, packets);
        }
        if any {
            self.frustum.update_reach();
        }
        any
    }
}
