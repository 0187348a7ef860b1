//! Which slot of a node each child takes, so that the order of visits needs no sorting.

use crate::math::{Aabb, WIDTH};

/// The child in each slot: rays of octant `o` (bit `k` set when `direction[k] < 0`) visit the slots `0 ^ o, 1 ^ o, ...`
/// roughly front to back. Slot 0 is the one at the corner of least coordinates.
///
/// Slot `s` stands for the direction with signs `s`; a child costs there how far its centre lies along that direction
/// from the centre of the node. The assignment of least total cost is found exactly.
///
/// **Needs:** at most eight children.
///
/// **Source:** Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", 2017,
/// section 3.2. Changed: dynamic programming over the 256 sets of taken slots instead of the auction algorithm.
pub(super) fn assign(children: &[Aabb]) -> [Option<usize>; WIDTH] {
    let costs = costs(children);
    let (total, choice) = solve(&costs[..children.len()]);
    let ends = (0..256).filter(|&set: &usize| set.count_ones() as usize == children.len());
    let mut set = ends.reduce(|a, b| if total[b] < total[a] { b } else { a }).unwrap_or(0);
    let mut slots = [None; WIDTH];
    for child in (0..children.len()).rev() {
        let slot = usize::from(choice[set]);
        slots[slot] = Some(child);
        set ^= 1 << slot;
    }
    slots
}

/// Least total cost of the first children in each set of slots, and the slot of the last of them.
fn solve(costs: &[[f64; WIDTH]]) -> ([f64; 256], [u8; 256]) {
    let (mut total, mut choice) = ([0.0; 256], [0; 256]);
    for set in 1..256_usize {
        let Some(cost) = costs.get(set.count_ones() as usize - 1) else { continue };
        let (mut best, mut rest) = (f64::INFINITY, set);
        while rest != 0 {
            let slot = rest.trailing_zeros() as usize & 7;
            let with = total[set & !(1 << slot)] + cost[slot];
            choice[set] = if with < best { slot as u8 } else { choice[set] };
            best = best.min(with);
            rest &= rest - 1;
        }
        total[set] = best;
    }
    (total, choice)
}

/// Cost of each child in each slot; zero for children that are not there.
fn costs(children: &[Aabb]) -> [[f64; WIDTH]; WIDTH] {
    let node = children.iter().fold(Aabb::EMPTY, |all, child| all.join(*child)).center();
    let mut costs = [[0.0; WIDTH]; WIDTH];
    for (row, child) in costs.iter_mut().zip(children) {
        let center = child.center();
        let offset: [f64; 3] = std::array::from_fn(|k| finite(f64::from(center[k]) - f64::from(node[k])));
        *row = std::array::from_fn(|slot| along(offset, slot));
    }
    costs
}

/// How far `offset` reaches along the direction whose signs are the bits of `octant`.
fn along(offset: [f64; 3], octant: usize) -> f64 {
    (0..3).map(|k| if octant >> k & 1 == 0 { offset[k] } else { -offset[k] }).sum()
}

/// Infinite boxes have no middle; any slot suits them.
fn finite(x: f64) -> f64 {
    if x.is_finite() { x } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point(p: [f32; 3]) -> Aabb {
        Aabb { min: p, max: p }
    }

    #[test]
    fn the_corners_of_a_cube_take_their_own_slots() {
        let cube = Aabb { min: [-1.0; 3], max: [1.0; 3] };
        let slots = assign(&cube.corners().map(point));
        assert_eq!(slots, std::array::from_fn(Some));
    }

    #[test]
    fn infinite_and_absent_children_keep_the_slots_distinct() {
        let all = Aabb { min: [f32::NEG_INFINITY; 3], max: [f32::INFINITY; 3] };
        for count in 0..=8 {
            let taken = assign(&vec![all; count]);
            assert_eq!(taken.iter().flatten().count(), count);
        }
    }

    proptest! {
        /// Where both ends of an octant are taken, the first is not behind the last: else swapping them would cost less.
        #[test]
        fn first_slot_lies_before_the_last(
            centers in prop::collection::vec(prop::array::uniform3(-100.0_f32..100.0), 1..=8),
        ) {
            let children: Vec<Aabb> = centers.iter().map(|&c| point(c)).collect();
            let slots = assign(&children);
            let mut seen: Vec<usize> = slots.iter().flatten().copied().collect();
            seen.sort_unstable();
            prop_assert!(seen.into_iter().eq(0..children.len()));
            for octant in 0..WIDTH {
                if let (Some(first), Some(last)) = (slots[octant], slots[octant ^ 7]) {
                    let at = |child: usize| along(centers[child].map(f64::from), octant);
                    prop_assert!(at(first) <= at(last) + 1e-3);
                }
            }
        }

        /// No exchange of two slots, taken or free, lowers the total.
        #[test]
        fn no_exchange_is_cheaper(
            centers in prop::collection::vec(prop::array::uniform3(-100.0_f32..100.0), 1..=8),
            a in 0..WIDTH, b in 0..WIDTH,
        ) {
            let children: Vec<Aabb> = centers.iter().map(|&c| point(c)).collect();
            let (slots, costs) = (assign(&children), costs(&children));
            let cost = |child: Option<usize>, slot: usize| child.map_or(0.0, |c| costs[c][slot]);
            let (kept, swapped) =
                (cost(slots[a], a) + cost(slots[b], b), cost(slots[a], b) + cost(slots[b], a));
            prop_assert!(kept <= swapped + 1e-9);
        }
    }
}
