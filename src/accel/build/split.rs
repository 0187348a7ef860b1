//! Where a range of primitives parts in two, or that it stays one leaf.

use super::bins::{Cut, best_cut, part, quick_cut};
use super::item::{Extent, Item, longest_axis, partition};
use super::{BLOCK_BYTES, LEAF_SIZE, MAX_DEPTH, Quality, SOLITARY};

/// What a split must save to part a range that fits one leaf, in blocks. Above the 0.08 that are a node's cycles over a
/// block's, divided by the seven splits that a node holds: every leaf also takes a whole block of memory. 0.08 saves rays
/// through Sponza 0.7% of nodes and blocks for 7% more bytes; 0.4 costs them 1% and saves 5% of the bytes (through needles
/// in all directions 6%, for 37%).
const SPLIT_COST: f64 = 0.2;

/// Reorders the range and gives the place where it parts; `None` if it is best as a leaf.
///
/// `depth` is the number of splits above. Near [`MAX_DEPTH`] only halving is left, so no input can build deeper.
pub(super) fn split(items: &mut [Item], extent: &Extent, depth: u32, quality: Quality) -> Option<usize> {
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
    let quick = fits_leaf && BLOCK_BYTES[usize::from(items[0].kind())] > 0;
    let cut = if quick { quick_cut(items, extent) } else { best_cut(items, extent) };
    if fits_leaf && cut.is_none_or(|cut| !pays(&cut, extent)) {
        return None;
    }
    Some(part_by(items, extent, cut))
}

/// Parts the range at the cut; without one in halves.
pub(super) fn part_by(items: &mut [Item], extent: &Extent, cut: Option<Cut>) -> usize {
    match cut {
        Some(cut) => part(items, extent, &cut),
        None => halve(items, extent),
    }
}

/// Halvings that are enough to bring any range of this length to leaves of one primitive.
pub(super) fn halvings(len: usize) -> u32 {
    usize::BITS - len.leading_zeros()
}

/// True if two leaves cost less than the one that would hold both.
fn pays(cut: &Cut, extent: &Extent) -> bool {
    let one_leaf = extent.bounds.half_area();
    SPLIT_COST * one_leaf + cut.cost < one_leaf
}

/// Parts the range at the median of the centroids on their longest axis; on a tie by number, so that the result depends
/// on nothing else. The left side fills whole leaves.
fn halve(items: &mut [Item], extent: &Extent) -> usize {
    let axis = longest_axis(extent.centroids);
    let half = items.len() / 2;
    let middle = if items.len() > LEAF_SIZE { half.next_multiple_of(LEAF_SIZE) } else { half };
    let place = |item: &Item| item.centroid().to_array()[axis];
    items.select_nth_unstable_by(middle, |a, b| {
        place(a).total_cmp(&place(b)).then(a.number().cmp(&b.number()))
    });
    middle
}

/// Moves the least kind to the left.
fn split_off_kind(items: &mut [Item]) -> usize {
    let least = items.iter().map(Item::kind).min().unwrap_or_default();
    partition(items, &|item| item.kind() == least)
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
        let Some(middle) = split(items, &Extent::of(items), above, Quality::Balanced) else { return above };
        assert!(0 < middle && middle < items.len());
        let (left, right) = items.split_at_mut(middle);
        depth(left, above + 1).max(depth(right, above + 1))
    }

    #[test]
    fn near_the_greatest_depth_only_halving_is_left() {
        let mut items = outward(1);
        let start = MAX_DEPTH - halvings(items.len());
        assert_eq!(split(&mut items, &Extent::of(&outward(1)), start, Quality::Balanced), Some(56));
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
        let middle = halve(&mut items, &extent);
        let key = |item: &Item| (item.centroid().to_array()[0], item.number());
        let last = items[..middle].iter().map(key).max_by(|a, b| a.partial_cmp(b).unwrap());
        assert!(items[middle..].iter().all(|item| Some(key(item)) > last));
    }

    #[test]
    fn the_least_kind_is_split_off_first() {
        let mut items = outward(3)[..8].to_vec();
        let middle = split(&mut items, &Extent::of(&outward(3)[..8]), 0, Quality::Balanced).unwrap();
        assert_eq!(middle, 3);
        assert!(items[..middle].iter().all(|item| item.kind() == 1));
    }
}
