//! The least price of memory at which a tree stays within its bytes.
//!
//! Where boxes of neighbours are small beside the box of all of them (needles in all directions, leaves of plants), the
//! surface area heuristic alone parts leaves down to a few primitives, and each takes a whole block. A price on bytes
//! undoes those splits that save rays the least for what they take: for the price that fits, no other choice among the
//! same binary nodes takes as little and costs rays less (Everett, "Generalized Lagrange Multiplier Method", 1963).

use rayon::prelude::*;

use super::NODE_BYTES;
use super::binary::BinaryNode;
use super::item::{GRAIN, Item};
use super::plan::{Children, Plan, plans};

/// Nodes and blocks may take this for each primitive. Rays a second through a ball of hair (192 thousand triangles, 121 bytes
/// without a bound) changed by -7 to +16% in three comparisons under load, more often up than down.
const MOST_BYTES: usize = 80;
/// A tree may take this in all: what stays in near caches is left to the speed of rays.
const SMALL: usize = 1 << 18;

/// The price is searched between powers of two of what a byte of the tree costs a ray on average: what lies far around a
/// scene raises the average by as much as it dwarfs the scene.
const POWERS: [f32; 2] = [-40.0, 8.0];
const STEPS: usize = 8;
/// A tree that takes this share of what it may is near enough.
const NEAR: f64 = 0.92;

/// The plans of all binary nodes over so many primitives, cut ones counted once.
pub(super) fn affordable_plans(nodes: &[BinaryNode], items: &[Item], primitives: usize) -> Vec<Plan> {
    let free = plans(nodes, items, 0.0);
    let most = (primitives * MOST_BYTES).max(SMALL);
    let bytes = bytes(nodes, &free, 0);
    if bytes <= most { free } else { search(nodes, items, free[0].least_cost() / bytes as f32, most) }
}

/// The plans at the least price, within a power of two, at which the tree takes no more than `most` bytes; where none is high
/// enough, those at the highest.
fn search(nodes: &[BinaryNode], items: &[Item], average: f32, most: usize) -> Vec<Plan> {
    let at = |power: f32| plans(nodes, items, average * power.exp2());
    let [mut low, mut high] = POWERS;
    let mut best = None;
    for _ in 0..STEPS {
        let middle = 0.5 * (low + high);
        let plans = at(middle);
        let bytes = bytes(nodes, &plans, 0);
        if bytes > most {
            low = middle;
            continue;
        }
        best = Some(plans);
        if bytes as f64 >= NEAR * most as f64 {
            break;
        }
        high = middle;
    }
    best.unwrap_or_else(|| at(high))
}

/// What the nodes and leaves of a subtree take.
fn bytes(nodes: &[BinaryNode], plans: &[Plan], root: usize) -> usize {
    if plans[root].is_leaf() {
        return plans[root].block_bytes();
    }
    let children = Children::of(nodes, plans, root);
    let below = |&child: &usize| bytes(nodes, plans, child);
    let shared = nodes[root].len as usize > GRAIN;
    let children = children.as_slice();
    NODE_BYTES
        + if shared {
            children.par_iter().map(below).sum::<usize>()
        } else {
            children.iter().map(below).sum()
        }
}
