//! The binary tree over the primitives: what [`super::plan`] and [`super::collapse`] turn into nodes of eight.

use super::Quality;
use super::item::{Extent, Item, Parted};
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

/// The nodes over all items, of which there are some, and which end up in the order of the leaves.
pub(super) fn grow(items: &mut [Item], extent: &Extent, quality: Quality) -> Vec<BinaryNode> {
    grow_shared(items, extent, Place::default(), quality).concat()
}

/// [`grow`] for a range that is parted already.
pub(super) fn grow_parted(
    items: &mut [Item],
    extent: &Extent,
    parted: Parted,
    quality: Quality,
) -> Vec<BinaryNode> {
    grow_sides(items, extent, parted, Place::default(), quality).concat()
}

/// Appends the nodes over a range; ranges count from 0.
pub(super) fn grow_onto(nodes: &mut Vec<BinaryNode>, items: &mut [Item], depth: u32, quality: Quality) {
    let (extent, place) = (Extent::of(items), Place { first: 0, depth });
    if items.len() <= ALONE {
        return grow_alone(items, &extent, place, quality, nodes);
    }
    grow_shared(items, &extent, place, quality).iter().for_each(|piece| nodes.extend_from_slice(piece));
}

/// Ranges up to this length grow by one task: few enough for any number of tasks to keep busy.
const ALONE: usize = 1 << 14;

/// Where a range is.
#[derive(Clone, Copy, Default)]
struct Place {
    /// Its first item.
    first: u32,
    /// Splits above.
    depth: u32,
}

impl Place {
    /// Places of both sides.
    fn below(self, middle: usize) -> [Self; 2] {
        let depth = self.depth + 1;
        [Self { depth, ..self }, Self { depth, first: self.first + middle as u32 }]
    }
}

/// The nodes over a range, in pieces: tasks share the range until pieces are small.
fn grow_shared(items: &mut [Item], extent: &Extent, place: Place, quality: Quality) -> Vec<Vec<BinaryNode>> {
    if items.len() <= ALONE {
        // Most leaves hold several; what is not needed stays untouched.
        let mut nodes = Vec::with_capacity(items.len());
        grow_alone(items, extent, place, quality, &mut nodes);
        return vec![nodes];
    }
    match split(items, extent, place.depth, quality) {
        Some(parted) => grow_sides(items, extent, parted, place, quality),
        None => vec![vec![BinaryNode::leaf(extent, place.first, items.len())]],
    }
}

/// The nodes over a range that was parted.
fn grow_sides(
    items: &mut [Item],
    extent: &Extent,
    Parted { middle, sides }: Parted,
    place: Place,
    quality: Quality,
) -> Vec<Vec<BinaryNode>> {
    let mut node = BinaryNode::leaf(extent, place.first, items.len());
    let (left, right) = items.split_at_mut(middle);
    let below = place.below(middle);
    let (left, right) = rayon::join(
        || grow_shared(left, &sides[0], below[0], quality),
        || grow_shared(right, &sides[1], below[1], quality),
    );
    node.right = 1 + left.iter().map(Vec::len).sum::<usize>() as u32;
    std::iter::once(vec![node]).chain(left).chain(right).collect()
}

fn grow_alone(
    items: &mut [Item],
    extent: &Extent,
    place: Place,
    quality: Quality,
    nodes: &mut Vec<BinaryNode>,
) {
    let at = nodes.len();
    nodes.push(BinaryNode::leaf(extent, place.first, items.len()));
    let Some(Parted { middle, sides }) = split(items, extent, place.depth, quality) else { return };
    let (left, right) = items.split_at_mut(middle);
    let below = place.below(middle);
    grow_alone(left, &sides[0], below[0], quality, nodes);
    nodes[at].right = (nodes.len() - at) as u32;
    grow_alone(right, &sides[1], below[1], quality, nodes);
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
