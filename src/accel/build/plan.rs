//! Which binary nodes become wide nodes, which become leaves, and which dissolve into the node above: the choice of
//! least expected cost.
//!
//! **Source:** Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", 2017,
//! section 3.1. Changed: a leaf costs one block however full it is, and holds one kind of primitive.

use super::binary::BinaryNode;
use super::item::GRAIN;
use super::numbers::Member;
use super::{BLOCK_BYTES, BLOCK_CYCLES, LEAF_SIZE, NODE_BYTES, NODE_CYCLES, SOLITARY, half_area};
use crate::math::WIDTH;

/// Most roots that a subtree contributes to the node above, whose other child has at least one.
const ROOTS: usize = WIDTH - 1;

/// No area counts for less than this share of the whole: where all boxes are flat, fewer nodes are still better.
const LEAST_AREA: f64 = 1e-9;

/// The best ways to stand for one binary subtree, by the number of roots it may contribute to a wide node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plan {
    /// Least cost with at most `i + 1` roots.
    cost: [f32; ROOTS],
    /// For `i + 1` roots: how many of them go to the left child; 0 if one root less is as good. For the single root:
    /// how many of its eight children come from the left; 0 if it is a leaf.
    left: [u8; ROOTS],
    /// The one kind of all primitives below if they fit a leaf, else 0.
    kind: u8,
}

impl Plan {
    const UNKNOWN: Self = Self { cost: [0.0; ROOTS], left: [0; ROOTS], kind: 0 };

    /// True if the subtree is one leaf.
    pub(super) fn is_leaf(&self) -> bool {
        self.left[0] == 0
    }

    /// The kind of a leaf.
    pub(super) fn kind(&self) -> u8 {
        self.kind
    }

    /// Bytes of the block of a leaf, where they count.
    pub(super) fn block_bytes(&self) -> usize {
        BLOCK_BYTES[usize::from(self.kind)]
    }

    /// Cycles that the subtree as one leaf or one node costs a ray that meets the whole tree, bytes at their price.
    pub(super) fn least_cost(&self) -> f32 {
        self.cost[0]
    }

    fn of_leaf(area: f32, price: f32, kind: u8) -> Self {
        Self { cost: [block_cost(area, price, kind); ROOTS], left: [0; ROOTS], kind }
    }

    fn of_inner(area: f32, price: f32, len: u32, [a, b]: [&Self; 2]) -> Self {
        let mut plan = Self::UNKNOWN;
        let (below, from_left) = share(a, b, WIDTH);
        let node = NODE_CYCLES as f32 * area + NODE_BYTES as f32 * price;
        (plan.cost[0], plan.left[0]) = (node + below, from_left);
        if a.kind == b.kind && a.kind != SOLITARY && len as usize <= LEAF_SIZE {
            plan.kind = a.kind;
        }
        let block = block_cost(area, price, plan.kind);
        if plan.kind != 0 && block <= plan.cost[0] {
            (plan.cost[0], plan.left[0]) = (block, 0);
        }
        for i in 1..ROOTS {
            let (cost, from_left) = share(a, b, i + 1);
            let better = cost < plan.cost[i - 1];
            (plan.cost[i], plan.left[i]) = if better { (cost, from_left) } else { (plan.cost[i - 1], 0) };
        }
        plan
    }

    /// Roots that each half contributes where the subtree may have so many; `None` if it has one.
    pub(super) fn shares(&self, mut roots: usize) -> Option<[usize; 2]> {
        while roots > 1 && self.left[roots - 1] == 0 {
            roots -= 1;
        }
        let left = usize::from(self.left[roots - 1]);
        (roots > 1).then(|| [left, roots - left])
    }

    /// Children that each half contributes to the wide node over the subtree; `None` if it is a leaf.
    pub(super) fn children(&self) -> Option<[usize; 2]> {
        let left = usize::from(self.left[0]);
        (left != 0).then_some([left, WIDTH - left])
    }
}

fn block_cost(area: f32, price: f32, kind: u8) -> f32 {
    BLOCK_CYCLES as f32 * area + BLOCK_BYTES[usize::from(kind)] as f32 * price
}

/// Least cost of two subtrees that share `roots` roots, and how many of them the first takes.
#[inline(always)]
fn share(a: &Plan, b: &Plan, roots: usize) -> (f32, u8) {
    let mut best = (f32::INFINITY, 1);
    for from_a in 1..roots {
        let cost = a.cost[from_a - 1] + b.cost[roots - from_a - 1];
        best = if cost < best.0 { (cost, from_a as u8) } else { best };
    }
    best
}

/// What plans are made of.
struct Solver<'a> {
    nodes: &'a [BinaryNode],
    members: &'a [Member],
    /// Half the area of the whole tree.
    whole: f64,
    price: f32,
}

/// Makes the plans of all binary nodes where a byte costs a ray as much as so many cycles.
pub(super) fn solve(nodes: &[BinaryNode], members: &[Member], price: f32, plans: &mut Vec<Plan>) {
    plans.resize(nodes.len(), Plan::UNKNOWN);
    if let Some(root) = nodes.first() {
        Solver { nodes, members, whole: half_area(&root.bounds), price }.solve(plans);
    }
}

impl Solver<'_> {
    /// Plans of one subtree, children before parents; the halves of large subtrees in parallel.
    fn solve(&self, plans: &mut [Plan]) {
        let right = self.nodes[0].right as usize;
        if self.nodes.len() <= GRAIN || right == 0 {
            return (0..self.nodes.len()).rev().for_each(|at| self.solve_node(plans, at));
        }
        let (left_plans, right_plans) = plans[1..].split_at_mut(right - 1);
        let of = |nodes| Solver { nodes, ..*self };
        rayon::join(
            || of(&self.nodes[1..right]).solve(left_plans),
            || of(&self.nodes[right..]).solve(right_plans),
        );
        self.solve_node(plans, 0);
    }

    fn solve_node(&self, plans: &mut [Plan], at: usize) {
        let node = &self.nodes[at];
        let area = (half_area(&node.bounds) / self.whole).max(LEAST_AREA) as f32;
        plans[at] = if node.right == 0 {
            Plan::of_leaf(area, self.price, self.members[node.first as usize].kind())
        } else {
            let below = [&plans[at + 1], &plans[at + node.right as usize]];
            Plan::of_inner(area, self.price, node.len, below)
        };
    }
}

/// The binary nodes that become the children of one wide node.
#[derive(Clone, Copy, Default)]
pub(super) struct Children {
    at: [usize; WIDTH],
    count: usize,
}

impl Children {
    /// The children of the wide node over a binary subtree that is no leaf.
    pub(super) fn of(nodes: &[BinaryNode], plans: &[Plan], root: usize) -> Self {
        let mut children = Self::default();
        if let Some(shares) = plans[root].children() {
            children.gather_below(nodes, plans, root, shares);
        }
        children
    }

    /// The one child of a root that stands over a lone leaf.
    pub(super) fn lone(root: usize) -> Self {
        Self { at: [root; WIDTH], count: 1 }
    }

    pub(super) fn as_slice(&self) -> &[usize] {
        &self.at[..self.count]
    }

    fn gather(&mut self, nodes: &[BinaryNode], plans: &[Plan], at: usize, roots: usize) {
        if let Some(shares) = plans[at].shares(roots) {
            return self.gather_below(nodes, plans, at, shares);
        }
        self.at[self.count] = at;
        self.count += 1;
    }

    fn gather_below(&mut self, nodes: &[BinaryNode], plans: &[Plan], at: usize, [left, right]: [usize; 2]) {
        self.gather(nodes, plans, at + 1, left);
        self.gather(nodes, plans, at + nodes[at].right as usize, right);
    }
}
