//! The binary tree over the primitives: what [`super::plan`] and [`super::collapse`] turn into nodes of eight.

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

/// The nodes over all items, which end up in the order of the leaves; empty without items.
pub(super) fn grow(items: &mut [Item]) -> Vec<BinaryNode> {
    if items.is_empty() { Vec::new() } else { grow_shared(items, 0, 0).concat() }
}

/// The nodes over a range, in pieces: tasks share the range until pieces are small.
fn grow_shared(items: &mut [Item], first: u32, depth: u32) -> Vec<Vec<BinaryNode>> {
    if items.len() <= GRAIN {
        let mut nodes = Vec::new();
        grow_alone(items, first, depth, &mut nodes);
        return vec![nodes];
    }
    let (mut node, middle) = open(items, first, depth);
    let Some(middle) = middle else { return vec![vec![node]] };
    let (left, right) = items.split_at_mut(middle);
    let (left, right) = rayon::join(
        || grow_shared(left, first, depth + 1),
        || grow_shared(right, first + middle as u32, depth + 1),
    );
    node.right = 1 + left.iter().map(Vec::len).sum::<usize>() as u32;
    std::iter::once(vec![node]).chain(left).chain(right).collect()
}

fn grow_alone(items: &mut [Item], first: u32, depth: u32, nodes: &mut Vec<BinaryNode>) {
    let (node, middle) = open(items, first, depth);
    let at = nodes.len();
    nodes.push(node);
    let Some(middle) = middle else { return };
    let (left, right) = items.split_at_mut(middle);
    grow_alone(left, first, depth + 1, nodes);
    nodes[at].right = (nodes.len() - at) as u32;
    grow_alone(right, first + middle as u32, depth + 1, nodes);
}

/// The node of a range, as a leaf, and where it parts if it is none.
fn open(items: &mut [Item], first: u32, depth: u32) -> (BinaryNode, Option<usize>) {
    let extent = Extent::of(items);
    let node = BinaryNode { bounds: extent.bounds.to_aabb(), first, len: items.len() as u32, right: 0 };
    (node, split(items, &extent, depth))
}
