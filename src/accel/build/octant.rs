//! Which slot of a node each child takes, so that the order of visits needs no sorting.

use wide::{f32x8, f64x4, u32x8};

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
    let total = solve(&costs, children.len());
    let ends = sets_of(children.len());
    let mut set = ends.reduce(|a, b| if total[b] < total[a] { b } else { a }).unwrap_or(0);
    let mut slots = [None; WIDTH];
    for child in (0..children.len()).rev() {
        let slot = last_slot(&total, set, costs.map(|costs| costs[child]));
        slots[slot] = Some(child);
        set ^= 1 << slot;
    }
    slots
}

/// Sets of slots.
const SETS: usize = 1 << WIDTH;
/// Sets that stand side by side in a vector: they differ in the first two slots alone.
const ACROSS: usize = 4;

/// What each child costs, for one slot; zero for children that are not there.
type Costs = [f64; WIDTH];

/// The sets of so many slots, ascending.
///
/// **Source:** Beeler, Gosper and Schroeppel, "HAKMEM", 1972, item 175.
fn sets_of(count: usize) -> impl Iterator<Item = usize> {
    let next = |&set: &usize| {
        let last = set & set.wrapping_neg();
        let carried = set + last;
        (set != 0).then(|| (carried ^ set) >> 2 >> last.trailing_zeros() | carried)
    };
    std::iter::successors(Some((1 << count) - 1), next).take_while(|&set| set < SETS)
}

/// Least total cost of the first children in each set of slots that is not larger than their number.
fn solve(costs: &[Costs; WIDTH], children: usize) -> [f64; SETS] {
    let mut rows = [f64x4::splat(f64::INFINITY); SETS / ACROSS];
    let (across, adding) = (across(costs), adding(costs));
    for set in 0..rows.len() {
        let taken = set.count_ones() as usize;
        if taken > children {
            continue;
        }
        let (mut least, mut rest) = (f64x4::splat(f64::INFINITY), set);
        if set == 0 {
            least = f64x4::new([0.0, f64::INFINITY, f64::INFINITY, f64::INFINITY]);
        }
        while rest != 0 {
            let slot = rest.trailing_zeros() as usize;
            least = least.fast_min(rows[set & !(1 << slot)] + adding[taken - 1][slot % WIDTH]);
            rest &= rest - 1;
        }
        let [one, first, second] = across[taken];
        least = least.fast_min(shuffle(least, [0; 4]) + one);
        let both = (shuffle(least, [2; 4]) + first).fast_min(shuffle(least, [1; 4]) + second);
        rows[set] = least.fast_min(both);
    }
    bytemuck::cast(rows)
}

#[inline(always)]
fn shuffle(row: f64x4, [a, b, c, d]: [u32; 4]) -> f64x4 {
    let halves = [2 * a, 2 * a + 1, 2 * b, 2 * b + 1, 2 * c, 2 * c + 1, 2 * d, 2 * d + 1];
    bytemuck::cast(bytemuck::cast::<f64x4, f32x8>(row).shuffle_wrapping(u32x8::new(halves)))
}

/// What it costs to put the next child into the first slot or the second where neither is taken, into the first where the second
/// is, and into the second where the first is; by the number of children in other slots.
#[inline(always)]
fn across([first, second, ..]: &[Costs; WIDTH]) -> [[f64x4; 3]; WIDTH - 1] {
    const NO: f64 = f64::INFINITY;
    std::array::from_fn(|child| {
        let one = [NO, first[child], second[child], NO];
        [one, [NO, NO, NO, first[child + 1]], [NO, NO, NO, second[child + 1]]].map(f64x4::new)
    })
}

/// What it costs to put the next child into each of the other slots, by the number of children that are in such: side by side
/// where none, either or both of the first two are taken too.
#[inline(always)]
fn adding([_, _, others @ ..]: &[Costs; WIDTH]) -> [[f64x4; WIDTH]; WIDTH - 2] {
    let mut adding = [[f64x4::ZERO; WIDTH]; WIDTH - 2];
    for (slot, costs) in others.iter().enumerate() {
        let [a, b, c, d, e, f, g, h] = *costs;
        let next = [[a, b, c, d], [b, c, d, e], [c, d, e, f], [d, e, f, g], [e, f, g, h], [f, g, h, h]];
        for (adding, next) in adding.iter_mut().zip(next) {
            adding[slot] = shuffle(f64x4::new(next), [0, 1, 1, 2]);
        }
    }
    adding
}

/// The slot of the last child in a set: the first of those that are as good.
#[inline(always)]
fn last_slot(total: &[f64; SETS], set: usize, cost: [f64; WIDTH]) -> usize {
    let is_last = |slot: usize| {
        let bit = 1 << slot;
        set & bit != 0 && total[set & !bit & (SETS - 1)] + cost[slot] == total[set]
    };
    let slots = (0..WIDTH).fold(0_u32, |slots, slot| slots | u32::from(is_last(slot)) << slot);
    slots.trailing_zeros() as usize % WIDTH
}

/// For each slot what each child costs there.
#[inline(always)]
fn costs(children: &[Aabb]) -> [Costs; WIDTH] {
    let node = children.iter().fold(Aabb::EMPTY, |all, child| all.join(*child)).center();
    let mut offsets = [[0.0; WIDTH]; 3];
    for (i, child) in children.iter().enumerate() {
        let center = child.center();
        for k in 0..3 {
            offsets[k][i % WIDTH] = finite(f64::from(center[k]) - f64::from(node[k]));
        }
    }
    let offsets = offsets.map(bytemuck::cast::<Costs, [f64x4; 2]>);
    std::array::from_fn(|slot| bytemuck::cast([0, 1].map(|half| along(offsets.map(|o| o[half]), slot))))
}

/// How far offsets reach along the direction whose signs are the bits of `octant`.
#[inline(always)]
fn along(offset: [f64x4; 3], octant: usize) -> f64x4 {
    let [x, y, z] = std::array::from_fn(|k| if octant >> k & 1 == 0 { offset[k] } else { -offset[k] });
    x + y + z
}

/// Infinite boxes have no middle; any slot suits them.
#[inline(always)]
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
                    let at = |child: usize| along(centers[child].map(|x| f64x4::splat(f64::from(x))), octant).to_array()[0];
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
            let cost = |child: Option<usize>, slot: usize| child.map_or(0.0, |c| costs[slot][c]);
            let (kept, swapped) =
                (cost(slots[a], a) + cost(slots[b], b), cost(slots[a], b) + cost(slots[b], a));
            prop_assert!(kept <= swapped + 1e-9);
        }
    }
}
