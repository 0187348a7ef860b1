//! Where a range of primitives parts in two, or that it stays one leaf.

use super::bins::{Cut, best_cut, part, quick_cut};
use super::item::{Extent, Item, Parted};
use super::small::part_small;
use super::{BLOCK_BYTES, LEAF_SIZE, MAX_DEPTH, Quality, SOLITARY};

/// What a split must save to part a range that fits one leaf, in blocks. Above the 0.08 that are a node's cycles over a
/// block's, divided by the seven splits that a node holds: every leaf also takes a whole block of memory. 0.08 saves rays
/// through Sponza 0.7% of nodes and blocks for 7% more bytes; 0.4 costs them 1% and saves 5% of the bytes (through needles
/// in all directions 6%, for 37%).
const SPLIT_COST: f64 = 0.2;

/// Reorders the range and gives the place where it parts; `None` if it is best as a leaf.
///
/// `depth` is the number of splits above. Near [`MAX_DEPTH`] only halving is left, so no input can build deeper.
pub(super) fn split(items: &mut [Item], extent: &Extent, depth: u32, quality: Quality) -> Option<Parted> {
    let few = items.len() <= LEAF_SIZE;
    let one_kind = few && items.iter().all(|item| item.kind() == items[0].kind());
    let fits_leaf = one_kind && (items.len() == 1 || items[0].kind() != SOLITARY);
    if depth + halvings(items.len()) >= MAX_DEPTH {
        return (!fits_leaf).then(|| halve(items, extent));
    }
    if few && !one_kind {
        return Some(split_off_kind(items));
    }
    if quality == Quality::Fast {
        return (!fits_leaf).then(|| part_by(items, extent, quick_cut(items, extent)));
    }
    // Most ranges fit a leaf. Of trees in which triangles part there across the longest axis alone rays visit no more nodes
    // and, through hair, 2% more blocks; through spheres it would be 5 to 10% more blocks.
    if fits_leaf && BLOCK_BYTES[usize::from(items[0].kind())] > 0 {
        return part_small(items, extent, leaves_may_cost(extent));
    }
    let cut = best_cut(items, extent);
    if fits_leaf && cut.is_none_or(|cut| cut.cost >= leaves_may_cost(extent)) {
        return None;
    }
    Some(part_by(items, extent, cut))
}

/// Parts the range at the cut; without one in halves.
pub(super) fn part_by(items: &mut [Item], extent: &Extent, cut: Option<Cut>) -> Parted {
    match cut {
        Some(cut) => part(items, extent, &cut),
        None => halve(items, extent),
    }
}

/// Halvings that are enough to bring any range of this length to leaves of one primitive.
pub(super) fn halvings(len: usize) -> u32 {
    usize::BITS - len.leading_zeros()
}

/// What two leaves cost less than if they pay instead of the one that would hold both.
fn leaves_may_cost(extent: &Extent) -> f64 {
    (1.0 - SPLIT_COST) * extent.bounds.half_area()
}

/// Parts the range at the median of the centroids on their longest axis; on a tie by number, so that the result depends
/// on nothing else. The left side fills whole leaves.
fn halve(items: &mut [Item], extent: &Extent) -> Parted {
    let axis = extent.centroids.longest_axis();
    let half = items.len() / 2;
    let middle = if items.len() > LEAF_SIZE { half.next_multiple_of(LEAF_SIZE) } else { half };
    items.select_nth_unstable_by(middle, |a, b| {
        a.place(axis).total_cmp(&b.place(axis)).then(a.number().cmp(&b.number()))
    });
    Parted::at(items, middle)
}

/// Moves the least kind to the left.
fn split_off_kind(items: &mut [Item]) -> Parted {
    items.sort_unstable_by_key(|item| (item.kind(), item.number()));
    let middle = items.partition_point(|item| item.kind() == items[0].kind());
    Parted::at(items, middle)
}

#[cfg(test)]
mod tests {
    use super::super::BuildPrimitive;
    use super::*;
    use crate::math::Aabb;

    /// A hundred points, each ten times as far out as the one before: any cut by area takes a few from the far end.
    fn outward(kinds: usize) -> Vec<Item> {
        let primitive = |i: usize| {
            let at = [10_f32.powi(i as i32 % 30); 3];
            BuildPrimitive { bounds: Aabb { min: at, max: at }, kind: 1 + (i % kinds) as u8 }
        };
        (0..100).map(|i| Item::new(i as u32, &primitive(i))).collect()
    }

    /// Splits above the deepest leaf.
    fn depth(items: &mut [Item], above: u32) -> u32 {
        let parted = split(items, &Extent::of(items), above, Quality::Balanced);
        let Some(Parted { middle, .. }) = parted else { return above };
        assert!(0 < middle && middle < items.len());
        let (left, right) = items.split_at_mut(middle);
        depth(left, above + 1).max(depth(right, above + 1))
    }

    #[test]
    fn near_the_greatest_depth_only_halving_is_left() {
        let mut items = outward(1);
        let start = MAX_DEPTH - halvings(items.len());
        let parted = split(&mut items, &Extent::of(&outward(1)), start, Quality::Balanced);
        assert_eq!(parted.map(|parted| parted.middle), Some(56));
        for kinds in 1..=6 {
            for start in 0..=start {
                assert!(depth(&mut outward(kinds), start) <= MAX_DEPTH);
            }
        }
    }

    #[test]
    fn halves_are_ordered_and_ties_go_by_number() {
        let mut items = outward(1);
        let extent = Extent::of(&items);
        let Parted { middle, .. } = halve(&mut items, &extent);
        let key = |item: &Item| (item.centroid().to_array()[0], item.number());
        let last = items[..middle].iter().map(key).max_by(|a, b| a.partial_cmp(b).unwrap());
        assert!(items[middle..].iter().all(|item| Some(key(item)) > last));
    }

    #[test]
    fn the_least_kind_is_split_off_first() {
        let mut items = outward(3)[..8].to_vec();
        let parted = split(&mut items, &Extent::of(&outward(3)[..8]), 0, Quality::Balanced);
        let Parted { middle, .. } = parted.unwrap();
        assert_eq!(middle, 3);
        assert!(items[..middle].iter().all(|item| item.kind() == 1));
    }
}
