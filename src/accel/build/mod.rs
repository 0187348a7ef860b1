//! From boxes of primitives to the 8-wide tree; what the primitives are does not matter here.
//!
//! 1. `box8`, `item`: boxes and numbers in 32 bytes a primitive, which all later steps reorder in place.
//! 2. `bins`, `small`, `split`, `binary`: a binary tree by the binned surface area heuristic, leaves up to eight of a kind,
//!    instances one by one.
//!    `slab`, `spatial`, `cut`: for [`Quality::High`] also by planes that cut triangles, for [`Quality::Balanced`] the first
//!    time alone.
//! 3. `reinsert`: except for [`Quality::Fast`] subtrees move to better places.
//! 4. `plan`, `collapse`: binary nodes become wide nodes and leaves, at the least expected cost; `price`: within bounded
//!    memory.
//! 5. `octant`: children take the slots that make `slot ^ octant` the order of visits.
//!
//! The tree is a function of the input alone: how many threads built it leaves no trace.

mod binary;
mod bins;
mod box8;
mod collapse;
mod cut;
mod item;
mod numbers;
mod octant;
mod plan;
mod price;
mod reinsert;
mod slab;
mod small;
mod spatial;
mod split;
#[cfg(test)]
mod tests;

use rayon::prelude::*;

use super::node::{ChildRef, Node8};
use super::unchecked::reserve;
use crate::math::{Aabb, WIDTH};
use collapse::{Fragment, Source, collapse, moved};
pub use cut::{Cuttable, Uncut};
use item::{Extent, GRAIN, Item};

/// Most primitives in a leaf: what one block holds.
pub const LEAF_SIZE: usize = WIDTH;

/// The kind whose primitives each have a leaf, so that no two share a box: entering an instance costs as much as many
/// primitives.
pub const SOLITARY: u8 = 4;

/// No tree is deeper, whatever its input; a traversal stack of `7 * MAX_DEPTH + 1` entries is always enough.
pub const MAX_DEPTH: u32 = 64;

/// Cycles of a node visit and of a leaf block for a ray alone, as measured on one CPU: what the surface area heuristic
/// weighs. Twice as much for a block makes trees of more nodes that rays visit no less of.
pub const NODE_CYCLES: f64 = 18.0;
/// See [`NODE_CYCLES`].
pub const BLOCK_CYCLES: f64 = 32.0;

/// Values of the kind of a [`ChildRef`].
pub const KINDS: usize = 8;

/// Bytes of a node: with [`BLOCK_BYTES`] what a tree's memory is bounded by.
pub const NODE_BYTES: usize = size_of::<Node8>();
/// Bytes of a leaf block by kind, where they count: triangles alone. Fuller leaves of spheres and cylinders cost rays up to
/// 20%, for testing one of those takes longer than fetching it.
pub const BLOCK_BYTES: [usize; KINDS] = [0, 320, 0, 0, 0, 0, 0, 0];

/// How much work goes into a tree. It changes time and memory, never hits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Quality {
    /// Splits across the longest axis alone, leaves as full as they come.
    Fast,
    /// The surface area heuristic on all axes; triangles so large that halves of the whole would overlap are cut, and where
    /// boxes overlap subtrees then move to better places.
    #[default]
    Balanced,
    /// Cuts triangles wherever boxes overlap, for up to [`EXTRA_SHARE`] more references.
    High,
}

impl Quality {
    /// As written in scene files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fast => "fast",
            Self::Balanced => "balanced",
            Self::High => "high",
        }
    }
}

/// References that cutting may add, as a share of the primitives. Rays through Sponza visit 1% more nodes and
/// blocks with half of it, and 0.5% less with as much as cutting can use.
pub const EXTRA_SHARE: f64 = 0.5;

/// What the builder knows of a primitive; its number is its place in the input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BuildPrimitive {
    /// Box that holds every point where a ray may meet it. **Needs:** not empty, no NaN.
    pub bounds: Aabb,
    /// Kind from 1 to 6; a leaf holds one kind.
    pub kind: u8,
}

/// One to eight primitives of a kind: a stretch of [`Tree::order`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Leaf {
    /// Kind of all its primitives.
    pub kind: u8,
    /// Number of primitives.
    pub len: u8,
    /// Where they start in [`Tree::order`].
    pub first: u32,
}

/// An 8-wide tree.
#[derive(Clone, Debug, PartialEq)]
pub struct Tree {
    /// Depth-first: a node, then for each child node in the order of slots its subtree. The root is first, and is there
    /// even without primitives.
    pub nodes: Vec<Node8>,
    /// Grouped by kind, kinds ascending; within a kind depth-first, and the place in the group is the index that a
    /// [`ChildRef`] holds.
    pub leaves: Vec<Leaf>,
    /// Numbers of the primitives, leaf by leaf, ascending within a leaf; one that was cut is in several leaves.
    pub order: Vec<u32>,
    /// Nodes on the longest way from the root, both ends counted; at most [`MAX_DEPTH`].
    pub max_depth: u32,
    /// Box of everything; empty without primitives.
    pub bounds: Aabb,
}

impl Tree {
    /// The leaves of a kind, in the order of their numbers.
    pub fn leaves_of(&self, kind: u8) -> &[Leaf] {
        let start = self.leaves.partition_point(|leaf| leaf.kind < kind);
        let len = self.leaves[start..].partition_point(|leaf| leaf.kind == kind);
        &self.leaves[start..start + len]
    }

    /// The primitives of a leaf, ascending.
    pub fn primitives(&self, leaf: &Leaf) -> &[u32] {
        &self.order[leaf.first as usize..][..usize::from(leaf.len)]
    }

    /// Moves every reference: nodes by `by[0]`, leaves of kind `k` by `by[k]`, so that trees can share arrays.
    ///
    /// **Panics** if an index leaves its 29 bits.
    pub fn offset(&mut self, by: &[u32; KINDS]) {
        if *by == [0; KINDS] {
            return;
        }
        self.nodes.par_iter_mut().for_each(|node| *node = moved(*node, by));
    }
}

/// The tree over some primitives; `triangles` tells those that may be cut.
///
/// **Panics** if there are 2^29 primitives or more, or if a kind is not one of 1 to 6.
pub fn tree_over(
    primitives: impl IndexedParallelIterator<Item = BuildPrimitive>,
    quality: Quality,
    triangles: &impl Cuttable,
) -> Tree {
    let count = primitives.len();
    assert!(count < ChildRef::CAPACITY, "too many primitives for one tree");
    let mut items = items(primitives);
    let budget = (items.len() as f64 * EXTRA_SHARE) as usize;
    let budget = budget.min(ChildRef::CAPACITY - 1 - items.len());
    let mut nodes = Vec::new();
    if !items.is_empty() {
        (nodes, items) = match quality {
            Quality::Fast => {
                let extent = Extent::of(&items);
                (binary::grow(&mut items, &extent, quality), items)
            }
            Quality::Balanced => spatial::grow_balanced(items, budget, triangles),
            Quality::High => spatial::grow(items, budget, triangles),
        };
    }
    let mut members = numbers::members(&items);
    drop(items);
    if quality != Quality::Fast {
        (nodes, members) = reinsert::reinsert(nodes, members);
    }
    let Some(root) = nodes.first() else { return empty() };
    let bounds = root.bounds;
    let plans = price::affordable_plans(&nodes, &members, count);
    let source = Source { nodes: &nodes, plans: &plans, members: &members };
    let Fragment { nodes, leaves, depth } = collapse(source, 0);
    let mut leaves = leaves.concat();
    let order = numbers::order(members, &mut leaves);
    Tree { nodes, order, leaves, max_depth: depth, bounds }
}

/// [`tree_over`] a list.
#[cfg(test)]
pub fn build(primitives: &[BuildPrimitive], quality: Quality, triangles: &impl Cuttable) -> Tree {
    tree_over(primitives.par_iter().copied(), quality, triangles)
}

fn empty() -> Tree {
    Tree { nodes: vec![Node8::EMPTY], leaves: vec![], order: vec![], max_depth: 1, bounds: Aabb::EMPTY }
}

fn items(primitives: impl IndexedParallelIterator<Item = BuildPrimitive>) -> Vec<Item> {
    let item = |(number, primitive): (usize, BuildPrimitive)| {
        assert!((1..=ChildRef::LAST_KIND).contains(&primitive.kind), "kind {} is no kind", primitive.kind);
        Item::new(number as u32, &primitive)
    };
    let mut items = Vec::new();
    reserve(&mut items, primitives.len());
    items.par_extend(primitives.enumerate().with_min_len(GRAIN).map(item));
    items
}

/// Half the surface area; in `f64`, which holds that of any finite box.
pub(super) fn half_area(bounds: &Aabb) -> f64 {
    let [x, y, z] = bounds.size().map(f64::from);
    x * y + y * z + z * x
}
