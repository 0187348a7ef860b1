//! The binary tree over the primitives: what [`super::plan`] and [`super::collapse`] turn into nodes of eight.

use super::Quality;
use super::item::{Extent, GRAIN, Item};
use super::split::split;
use crate::math::Aabb;

/// A node of the binary tree, in depth-first order: the left child follows at once.
#[derive(Clone, Copy, Debug)]
pub(super) struct BinaryNode {
    pub(super) bounds: Aabb,
    /// First item of the range below.
    pub(super) first: u32,
    /// Items below.
    pub(super) len: u32,
    /// Distance to the right child; 0 for a leaf. A distance holds wherever the subtree is moved.
    pub(super) right: u32,
}

impl BinaryNode {
    /// A leaf over a range.
    pub(super) fn leaf(extent: &Extent, first: u32, len: usize) -> Self {
        Self { bounds: extent.bounds.to_aabb(), first, len: len as u32, right: 0 }
    }
}

/// The nodes over all items, which end up in the order of the leaves; empty without items.
pub(super) fn grow(items: &mut [Item], quality: Quality) -> Vec<BinaryNode> {
    if items.is_empty() { Vec::new() } else { grow_shared(items, 0, 0, quality).concat() }
}

/// Appends the nodes over a range; ranges count from 0.
pub(super) fn grow_onto(nodes: &mut Vec<BinaryNode>, items: &mut [Item], depth: u32, quality: Quality) {
    if items.len() <= GRAIN {
        return grow_alone(items, 0, depth, quality, nodes);
    }
    grow_shared(items, 0, depth, quality).iter().for_each(|piece| nodes.extend_from_slice(piece));
}

/// The nodes over a range, in pieces: tasks share the range until pieces are small.
fn grow_shared(items: &mut [Item], first: u32, depth: u32, quality: Quality) -> Vec<Vec<BinaryNode>> {
    if items.len() <= GRAIN {
        // Most leaves hold several; what is not needed stays untouched.
        let mut nodes = Vec::with_capacity(items.len());
        grow_alone(items, first, depth, quality, &mut nodes);
        return vec![nodes];
    }
    let (mut node, middle) = open(items, first, depth, quality);
    let Some(middle) = middle else { return vec![vec![node]] };
    let (left, right) = items.split_at_mut(middle);
    let (left, right) = rayon::join(
        || grow_shared(left, first, depth + 1, quality),
        || grow_shared(right, first + middle as u32, depth + 1, quality),
    );
    node.right = 1 + left.iter().map(Vec::len).sum::<usize>() as u32;
    std::iter::once(vec![node]).chain(left).chain(right).collect()
}

fn grow_alone(items: &mut [Item], first: u32, depth: u32, quality: Quality, nodes: &mut Vec<BinaryNode>) {
    let (node, middle) = open(items, first, depth, quality);
    let at = nodes.len();
    nodes.push(node);
    let Some(middle) = middle else { return };
    let (left, right) = items.split_at_mut(middle);
    grow_alone(left, first, depth + 1, quality, nodes);
    nodes[at].right = (nodes.len() - at) as u32;
    grow_alone(right, first + middle as u32, depth + 1, quality, nodes);
}

/// The node of a range, as a leaf, and where it parts if it is none.
fn open(items: &mut [Item], first: u32, depth: u32, quality: Quality) -> (BinaryNode, Option<usize>) {
    let extent = Extent::of(items);
    (BinaryNode::leaf(&extent, first, items.len()), split(items, &extent, depth, quality))
}

/// Sets ranges to where the items ended up: leaves hold them one after the other.
pub(super) fn number(nodes: &mut [BinaryNode]) {
    for at in (0..nodes.len()).rev() {
        let right = nodes[at].right as usize;
        if right != 0 {
            nodes[at].len = nodes[at + 1].len + nodes[at + right].len;
        }
    }
    let mut next = 0;
    for node in nodes {
        node.first = next;
        next += if node.right == 0 { node.len } else { 0 };
    }
}
