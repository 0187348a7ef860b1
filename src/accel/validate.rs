//! Whether a tree holds what it should: the check that tests, fuzzing and `verify` share.
//!
//! It follows the references from the root and believes nothing that the builder said.

mod fault;

use super::build::{
    BLOCK_CYCLES, BuildPrimitive, Cuttable, KINDS, LEAF_SIZE, Leaf, MAX_DEPTH, NODE_CYCLES, SOLITARY, Tree,
    Uncut, half_area,
};
use super::cover::covers;
use super::node::ChildRef;
use crate::math::{Aabb, WIDTH};
pub use fault::{Place, TreeFault};

/// What a tree looks like.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TreeStats {
    /// Nodes of eight.
    pub nodes: usize,
    /// Leaf blocks.
    pub leaves: usize,
    /// Expected cycles of a random ray through the box of the tree, by the surface area heuristic.
    pub sah_cost: f64,
    /// Taken slots a node.
    pub mean_children: f64,
    /// Primitives a leaf; those that were cut count in each of their leaves.
    pub mean_primitives: f64,
}

/// Checks a tree against the primitives it was built from. **Needs:** references that were not offset.
///
/// **Errors:** the first [`TreeFault`] found.
pub fn validate(tree: &Tree, primitives: &[BuildPrimitive]) -> Result<TreeStats, TreeFault> {
    validate_cut(tree, primitives, &Uncut)
}

/// [`validate`] for a tree that may have cut these triangles: the boxes of the leaves that hold one must cover it.
///
/// **Errors:** the first [`TreeFault`] found.
pub fn validate_cut(
    tree: &Tree,
    primitives: &[BuildPrimitive],
    triangles: &impl Cuttable,
) -> Result<TreeStats, TreeFault> {
    let all = primitives.iter().fold(Aabb::EMPTY, |all, primitive| all.join(primitive.bounds));
    ensure(all == tree.bounds, TreeFault::Bounds)?;
    ensure(!tree.nodes.is_empty(), TreeFault::NoRoot)?;
    let mut walk = Walk::new(tree, primitives, triangles);
    walk.run()?;
    walk.finish()
}

/// What was reached so far, and the sums of the statistics.
struct Walk<'a, C> {
    tree: &'a Tree,
    primitives: &'a [BuildPrimitive],
    triangles: &'a C,
    node_reached: Vec<bool>,
    leaf_reached: Vec<bool>,
    /// Where the leaves of each kind start.
    kind_start: [Option<usize>; KINDS],
    times_held: Vec<u32>,
    /// Primitives and boxes of leaves that hold a part of them.
    parts: Vec<(u32, Aabb)>,
    depth: u32,
    children: usize,
    sah_cycles: f64,
    /// Nodes to visit: index, depth, and the box that the parent claims.
    stack: Vec<(u32, u32, Aabb)>,
}

impl<'a, C: Cuttable> Walk<'a, C> {
    fn new(tree: &'a Tree, primitives: &'a [BuildPrimitive], triangles: &'a C) -> Self {
        let start = |kind| tree.leaves.iter().position(|leaf| usize::from(leaf.kind) == kind);
        Self {
            tree,
            primitives,
            triangles,
            node_reached: (0..tree.nodes.len()).map(|node| node == 0).collect(),
            leaf_reached: vec![false; tree.leaves.len()],
            kind_start: std::array::from_fn(start),
            times_held: vec![0; primitives.len()],
            parts: Vec::new(),
            depth: 0,
            children: 0,
            sah_cycles: 0.0,
            stack: vec![(0, 1, tree.bounds)],
        }
    }

    fn run(&mut self) -> Result<(), TreeFault> {
        while let Some((node, depth, claimed)) = self.stack.pop() {
            self.depth = self.depth.max(depth);
            self.sah_cycles += NODE_CYCLES * half_area(&claimed);
            for slot in 0..WIDTH {
                self.slot(Place { node, slot }, depth, &claimed)?;
            }
        }
        Ok(())
    }

    fn slot(&mut self, place: Place, depth: u32, claimed: &Aabb) -> Result<(), TreeFault> {
        let holder = &self.tree.nodes[place.node as usize];
        let (child, bounds) = (holder.child[place.slot], holder.bounds(place.slot));
        if child.is_empty() {
            return ensure(bounds == Aabb::EMPTY, TreeFault::FreeSlotHasBox(place));
        }
        self.children += 1;
        ensure(!bounds.is_empty() && claimed.contains(&bounds), TreeFault::Box(place))?;
        if child.is_node() { self.node(place, child, depth, bounds) } else { self.leaf(place, child, bounds) }
    }

    fn node(&mut self, place: Place, child: ChildRef, depth: u32, bounds: Aabb) -> Result<(), TreeFault> {
        reach(&mut self.node_reached, child.index() as usize, place)?;
        self.stack.push((child.index(), depth + 1, bounds));
        Ok(())
    }

    fn leaf(&mut self, place: Place, child: ChildRef, bounds: Aabb) -> Result<(), TreeFault> {
        let at = self.leaf_at(child).ok_or(TreeFault::OutOfRange(place))?;
        reach(&mut self.leaf_reached, at, place)?;
        self.sah_cycles += BLOCK_CYCLES * half_area(&bounds);
        for &primitive in self.held(&self.tree.leaves[at]).ok_or(TreeFault::Leaf(place))? {
            self.times_held[primitive as usize] += 1;
            let own = self.primitives[primitive as usize].bounds;
            if !bounds.contains(&own) {
                let part =
                    self.triangles.corners(primitive).is_some() && !bounds.intersection(own).is_empty();
                ensure(part, TreeFault::Box(place))?;
                self.parts.push((primitive, bounds));
            }
        }
        Ok(())
    }

    /// Where the leaf stands among all leaves, if it is one of its kind.
    fn leaf_at(&self, child: ChildRef) -> Option<usize> {
        let at = self.kind_start[usize::from(child.kind())]? + child.index() as usize;
        self.tree.leaves.get(at).filter(|leaf| leaf.kind == child.kind()).map(|_| at)
    }

    /// The primitives of a well-formed leaf: one to eight, in range, of its kind, ascending; one of the solitary kind.
    fn held(&self, leaf: &Leaf) -> Option<&'a [u32]> {
        let first = leaf.first as usize;
        let held = self.tree.order.get(first..first + usize::from(leaf.len))?;
        let of_kind =
            |&number: &u32| self.primitives.get(number as usize).is_some_and(|p| p.kind == leaf.kind);
        let most = if leaf.kind == SOLITARY { 1 } else { LEAF_SIZE };
        let well_formed =
            (1..=most).contains(&held.len()) && held.iter().all(of_kind) && held.is_sorted_by(|a, b| a < b);
        well_formed.then_some(held)
    }

    fn finish(mut self) -> Result<TreeStats, TreeFault> {
        let missed = |reached: &[bool]| reached.iter().filter(|&&reached| !reached).count();
        let count = missed(&self.node_reached) + missed(&self.leaf_reached);
        ensure(count == 0, TreeFault::Unreached(count))?;
        self.held_as_they_should()?;
        let (found, reported) = (self.depth, self.tree.max_depth);
        ensure(found == reported && found <= MAX_DEPTH, TreeFault::Depth { found, reported })?;
        Ok(self.stats())
    }

    /// Each primitive is in one leaf, or in several that cover it together.
    fn held_as_they_should(&mut self) -> Result<(), TreeFault> {
        for (primitive, &leaves) in self.times_held.iter().enumerate() {
            let often = leaves > 1 && self.triangles.corners(primitive as u32).is_none();
            ensure(leaves > 0 && !often, TreeFault::Held { primitive, leaves })?;
        }
        self.parts.sort_by_key(|part| part.0);
        for parts in self.parts.chunk_by(|a, b| a.0 == b.0) {
            let primitive = parts[0].0 as usize;
            let whole_elsewhere = self.times_held[primitive] as usize > parts.len();
            let boxes: Vec<Aabb> = parts.iter().map(|part| part.1).collect();
            let corners = self.triangles.corners(parts[0].0);
            let covered = whole_elsewhere || corners.is_some_and(|corners| covers(&boxes, corners));
            ensure(covered, TreeFault::Gap { primitive })?;
        }
        Ok(())
    }

    fn stats(&self) -> TreeStats {
        let (nodes, leaves) = (self.tree.nodes.len(), self.tree.leaves.len());
        let ratio = |a: f64, b: f64| if b > 0.0 { a / b } else { 0.0 };
        TreeStats {
            nodes,
            leaves,
            sah_cost: ratio(self.sah_cycles, half_area(&self.tree.bounds)),
            mean_children: ratio(self.children as f64, nodes as f64),
            mean_primitives: ratio(self.times_held.iter().sum::<u32>().into(), leaves as f64),
        }
    }
}

fn ensure(holds: bool, fault: TreeFault) -> Result<(), TreeFault> {
    if holds { Ok(()) } else { Err(fault) }
}

/// Marks a node or leaf as reached.
fn reach(reached: &mut [bool], at: usize, place: Place) -> Result<(), TreeFault> {
    let reached = reached.get_mut(at).ok_or(TreeFault::OutOfRange(place))?;
    ensure(!std::mem::replace(reached, true), TreeFault::ReachedTwice(place))
}

#[cfg(test)]
mod tests;
