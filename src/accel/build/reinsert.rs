//! Moves subtrees of the binary tree to where boxes grow the least.
//!
//! Splitting from the root down sees a few borders at a time, this sees the whole tree: a subtree is taken out, which saves
//! the box that held it and lets those above shrink, and put beside the node where boxes grow least.
//!
//! **Source:** Bittner, Hapala and Havran, "Fast Insertion-Based Optimization of Bounding Volume Hierarchies", 2013; Meister and
//! Bittner, "Parallel Reinsertion for Bounding Volume Hierarchy Optimization", 2018: all look for a place in a tree that stands
//! still. Changed: only the largest move; those that gain most go first, one after the other, so that threads leave no
//! trace; and what siblings share has a price.

mod linked;
mod standing;
#[cfg(test)]
mod tests;

use rayon::prelude::*;

use super::binary::BinaryNode;
use super::box8::Box8;
use linked::Linked;
use standing::Standing;

/// Shares of the nodes, largest first, that look for a better place: in the first round, which tells whether the tree is one
/// to gain, and in later ones. Rays through Sponza and a living room then visit 9 to 18% less (nodes and blocks by their
/// cycles, means of both) of trees that take 15 to 24% longer to build; with six times as many in later rounds 1% less, for much
/// longer builds.
const FIRST_SHARE: f64 = 0.01;
const SHARE: f64 = 0.05;
/// Nodes that look for a place at least.
const LEAST_NODES: usize = 100;
/// Most rounds.
const ROUNDS: usize = 6;
/// What the first round and the later ones must save, as a share of the area of all boxes. Halls save 7%; statues, hair and
/// terrain 0.1%, for which rays visit no less.
const FIRST_GAIN: f64 = 0.01;
const GAIN: f64 = 0.005;

/// What siblings share counts for so much of its area, for rays there visit both. Without this price rays through a living room
/// visit up to 15% more.
const OVERLAP: f64 = 0.5;

/// Most nodes that one search visits, whatever the boxes; usual ones visit fewer than 64.
const MOST_VISITS: usize = 512;

/// The tree after moves, and what its leaves hold in its new order; as they came where moving does not pay.
pub(super) fn reinsert<T: Copy>(nodes: Vec<BinaryNode>, items: Vec<T>) -> (Vec<BinaryNode>, Vec<T>) {
    match improved(&nodes).and_then(|tree| tree.laid_out(&nodes, &items)) {
        Some(moved) => moved,
        None => (nodes, items),
    }
}

/// The tree after moves; `None` if they do not pay.
fn improved(nodes: &[BinaryNode]) -> Option<Linked> {
    let of_all = |share: f64| (share * nodes.len() as f64) as usize + LEAST_NODES;
    // Most trees stay as they are, and are not turned into links to find out.
    if !may_pay(&Standing::of(nodes)?, of_all(FIRST_SHARE), FIRST_GAIN) {
        return None;
    }
    let mut tree = Linked::of(nodes)?;
    for round in 0..ROUNDS {
        let (share, gain) = if round == 0 { (FIRST_SHARE, FIRST_GAIN) } else { (SHARE, GAIN) };
        if !moving_pays(&mut tree, of_all(share), gain) {
            return (round > 0).then_some(tree);
        }
    }
    Some(tree)
}

/// A subtree to put beside a node.
#[derive(Clone, Copy)]
struct Move {
    from: u32,
    to: u32,
    gain: f64,
}

/// A tree to look at.
trait Links: Sync {
    /// Number of nodes; the root is node 0.
    fn len(&self) -> usize;
    fn bounds(&self, at: u32) -> Box8;
    /// `None` for a leaf.
    fn children(&self, at: u32) -> Option<[u32; 2]>;
    /// **Needs:** not the root.
    fn parent(&self, at: u32) -> u32;
    /// The other child of the parent. **Needs:** not the root.
    fn sibling(&self, at: u32) -> u32;
}

/// True if moving the largest so many nodes might gain more than this share of the area of all boxes: if no move stood in the
/// way of another.
fn may_pay(tree: &impl Links, count: usize, share: f64) -> bool {
    let (largest, area) = largest(tree, count);
    let gained: f64 = moves(tree, &largest).iter().map(|best| best.gain).sum();
    gained > share * area
}

/// The best moves of some nodes, those that gain most first.
fn moves(tree: &impl Links, nodes: &[u32]) -> Vec<Move> {
    let search = |stack: &mut Vec<_>, &at: &u32| Search::new(tree, at).best(stack);
    let mut moves: Vec<Move> = nodes.par_iter().map_init(Vec::new, search).flatten().collect();
    moves.sort_unstable_by(|a, b| b.gain.total_cmp(&a.gain).then(a.from.cmp(&b.from)));
    moves
}

/// Moves those of so many nodes, the largest, that gain by it. True if all gain more than this share of the area of all boxes;
/// where boxes are infinite nothing does.
fn moving_pays(tree: &mut Linked, count: usize, share: f64) -> bool {
    let (largest, area) = largest(tree, count);
    let moves = moves(tree, &largest);
    let (mut touched, mut gained) = (vec![false; tree.len()], 0.0);
    for Move { from, to, gain } in moves {
        // What was gained by a place near another move is not known any more.
        let touches = tree.linked_by_moving(from, to).map(|at| at as usize);
        if !touches.iter().any(|&at| touched[at]) && !tree.is_below(to, from) {
            touches.iter().for_each(|&at| touched[at] = true);
            tree.move_beside(from, to);
            gained += gain;
        }
    }
    gained > share * area
}

/// The nodes below the root with the largest boxes, of equals the first; and the area of all.
fn largest(tree: &impl Links, count: usize) -> (Vec<u32>, f64) {
    let area = |at: u32| (tree.bounds(at).half_area() as f32, at);
    let mut nodes: Vec<(f32, u32)> = (1..tree.len() as u32).into_par_iter().map(area).collect();
    let all = nodes.iter().map(|&(area, _)| f64::from(area)).sum();
    if count < nodes.len() {
        nodes.select_nth_unstable_by(count, |a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        nodes.truncate(count);
    }
    (nodes.into_iter().map(|(_, at)| at).collect(), all)
}

fn price_of_overlap(a: Box8, b: Box8) -> f64 {
    let shared = a.intersection(b);
    if shared.is_empty() { 0.0 } else { OVERLAP * shared.half_area() }
}

/// The search for the best place of a subtree: beside each node on the way up, and below.
struct Search<'a, T> {
    tree: &'a T,
    moved: Box8,
    area: f64,
    best: Move,
    /// Its sibling, beside which it is.
    beside: u32,
    visits: usize,
}

impl<'a, T: Links> Search<'a, T> {
    fn new(tree: &'a T, from: u32) -> Self {
        let moved = tree.bounds(from);
        Self {
            tree,
            moved,
            area: moved.half_area(),
            best: Move { from, to: 0, gain: 0.0 },
            beside: tree.sibling(from),
            visits: 0,
        }
    }

    /// The place that gains most; `None` if none gains.
    fn best(mut self, stack: &mut Vec<(u32, f64)>) -> Option<Move> {
        let (tree, from) = (self.tree, self.best.from);
        let (mut at, mut other) = (tree.parent(from), tree.sibling(from));
        // What is left in the box of `at`, and the area saved up to there.
        let mut rest = tree.bounds(other);
        let mut saved = tree.bounds(at).half_area() + price_of_overlap(rest, self.moved);
        self.below(other, saved, stack);
        while at != 0 {
            (other, at) = (tree.sibling(at), tree.parent(at));
            self.below(other, saved, stack);
            rest = rest.join(tree.bounds(other));
            saved += tree.bounds(at).half_area() - rest.half_area();
        }
        (self.best.to != 0).then_some(self.best)
    }

    /// Tries places beside a node and all below it, where so much area is saved before the subtree is put there.
    fn below(&mut self, at: u32, saved: f64, stack: &mut Vec<(u32, f64)>) {
        stack.clear();
        stack.push((at, saved));
        while let Some((at, saved)) = stack.pop() {
            if !self.may_gain(saved) {
                continue;
            }
            self.visits += 1;
            let bounds = self.tree.bounds(at);
            let left = saved - bounds.join(self.moved).half_area();
            if left > self.best.gain && at != self.beside {
                let gain = left - price_of_overlap(bounds, self.moved);
                self.best =
                    if gain > self.best.gain { Move { to: at, gain, ..self.best } } else { self.best };
            }
            let saved = left + bounds.half_area();
            if let Some(children) = self.tree.children(at).filter(|_| self.may_gain(saved)) {
                stack.extend(children.map(|child| (child, saved)));
            }
        }
    }

    /// False where no place is better: a box around the subtree and more is no smaller than its own.
    fn may_gain(&self, saved: f64) -> bool {
        saved - self.area > self.best.gain && self.visits < MOST_VISITS
    }
}
