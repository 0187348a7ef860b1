//! From the binary tree to nodes of eight, in the order in which they are stored.

use rayon::prelude::*;

use super::binary::BinaryNode;
use super::item::GRAIN;
use super::numbers::Member;
use super::plan::{Children, Plan};
use super::{KINDS, Leaf, octant};
use crate::accel::node::{ChildRef, Node8};
use crate::accel::unchecked::reserve;
use crate::math::{Aabb, WIDTH};

/// The binary tree, what becomes of its nodes, and the primitives in its order: what collapsing reads.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub(super) nodes: &'a [BinaryNode],
    pub(super) plans: &'a [Plan],
    pub(super) members: &'a [Member],
}

/// A part of the wide tree, numbered from zero.
pub(super) struct Fragment {
    pub(super) nodes: Vec<Node8>,
    /// Leaves by kind, in the order of their numbers.
    pub(super) leaves: [Vec<Leaf>; KINDS],
    /// Nodes on the longest way down.
    pub(super) depth: u32,
}

/// Binary nodes that become one of eight, usually: 10 where surfaces are smooth, 23 in hair.
const BINARY_NODES_A_NODE: f64 = 9.5;

/// The nodes above one binary subtree; its root first.
pub(super) fn collapse(source: Source, root: usize) -> Fragment {
    let mut fragment = Fragment { nodes: Vec::new(), leaves: Default::default(), depth: 0 };
    if source.nodes[root].len as usize <= GRAIN {
        let share = f64::from(source.nodes[root].len) / source.members.len() as f64;
        let usual = share * source.nodes.len() as f64 / BINARY_NODES_A_NODE;
        fragment.nodes.reserve(usual as usize + 1);
    }
    fragment.depth = fragment.grow(source, root);
    fragment
}

impl Fragment {
    /// Appends the wide node over a binary subtree, its leaves, then the nodes below; gives the depth.
    fn grow(&mut self, source: Source, root: usize) -> u32 {
        let at = self.nodes.len();
        self.nodes.push(Node8::EMPTY);
        let mut below = Vec::with_capacity(WIDTH);
        for (slot, child) in in_slots(source, root) {
            self.nodes[at].set_bounds(slot, &source.nodes[child].bounds);
            if source.plans[child].is_leaf() {
                self.nodes[at].child[slot] = self.push_leaf(source, child);
            } else {
                below.push((slot, child));
            }
        }
        let shared = source.nodes[root].len as usize > GRAIN;
        1 + if shared { self.grow_shared(source, at, &below) } else { self.grow_alone(source, at, &below) }
    }

    fn grow_alone(&mut self, source: Source, at: usize, below: &[(usize, usize)]) -> u32 {
        let mut depth = 0;
        for &(slot, child) in below {
            self.nodes[at].child[slot] = ChildRef::node(self.nodes.len() as u32);
            depth = depth.max(self.grow(source, child));
        }
        depth
    }

    fn grow_shared(&mut self, source: Source, at: usize, below: &[(usize, usize)]) -> u32 {
        let parts: Vec<Self> = below.par_iter().map(|&(_, child)| collapse(source, child)).collect();
        let depth = parts.iter().map(|part| part.depth).max().unwrap_or(0);
        reserve(&mut self.nodes, parts.iter().map(|part| part.nodes.len()).sum());
        for (&(slot, _), part) in below.iter().zip(parts) {
            self.nodes[at].child[slot] = ChildRef::node(self.nodes.len() as u32);
            self.append(part);
        }
        depth
    }

    fn push_leaf(&mut self, source: Source, child: usize) -> ChildRef {
        let BinaryNode { first, len, .. } = source.nodes[child];
        let kind = source.plans[child].kind();
        let leaves = &mut self.leaves[usize::from(kind)];
        leaves.push(Leaf { kind, len: len as u8, first });
        ChildRef::leaf(kind, leaves.len() as u32 - 1)
    }

    fn append(&mut self, part: Self) {
        let mut by = std::array::from_fn(|kind| self.leaves[kind].len() as u32);
        by[usize::from(ChildRef::NODE)] = self.nodes.len() as u32;
        self.nodes.extend(part.nodes.into_iter().map(|node| moved(node, &by)));
        for (leaves, more) in self.leaves.iter_mut().zip(part.leaves) {
            leaves.extend(more);
        }
    }
}

/// The node with each reference moved by what its kind moved.
pub(super) fn moved(mut node: Node8, by: &[u32; KINDS]) -> Node8 {
    node.child = node.child.map(|child| child.moved(by));
    node
}

/// The children of a wide node with their slots, slots ascending.
fn in_slots(source: Source, root: usize) -> impl Iterator<Item = (usize, usize)> {
    let leaf = source.plans[root].is_leaf();
    let children = if leaf { Children::lone(root) } else { Children::of(source.nodes, source.plans, root) };
    let mut bounds = [Aabb::EMPTY; WIDTH];
    for (bounds, &child) in bounds.iter_mut().zip(children.as_slice()) {
        *bounds = source.nodes[child].bounds;
    }
    let slots = octant::assign(&bounds[..children.as_slice().len()]);
    (0..WIDTH).filter_map(move |slot| slots[slot].map(|child| (slot, children.as_slice()[child])))
}
