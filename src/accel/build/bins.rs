//! The best cut of a range among the borders of equal bins on each axis, by the surface area heuristic.
//!
//! **Source:** Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", 2007. Changed: all three axes are
//! binned in one pass, a side costs its number of leaf blocks instead of its number of primitives (a block of eight
//! costs the same when it is not full), and among equal costs the more even cut wins, so that flat scenes whose areas
//! are all zero still halve.

mod binning;
mod one_axis;
#[cfg(test)]
mod tests;

use wide::{f64x4, i32x4, u16x16, u32x4};

use super::box8::Box8;
use super::item::{Extent, Item, Parted, partition, reduce};
use super::{LEAF_SIZE, SOLITARY};
pub(super) use binning::Binning;
pub(super) use one_axis::Side;
use one_axis::{best_on, sides_on};

/// Bins on an axis; powers of two, so that an index is confined by a mask. Short ranges, which are most of them, spend
/// their time on the bins rather than on the items.
const MANY: usize = 16;
const FEW: usize = 8;
const FEW_ITEMS: usize = 48;

/// A cut between two bins of an axis.
#[derive(Clone, Copy)]
pub(super) struct Cut {
    axis: usize,
    /// The first bin on the right.
    bin: usize,
    /// Sum over both sides of half area times leaf blocks.
    pub(super) cost: f64,
    larger_side: u32,
}

impl Cut {
    fn better(self, o: Self) -> Self {
        let wins = o.cost < self.cost || o.cost == self.cost && o.larger_side < self.larger_side;
        if wins { o } else { self }
    }
}

/// The best cut of a range; `None` if no border has items on both sides, or if no cost is a number.
pub(super) fn best_cut(items: &[Item], extent: &Extent) -> Option<Cut> {
    if items.len() <= FEW_ITEMS {
        Bins::<FEW>::of(items, extent).best()
    } else {
        Bins::<MANY>::of(items, extent).best()
    }
}

/// [`best_cut`], and half the area of what the boxes of its sides share.
pub(super) fn best_cut_and_overlap(items: &[Item], extent: &Extent) -> (Option<Cut>, f64) {
    if items.len() <= FEW_ITEMS {
        Bins::<FEW>::of(items, extent).best_and_overlap()
    } else {
        Bins::<MANY>::of(items, extent).best_and_overlap()
    }
}

/// The best cut across the longest axis alone.
pub(super) fn quick_cut(items: &[Item], extent: &Extent) -> Option<Cut> {
    let axis = extent.centroids.longest_axis();
    if items.len() <= FEW_ITEMS {
        best_on(axis, &sides_on::<FEW>(axis, items, extent))
    } else {
        best_on(axis, &sides_on::<MANY>(axis, items, extent))
    }
}

/// Moves the items left of the cut before the others; neither side stays empty.
pub(super) fn part(items: &mut [Item], extent: &Extent, cut: &Cut) -> Parted {
    if items.len() <= FEW_ITEMS {
        part_at::<FEW>(items, extent, cut)
    } else {
        part_at::<MANY>(items, extent, cut)
    }
}

fn part_at<const BINS: usize>(items: &mut [Item], extent: &Extent, cut: &Cut) -> Parted {
    partition(items, &Binning::new::<BINS>(extent.centroids).before::<BINS>(cut.axis, cut.bin))
}

/// Boxes of what fell into each bin, by axis.
type Boxes<const BINS: usize> = [[Box8; BINS]; 3];

/// What fell into each bin: boxes and counts, by axis.
struct Bins<const BINS: usize> {
    bounds: Boxes<BINS>,
    count: [[u32; BINS]; 3],
}

impl<const BINS: usize> Bins<BINS> {
    fn of(items: &[Item], extent: &Extent) -> Self {
        let binning = Binning::new::<BINS>(extent.centroids);
        reduce(items, &|run| Self::of_run(run, &binning), &Self::join)
    }

    /// Neighbours often share a bin, and reading at once what was just written takes long: items take turns between two
    /// sets of bins.
    fn of_run(items: &[Item], binning: &Binning) -> Self {
        let mut sets = [[[Box8::EMPTY; BINS]; 3]; 2];
        let mut count = [[0; BINS]; 3];
        for counted in items.chunks(TALLIED) {
            let mut tally = [u16x16::ZERO; 3];
            let mut pairs = counted.chunks_exact(2);
            for pair in &mut pairs {
                put(&mut sets[0], &mut tally, &pair[0], binning);
                put(&mut sets[1], &mut tally, &pair[1], binning);
            }
            for item in pairs.remainder() {
                put(&mut sets[0], &mut tally, item, binning);
            }
            for (count, tally) in count.iter_mut().zip(tally) {
                for (count, more) in count.iter_mut().zip(tally.to_array()) {
                    *count += u32::from(more);
                }
            }
        }
        let [bounds, others] = sets;
        Self { bounds, count: [[0; BINS]; 3] }.join(Self { bounds: others, count })
    }

    fn join(mut self, o: Self) -> Self {
        for axis in 0..3 {
            for bin in 0..BINS {
                self.bounds[axis][bin] = self.bounds[axis][bin].join(o.bounds[axis][bin]);
                self.count[axis][bin] += o.count[axis][bin];
            }
        }
        self
    }

    #[inline(always)]
    fn bin(&self, bin: usize) -> ([Box8; 3], u32x4) {
        let [a, b, c] = [0, 1, 2].map(|axis| self.count[axis][bin]);
        ([0, 1, 2].map(|axis| self.bounds[axis][bin]), u32x4::new([a, b, c, 0]))
    }

    /// The best cut on any axis: all three are looked at side by side.
    fn best(&self) -> Option<Cut> {
        let rights = self.rights();
        let (mut left, mut count) = ([Box8::EMPTY; 3], u32x4::ZERO);
        let mut best = [f64x4::splat(f64::INFINITY), f64x4::splat(f64::MAX), f64x4::ZERO];
        for (bin, &(right_cost, right_count)) in rights.iter().enumerate().skip(1) {
            let (bounds, more) = self.bin(bin - 1);
            left = joined(left, bounds);
            count += more;
            // Without items on one side it is no number.
            let cost = costs(left, count) + right_cost;
            let larger = as_f64(count.max(right_count));
            let [least, least_larger, _] = best;
            let wins = cost.simd_lt(least) | cost.simd_eq(least) & larger.simd_lt(least_larger);
            let tried = [cost, larger, f64x4::splat(bin as f64)];
            best = std::array::from_fn(|i| wins.bitselect(tried[i], best[i]));
        }
        let [cost, larger, bin] = best.map(f64x4::to_array);
        let on = |axis: usize| Cut {
            axis,
            bin: bin[axis] as usize,
            cost: cost[axis],
            larger_side: larger[axis] as u32,
        };
        (0..3).map(on).filter(|cut| cut.bin != 0).reduce(Cut::better)
    }

    /// Cost and count of all bins from each one on.
    #[inline(always)]
    fn rights(&self) -> [(f64x4, u32x4); BINS] {
        let mut rights = [(f64x4::ZERO, u32x4::ZERO); BINS];
        let (mut right, mut count) = ([Box8::EMPTY; 3], u32x4::ZERO);
        for bin in (1..BINS).rev() {
            let (bounds, more) = self.bin(bin);
            right = joined(right, bounds);
            count += more;
            rights[bin] = (costs(right, count), count);
        }
        rights
    }

    fn best_and_overlap(&self) -> (Option<Cut>, f64) {
        let Some(cut) = self.best() else { return (None, 0.0) };
        let (left, right) = self.bounds[cut.axis].split_at(cut.bin);
        let of = |bins: &[Box8]| bins.iter().fold(Box8::EMPTY, |all, &bin| all.join(bin));
        let shared = of(left).intersection(of(right));
        (Some(cut), if shared.is_empty() { 0.0 } else { shared.half_area() })
    }
}

/// Items that sixteen bits can count, whatever they count for.
const TALLIED: usize = 1 << 12;

/// One in the lane of a bin, for items that count for one, and for those that count for a full leaf.
const ONE: [[u16x16; MANY]; 2] = {
    let mut one = [[u16x16::new([0; 16]); MANY]; 2];
    let mut bin = 0;
    while bin < MANY {
        let mut lanes = [0; 16];
        lanes[bin] = 1;
        one[0][bin] = u16x16::new(lanes);
        lanes[bin] = LEAF_SIZE as u16;
        one[1][bin] = u16x16::new(lanes);
        bin += 1;
    }
    one
};

/// Puts an item into its bins.
#[inline(always)]
fn put<const BINS: usize>(bounds: &mut Boxes<BINS>, tally: &mut [u16x16; 3], item: &Item, binning: &Binning) {
    let (bins, one) = (binning.bins::<BINS>(item), &ONE[usize::from(item.kind() == SOLITARY)]);
    for axis in 0..3 {
        let bin = bins[axis];
        bounds[axis][bin] = bounds[axis][bin].join(item.bounds);
        tally[axis] += one[bin];
    }
}

#[inline(always)]
fn joined([a, b, c]: [Box8; 3], [d, e, f]: [Box8; 3]) -> [Box8; 3] {
    [a.join(d), b.join(e), c.join(f)]
}

/// [`Side::cost`] on each axis.
#[inline(always)]
fn costs([x, y, z]: [Box8; 3], count: u32x4) -> f64x4 {
    Box8::half_areas([x, y, z, z]) * as_f64((count + u32x4::splat(LEAF_SIZE as u32 - 1)) >> 3)
}

#[inline(always)]
fn as_f64(count: u32x4) -> f64x4 {
    f64x4::from_i32x4(bytemuck::cast::<u32x4, i32x4>(count))
}

/// What an item counts for: one that has a leaf of its own as much as a full one.
#[inline(always)]
fn weight(item: &Item) -> u32 {
    if item.kind() == SOLITARY { LEAF_SIZE as u32 } else { 1 }
}
