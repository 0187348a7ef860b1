//! The best cut on one axis, looked at bin by bin.

use super::super::LEAF_SIZE;
use super::super::box8::Box8;
use super::super::item::{Extent, Item, reduce};
use super::{Binning, Cut, weight};

/// What fell into each bin of one axis.
pub(super) fn sides_on<const BINS: usize>(axis: usize, items: &[Item], extent: &Extent) -> [Side; BINS] {
    let bin = Binning::new::<BINS>(extent.centroids).on_axis::<BINS>(axis);
    let run = |run: &[Item]| {
        let mut sets = [[Side::EMPTY; BINS]; 2];
        for (i, item) in run.iter().enumerate() {
            sets[i & 1][bin(item)].add(Side::of(item));
        }
        join_sides(sets[0], sets[1])
    };
    reduce(items, &run, &join_sides)
}

fn join_sides<const BINS: usize>(mut a: [Side; BINS], b: [Side; BINS]) -> [Side; BINS] {
    for (side, other) in a.iter_mut().zip(b) {
        side.add(other);
    }
    a
}

pub(super) fn best_on<const BINS: usize>(axis: usize, sides: &[Side; BINS]) -> Option<Cut> {
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
pub(in super::super) struct Side {
    pub(in super::super) bounds: Box8,
    pub(in super::super) count: u32,
}

impl Side {
    pub(in super::super) const EMPTY: Self = Self { bounds: Box8::EMPTY, count: 0 };

    #[inline(always)]
    fn of(item: &Item) -> Self {
        Self { bounds: item.bounds, count: weight(item) }
    }

    #[inline(always)]
    pub(in super::super) fn add(&mut self, o: Self) {
        self.bounds = self.bounds.join(o.bounds);
        self.count += o.count;
    }

    #[inline(always)]
    pub(in super::super) fn cost(&self) -> f64 {
        self.bounds.half_area() * f64::from(self.count.div_ceil(LEAF_SIZE as u32))
    }
}
