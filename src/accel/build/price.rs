//! The least price of memory at which a tree stays within its bytes.
//!
//! Where boxes of neighbours are small beside the box of all of them (needles in all directions, leaves of plants), the
//! surface area heuristic alone parts leaves down to a few primitives, and each takes a whole block. A price on bytes
//! undoes those splits that save rays the least for what they take: for the price that fits, no other choice among the
//! same binary nodes takes as little and costs rays less (Everett, "Generalized Lagrange Multiplier Method", 1963).

use super::NODE_BYTES;
use super::binary::BinaryNode;
use super::item::GRAIN;
use super::numbers::Member;
use super::plan::{Plan, solve};

/// Nodes and blocks may take this for each primitive. Rays a second through a ball of hair (192 thousand triangles, 121 bytes
/// without a bound) changed by -7 to +16% in three comparisons under load, more often up than down.
const MOST_BYTES: usize = 80;
/// A tree may take this in all: what stays in near caches is left to the speed of rays.
const SMALL: usize = 1 << 18;

/// The price is searched between powers of two of what a byte of the tree costs a ray on average: what lies far around a
/// scene raises the average by as much as it dwarfs the scene.
const POWERS: [f32; 2] = [-40.0, 8.0];
/// Where the search begins: a ball of hair then takes 0.95 of what it may, hair on a table 0.86.
const OF_HAIR: f32 = -2.5;
/// Bytes between prices no farther apart are taken to fall in a straight line.
const STRAIGHT: f32 = 4.0;
const STEPS: u8 = 12;
/// A tree that takes this share of what it may is near enough.
const NEAR: f64 = 0.92;

/// The plans of all binary nodes over so many primitives, cut ones counted once.
pub(super) fn affordable_plans(nodes: &[BinaryNode], members: &[Member], primitives: usize) -> Vec<Plan> {
    let mut plans = Vec::new();
    solve(nodes, members, 0.0, &mut plans);
    let most = (primitives * MOST_BYTES).max(SMALL);
    let bytes = bytes(nodes, &plans, 0, 1);
    if bytes <= most { plans } else { search(nodes, members, plans, bytes, most) }
}

/// Plans at a price at which the tree takes no more than `most` bytes, and near as many; where no price is high enough, those
/// at the highest. Begins with the plans at no price, which are for so many bytes.
fn search(
    nodes: &[BinaryNode],
    members: &[Member],
    mut plans: Vec<Plan>,
    free_bytes: usize,
    most: usize,
) -> Vec<Plan> {
    let average = plans[0].least_cost() / free_bytes as f32;
    let mut bracket = Bracket { most: most as f64, over: None, under: None };
    // Prices take turns in the memory of two sets of plans, each of which is as large as the tree.
    let mut best = Vec::new();
    for round in 0..STEPS {
        let power = bracket.next(round);
        solve(nodes, members, average * power.exp2(), &mut plans);
        let bytes = bytes(nodes, &plans, 0, 1);
        if bytes <= most {
            std::mem::swap(&mut best, &mut plans);
        }
        if bracket.ends_with((power, bytes as f64)) {
            break;
        }
    }
    if bracket.under.is_some() { best } else { plans }
}

/// A power of two as a price, and the bytes of the tree that it makes.
type Tried = (f32, f64);

/// The highest price at which the tree was too large, and the lowest at which it was not.
struct Bracket {
    most: f64,
    over: Option<Tried>,
    under: Option<Tried>,
}

impl Bracket {
    /// What to try next: ever farther from where hair ends up until there are prices on both sides, then between them.
    fn next(&self, round: u8) -> f32 {
        let step = f32::from(round).exp2();
        match (self.over, self.under) {
            (None, None) => OF_HAIR,
            (Some((low, _)), None) => (low + step).min(POWERS[1]),
            (None, Some((high, _))) => (high - step).max(POWERS[0]),
            (Some((low, _)), Some((high, _))) if high - low > STRAIGHT => 0.5 * (low + high),
            (Some((low, more)), Some((high, less))) => {
                let share = (more - 0.5 * (1.0 + NEAR) * self.most) / (more - less);
                low + (high - low) * share.clamp(0.1, 0.9) as f32
            }
        }
    }

    /// Takes in what was tried; true if nothing better is worth a further try.
    fn ends_with(&mut self, (power, bytes): Tried) -> bool {
        let (place, end) =
            if bytes > self.most { (&mut self.over, POWERS[1]) } else { (&mut self.under, POWERS[0]) };
        *place = Some((power, bytes));
        power == end || (NEAR * self.most..=self.most).contains(&bytes)
    }
}

/// What the nodes and leaves of a subtree take that may contribute so many roots to the node above.
fn bytes(nodes: &[BinaryNode], plans: &[Plan], at: usize, roots: usize) -> usize {
    let plan = &plans[at];
    let (own, shares) = match (plan.shares(roots), plan.children()) {
        (Some(shares), _) => (0, shares),
        (None, Some(shares)) => (NODE_BYTES, shares),
        (None, None) => return plan.block_bytes(),
    };
    let below = [(at + 1, shares[0]), (at + nodes[at].right as usize, shares[1])];
    let [left, right] = below.map(|(at, roots)| move || bytes(nodes, plans, at, roots));
    let shared = nodes[at].len as usize > GRAIN;
    let (left, right) = if shared { rayon::join(left, right) } else { (left(), right()) };
    own + left + right
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wherever bytes fall and however fast, some price is found at which they are near what they may be.
    #[test]
    fn a_price_is_found_wherever_it_lies() {
        for place in -150..=24 {
            for width in [0.5, 1.0, 2.0] {
                let middle = f64::from(place) * 0.25;
                let bytes = |power: f32| 500.0 + 1000.0 / (1.0 + ((f64::from(power) - middle) / width).exp());
                let mut bracket = Bracket { most: 1000.0, over: None, under: None };
                let ends = (0..STEPS).any(|round| {
                    let power = bracket.next(round);
                    bracket.ends_with((power, bytes(power)))
                });
                let (_, found) = bracket.under.unwrap();
                assert!(ends && found >= 0.9 * 1000.0, "{middle} {width}: {found}");
            }
        }
    }

    #[test]
    fn without_such_a_price_the_highest_is_tried_last() {
        let mut bracket = Bracket { most: 1.0, over: None, under: None };
        assert!((0..STEPS).any(|round| bracket.ends_with((bracket.next(round), 2.0))));
        assert_eq!(bracket.over.map(|(power, _)| power), Some(POWERS[1]));
    }
}
