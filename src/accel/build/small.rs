//! Where a range that fits a leaf parts: sorted by bins in a register, instead of gathered in bins.
//!
//! Most such ranges stay whole and none is like the one before, so there is hardly a branch to mispredict: loops run over
//! eight places, whatever is there.

use super::LEAF_SIZE;
use super::bins::Binning;
use super::box8::Box8;
use super::item::{Extent, Item, Parted};

/// Bins on the axis, a byte each in a word.
const BINS: usize = 8;
/// One in each byte.
const ONES: u64 = 0x0101_0101_0101_0101;

/// The items of a range in the order of their bins.
struct Sorted {
    /// Free places hold nothing.
    items: [Item; LEAF_SIZE],
    /// In each byte how many are in bins before.
    before: u64,
    len: usize,
}

/// Parts a range across the longest axis of its centroids if two leaves cost less than `most`: half the area of both.
///
/// **Needs:** one to eight items of a kind that shares leaves.
pub(super) fn part_small(items: &mut [Item], extent: &Extent, most: f64) -> Option<Parted> {
    let sorted = Sorted::of(items, extent);
    let costs = sorted.costs();
    let less = |i: usize| costs[i] < most;
    let worth = (0..LEAF_SIZE).fold(0, |worth, i| worth | u32::from(less(i)) << i) & sorted.borders();
    if worth == 0 {
        return None;
    }
    let middle = best(&costs, worth, items.len());
    items.copy_from_slice(&sorted.items[..items.len()]);
    Some(Parted::at(items, middle))
}

/// The place of least cost, of equals the one that parts more evenly, then the first.
fn best(costs: &[f64; LEAF_SIZE], places: u32, len: usize) -> usize {
    let larger = |i: usize| i.max(len - i);
    let places = (1..LEAF_SIZE).filter(|i| places >> i & 1 != 0);
    let order = |a: &usize, b: &usize| costs[*a].total_cmp(&costs[*b]).then(larger(*a).cmp(&larger(*b)));
    places.min_by(order).unwrap_or(1)
}

impl Sorted {
    fn of(items: &[Item], extent: &Extent) -> Self {
        let axis = extent.centroids.longest_axis();
        let bin = Binning::new::<BINS>(extent.centroids).on_axis::<BINS>(axis);
        let at = |i: usize| &items[i.min(items.len() - 1)];
        let shifts: [usize; LEAF_SIZE] = std::array::from_fn(|i| 8 * bin(at(i)));
        let count = |i: usize| u64::from(i < items.len()) << shifts[i];
        let counts: u64 = (0..LEAF_SIZE).map(count).sum();
        let before = counts.wrapping_mul(ONES) << 8;
        // What is not there goes to the end.
        let (mut sorted, mut next) = ([Item::NOTHING; LEAF_SIZE + 1], before);
        for i in 0..LEAF_SIZE {
            let place = (next >> shifts[i]) as usize % LEAF_SIZE;
            sorted[if i < items.len() { place } else { LEAF_SIZE }] = *at(i);
            next = next.wrapping_add(count(i));
        }
        let [a, b, c, d, e, f, g, h, _] = sorted;
        Self { items: [a, b, c, d, e, f, g, h], before, len: items.len() }
    }

    /// The places between two bins with items on both sides, as bits.
    fn borders(&self) -> u32 {
        let places = (1..BINS).fold(0, |places, bin| places | 1_u32 << (self.before >> (8 * bin) & 0xff));
        places & !(u32::MAX << self.len) & !1
    }

    /// Half the area of both sides of each place.
    fn costs(&self) -> [f64; LEAF_SIZE] {
        let (mut left, mut right) = ([Box8::EMPTY; LEAF_SIZE], [Box8::EMPTY; LEAF_SIZE]);
        for i in 0..LEAF_SIZE - 1 {
            left[i + 1] = left[i].join(self.items[i].bounds);
        }
        let mut all = Box8::EMPTY;
        for (right, item) in right.iter_mut().zip(&self.items).rev() {
            all = all.join(item.bounds);
            *right = all;
        }
        let [a, b, c, d, e, f, g, h] = left;
        let [i, j, k, l, m, n, o, p] = right;
        let low = Box8::half_areas([a, b, c, d]) + Box8::half_areas([i, j, k, l]);
        let high = Box8::half_areas([e, f, g, h]) + Box8::half_areas([m, n, o, p]);
        bytemuck::cast([low, high])
    }
}

#[cfg(test)]
mod tests {
    use super::super::bins::quick_cut;
    use super::super::tests::{cube, unit};
    use super::*;

    /// As [`part_small`], by bins.
    fn plain(items: &[Item], extent: &Extent, most: f64) -> Option<f64> {
        quick_cut(items, extent).map(|cut| cut.cost).filter(|&cost| cost < most)
    }

    #[test]
    fn it_parts_as_bins_do() {
        let mut parted = 0;
        for round in 0..4_000_u32 {
            let len = 1 + round as usize % LEAF_SIZE;
            let at = |i: usize| [0, 1, 2].map(|k| unit(31 * round + 3 * i as u32 + k));
            // As often as not on a grid, where boxes coincide.
            let at = |i: usize| at(i).map(|x| if round / 8 % 2 == 0 { x } else { (3.0 * x).floor() });
            let item = |i: usize| Item::new(i as u32, &cube(at(i), 0.1 * unit(7 * round + i as u32), 1));
            let mut items: Vec<Item> = (0..len).map(item).collect();
            let extent = Extent::of(&items);
            let most = 0.8 * extent.bounds.half_area();
            let expected = plain(&items, &extent, most);
            let found = part_small(&mut items, &extent, most);
            let cost = |parted: Parted| parted.sides.map(|side| side.bounds.half_area()).iter().sum::<f64>();
            assert_eq!(found.map(cost), expected, "{items:?}");
            let mut numbers: Vec<u32> = items.iter().map(Item::number).collect();
            numbers.sort_unstable();
            assert!(numbers.into_iter().eq(0..len as u32));
            parted += usize::from(found.is_some());
        }
        assert!((400..3_600).contains(&parted), "{parted}");
    }
}
