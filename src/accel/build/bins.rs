//! The best cut of a range among the borders of equal bins on each axis, by the surface area heuristic.
//!
//! **Source:** Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", 2007. Changed: all three axes are
//! binned in one pass, a side costs its number of leaf blocks instead of its number of primitives (a block of eight
//! costs the same when it is not full), and among equal costs the more even cut wins, so that flat scenes whose areas
//! are all zero still halve.

use wide::f32x4;

use super::item::{Box4, Extent, Item, longest_axis, partition, reduce};
use super::{LEAF_SIZE, SOLITARY};

/// Bins on an axis; powers of two, so that an index is confined by a mask. Short ranges, which are most of them, spend
/// their time on the bins rather than on the items.
const MANY: usize = 16;
const FEW: usize = 8;
const FEW_ITEMS: usize = 48;

/// From centroids to bins: an affine map by axis.
#[derive(Clone, Copy)]
pub(super) struct Binning {
    origin: f32x4,
    scale: f32x4,
}

impl Binning {
    fn new<const BINS: usize>(centroids: Box4) -> Self {
        let size = (centroids.hi - centroids.lo).to_array();
        let scale = |k: usize| if k < 3 && size[k] > 0.0 { BINS as f32 / size[k] } else { 0.0 };
        Self { origin: centroids.lo, scale: f32x4::new(std::array::from_fn(scale)) }
    }

    /// The bins of an item by axis. Overflow and NaN (from sizes near the ends of `f32`) end in some bin, which is
    /// always the same for the same item: all that partitioning needs.
    #[inline(always)]
    fn bins<const BINS: usize>(&self, item: &Item) -> [usize; 4] {
        let place = (item.centroid() - self.origin) * self.scale;
        let place = place.fast_max(f32x4::ZERO).fast_min(f32x4::splat((BINS - 1) as f32));
        place.fast_trunc_int().to_array().map(|bin| bin as usize & (BINS - 1))
    }
}

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
    let axis = longest_axis(extent.centroids);
    if items.len() <= FEW_ITEMS {
        best_on(axis, &sides_on::<FEW>(axis, items, extent))
    } else {
        best_on(axis, &sides_on::<MANY>(axis, items, extent))
    }
}

/// Moves the items left of the cut before the others, and gives their count: never 0, never all.
pub(super) fn part(items: &mut [Item], extent: &Extent, cut: &Cut) -> usize {
    if items.len() <= FEW_ITEMS {
        part_at::<FEW>(items, extent, cut)
    } else {
        part_at::<MANY>(items, extent, cut)
    }
}

fn part_at<const BINS: usize>(items: &mut [Item], extent: &Extent, cut: &Cut) -> usize {
    let (binning, axis, bin) = (Binning::new::<BINS>(extent.centroids), cut.axis, cut.bin);
    partition(items, &|item| binning.bins::<BINS>(item)[axis] < bin)
}

/// What fell into each bin: boxes and counts, by axis.
struct Bins<const BINS: usize> {
    sides: [[Side; BINS]; 3],
}

impl<const BINS: usize> Bins<BINS> {
    fn of(items: &[Item], extent: &Extent) -> Self {
        let binning = Binning::new::<BINS>(extent.centroids);
        reduce(items, &|run| Self::of_run(run, &binning), &Self::join)
    }

    fn of_run(items: &[Item], binning: &Binning) -> Self {
        let mut bins = Self { sides: [[Side::EMPTY; BINS]; 3] };
        for item in items {
            let side = Side::of(item);
            for (sides, bin) in bins.sides.iter_mut().zip(binning.bins::<BINS>(item)) {
                sides[bin].add(side);
            }
        }
        bins
    }

    fn join(self, o: Self) -> Self {
        let [a, b, c] = self.sides;
        let [d, e, f] = o.sides;
        Self { sides: [join_sides(a, d), join_sides(b, e), join_sides(c, f)] }
    }

    fn best(&self) -> Option<Cut> {
        (0..3).filter_map(|axis| best_on(axis, &self.sides[axis])).reduce(Cut::better)
    }

    fn best_and_overlap(&self) -> (Option<Cut>, f64) {
        let Some(cut) = self.best() else { return (None, 0.0) };
        let (left, right) = self.sides[cut.axis].split_at(cut.bin);
        let of = |sides: &[Side]| sides.iter().fold(Box4::EMPTY, |all, side| all.join(side.bounds));
        let shared = of(left).intersection(of(right));
        (Some(cut), if shared.is_empty() { 0.0 } else { shared.half_area() })
    }
}

/// What fell into each bin of one axis.
fn sides_on<const BINS: usize>(axis: usize, items: &[Item], extent: &Extent) -> [Side; BINS] {
    let binning = Binning::new::<BINS>(extent.centroids);
    let run = |run: &[Item]| {
        let mut sides = [Side::EMPTY; BINS];
        for item in run {
            sides[binning.bins::<BINS>(item)[axis]].add(Side::of(item));
        }
        sides
    };
    reduce(items, &run, &join_sides)
}

fn join_sides<const BINS: usize>(mut a: [Side; BINS], b: [Side; BINS]) -> [Side; BINS] {
    for (side, other) in a.iter_mut().zip(b) {
        side.add(other);
    }
    a
}

fn best_on<const BINS: usize>(axis: usize, sides: &[Side; BINS]) -> Option<Cut> {
    let rights = right_sides(sides);
    let mut left = Side::EMPTY;
    let mut best = Cut { axis, bin: 0, cost: f64::INFINITY, larger_side: u32::MAX };
    for bin in 1..BINS {
        // After an empty bin the cut is the one before it again.
        if sides[bin - 1].count == 0 {
            continue;
        }
        left.add(sides[bin - 1]);
        let (right_cost, right_count) = rights[bin];
        if right_count == 0 {
            break;
        }
        let cost = left.cost() + right_cost;
        best = best.better(Cut { axis, bin, cost, larger_side: left.count.max(right_count) });
    }
    (best.bin != 0).then_some(best)
}

/// Cost and count of all bins from each one on.
fn right_sides<const BINS: usize>(sides: &[Side; BINS]) -> [(f64, u32); BINS] {
    let mut rights = [(0.0, 0); BINS];
    let mut right = Side::EMPTY;
    let mut last = (0.0, 0);
    for bin in (1..BINS).rev() {
        if sides[bin].count != 0 {
            right.add(sides[bin]);
            last = (right.cost(), right.count);
        }
        rights[bin] = last;
    }
    rights
}

/// The box and number of some items: a bin, or all bins on one side of a cut.
#[derive(Clone, Copy)]
pub(super) struct Side {
    pub(super) bounds: Box4,
    pub(super) count: u32,
}

impl Side {
    pub(super) const EMPTY: Self = Self { bounds: Box4::EMPTY, count: 0 };

    /// One item; what has a leaf of its own counts for a full one.
    #[inline(always)]
    fn of(item: &Item) -> Self {
        Self { bounds: item.bounds, count: if item.kind() == SOLITARY { LEAF_SIZE as u32 } else { 1 } }
    }

    #[inline(always)]
    pub(super) fn add(&mut self, o: Self) {
        self.bounds = self.bounds.join(o.bounds);
        self.count += o.count;
    }

    #[inline(always)]
    pub(super) fn cost(&self) -> f64 {
        self.bounds.half_area() * f64::from(self.count.div_ceil(LEAF_SIZE as u32))
    }
}
