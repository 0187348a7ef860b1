//! Whether a tree holds what it should: the check that tests, fuzzing and `verify` share.
//!
//! It follows the references from the root and believes nothing that the builder said.

use super::build::{
    BLOCK_CYCLES, BuildPrimitive, KINDS, LEAF_SIZE, Leaf, MAX_DEPTH, NODE_CYCLES, Tree, half_area,
};
use super::node::ChildRef;
use crate::math::{Aabb, WIDTH};

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
    /// Primitives a leaf.
    pub mean_primitives: f64,
}

/// A slot of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Number of the node.
    pub node: u32,
    /// Slot from 0 to 7.
    pub slot: usize,
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "slot {} of node {}", self.slot, self.node)
    }
}

/// What is wrong with a tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TreeFault {
    /// There is no root.
    #[error("there is no root node")]
    NoRoot,
    /// The bounds of the tree are not the box of its primitives.
    #[error("the bounds of the tree are not those of its primitives")]
    Bounds,
    /// A reference leads outside the arrays.
    #[error("{0} refers to something that is not there")]
    OutOfRange(Place),
    /// A node or leaf is reached twice: a cycle, or two parents.
    #[error("{0} leads to what was reached before")]
    ReachedTwice(Place),
    /// A ray could hit a free slot.
    #[error("{0} is free, but its box is not the box of nothing")]
    FreeSlotHasBox(Place),
    /// A box does not hold a box below it, or sticks out of the one above.
    #[error("the box of {0} does not hold what is below, or sticks out of the box above")]
    Box(Place),
    /// A leaf has no or too many primitives, or they are of another kind, or not ascending.
    #[error("the leaf in {0} is malformed")]
    Leaf(Place),
    /// Nothing leads to some nodes or leaves.
    #[error("{0} nodes or leaves are not reached from the root")]
    Unreached(usize),
    /// A primitive is not in exactly one leaf.
    #[error("primitive {primitive} is in {leaves} leaves")]
    Held {
        /// Its number.
        primitive: usize,
        /// Leaves that hold it.
        leaves: u32,
    },
    /// The depth is not as reported, or above [`MAX_DEPTH`].
    #[error("the depth is {found}, reported as {reported}")]
    Depth {
        /// As counted.
        found: u32,
        /// As the tree says.
        reported: u32,
    },
}

/// Checks a tree against the primitives it was built from. **Needs:** references that were not offset.
///
/// **Errors:** the first [`TreeFault`] found.
pub fn validate(tree: &Tree, primitives: &[BuildPrimitive]) -> Result<TreeStats, TreeFault> {
    let all = primitives.iter().fold(Aabb::EMPTY, |all, primitive| all.join(primitive.bounds));
    ensure(all == tree.bounds, TreeFault::Bounds)?;
    ensure(!tree.nodes.is_empty(), TreeFault::NoRoot)?;
    let mut walk = Walk::new(tree, primitives);
    walk.run()?;
    walk.finish()
}

/// What was reached so far, and the sums of the statistics.
struct Walk<'a> {
    tree: &'a Tree,
    primitives: &'a [BuildPrimitive],
    node_reached: Vec<bool>,
    leaf_reached: Vec<bool>,
    /// Where the leaves of each kind start.
    kind_start: [Option<usize>; KINDS],
    times_held: Vec<u32>,
    depth: u32,
    children: usize,
    sah_cycles: f64,
    /// Nodes to visit: index, depth, and the box that the parent claims.
    stack: Vec<(u32, u32, Aabb)>,
}

impl<'a> Walk<'a> {
    fn new(tree: &'a Tree, primitives: &'a [BuildPrimitive]) -> Self {
        let start = |kind| tree.leaves.iter().position(|leaf| usize::from(leaf.kind) == kind);
        Self {
            tree,
            primitives,
            node_reached: (0..tree.nodes.len()).map(|node| node == 0).collect(),
            leaf_reached: vec![false; tree.leaves.len()],
            kind_start: std::array::from_fn(start),
            times_held: vec![0; primitives.len()],
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
            let inside = bounds.contains(&self.primitives[primitive as usize].bounds);
            ensure(inside, TreeFault::Box(place))?;
        }
        Ok(())
    }

    /// Where the leaf stands among all leaves, if it is one of its kind.
    fn leaf_at(&self, child: ChildRef) -> Option<usize> {
        let at = self.kind_start[usize::from(child.kind())]? + child.index() as usize;
        self.tree.leaves.get(at).filter(|leaf| leaf.kind == child.kind()).map(|_| at)
    }

    /// The primitives of a well-formed leaf: one to eight, in range, of its kind, ascending.
    fn held(&self, leaf: &Leaf) -> Option<&'a [u32]> {
        let first = leaf.first as usize;
        let held = self.tree.order.get(first..first + usize::from(leaf.len))?;
        let of_kind =
            |&number: &u32| self.primitives.get(number as usize).is_some_and(|p| p.kind == leaf.kind);
        let well_formed = (1..=LEAF_SIZE).contains(&held.len())
            && held.iter().all(of_kind)
            && held.is_sorted_by(|a, b| a < b);
        well_formed.then_some(held)
    }

    fn finish(self) -> Result<TreeStats, TreeFault> {
        let missed = |reached: &[bool]| reached.iter().filter(|&&reached| !reached).count();
        let count = missed(&self.node_reached) + missed(&self.leaf_reached);
        ensure(count == 0, TreeFault::Unreached(count))?;
        if let Some(primitive) = self.times_held.iter().position(|&times| times != 1) {
            return Err(TreeFault::Held { primitive, leaves: self.times_held[primitive] });
        }
        let (found, reported) = (self.depth, self.tree.max_depth);
        ensure(found == reported && found <= MAX_DEPTH, TreeFault::Depth { found, reported })?;
        Ok(self.stats())
    }

    fn stats(&self) -> TreeStats {
        let (nodes, leaves) = (self.tree.nodes.len(), self.tree.leaves.len());
        let ratio = |a: f64, b: f64| if b > 0.0 { a / b } else { 0.0 };
        TreeStats {
            nodes,
            leaves,
            sah_cost: ratio(self.sah_cycles, half_area(&self.tree.bounds)),
            mean_children: ratio(self.children as f64, nodes as f64),
            mean_primitives: ratio(self.primitives.len() as f64, leaves as f64),
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
mod tests {
    use super::super::build::build;
    use super::*;

    fn row(count: usize) -> Vec<BuildPrimitive> {
        let at = |i: usize| Aabb { min: [i as f32, 0.0, 0.0], max: [i as f32 + 0.5, 1.0, 1.0] };
        (0..count).map(|i| BuildPrimitive { bounds: at(i), kind: 1 + (i % 2) as u8 }).collect()
    }

    /// The fault that some damage to a sound tree of 200 primitives causes.
    fn fault(damage: impl Fn(&mut Tree)) -> TreeFault {
        let primitives = row(200);
        let mut tree = build(&primitives);
        validate(&tree, &primitives).unwrap();
        damage(&mut tree);
        validate(&tree, &primitives).unwrap_err()
    }

    fn first(tree: &Tree, wanted: fn(ChildRef) -> bool) -> (usize, usize) {
        let places = (0..tree.nodes.len()).flat_map(|node| (0..WIDTH).map(move |slot| (node, slot)));
        places.into_iter().find(|&(node, slot)| wanted(tree.nodes[node].child[slot])).unwrap()
    }

    fn redirect(tree: &mut Tree, wanted: fn(ChildRef) -> bool, to: ChildRef) {
        let (node, slot) = first(tree, wanted);
        tree.nodes[node].child[slot] = to;
    }

    #[test]
    fn references_that_lead_astray_are_found() {
        let astray = |to| fault(move |tree| redirect(tree, ChildRef::is_node, to));
        assert!(matches!(astray(ChildRef::node(0)), TreeFault::ReachedTwice(_)));
        assert!(matches!(astray(ChildRef::node(1 << 20)), TreeFault::OutOfRange(_)));
        assert!(matches!(astray(ChildRef::leaf(2, 1 << 20)), TreeFault::OutOfRange(_)));
        assert!(matches!(astray(ChildRef::leaf(5, 0)), TreeFault::OutOfRange(_)));
        assert!(matches!(astray(ChildRef::EMPTY), TreeFault::FreeSlotHasBox(_)));
    }

    #[test]
    fn wrong_boxes_leaves_and_totals_are_found() {
        let shrunk = |tree: &mut Tree| {
            let (node, slot) = first(tree, ChildRef::is_leaf);
            tree.nodes[node].hi[0][slot] -= 0.25;
        };
        assert!(matches!(fault(shrunk), TreeFault::Box(_)));
        assert!(matches!(fault(|tree| tree.leaves[0].len = 9), TreeFault::Leaf(_)));
        assert!(matches!(fault(|tree| tree.order.swap(0, 1)), TreeFault::Leaf(_)));
        assert!(matches!(fault(|tree| tree.leaves[0].len -= 1), TreeFault::Held { leaves: 0, .. }));
        assert!(matches!(fault(|tree| tree.max_depth += 1), TreeFault::Depth { .. }));
        assert!(matches!(fault(|tree| tree.nodes.push(tree.nodes[0])), TreeFault::Unreached(1)));
        assert_eq!(fault(|tree| tree.nodes.clear()), TreeFault::NoRoot);
        assert_eq!(fault(|tree| tree.bounds.max[0] += 1.0), TreeFault::Bounds);
    }
}
