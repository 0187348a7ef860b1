//! The best plane across an axis that parts space itself: what crosses it is cut and counts on both sides.
//!
//! **Source:** Stich, Friedrich and Dietrich, "Spatial Splits in Bounding Volume Hierarchies", 2009, sections 4.2 to 4.4.
//! Changed: a side costs its leaf blocks, as in [`super::bins`]; what is no triangle is not cut and goes where its
//! centre is.

mod grid;

use super::bins::Side;
use super::box8::Box8;
use super::cut::{Cuttable, Sweep};
use super::item::{Extent, Item, reduce};
use grid::{Grid, Spread};

/// Most bins on an axis, and bins for ranges in which nearly every triangle would reach across several of so many.
const MANY: usize = 16;
const FEW: usize = 8;
const FEW_ITEMS: usize = 512;

/// A plane between two bins of an axis.
#[derive(Clone, Copy)]
pub(super) struct Slab {
    axis: usize,
    at: f32,
    /// As [`super::bins::Cut::cost`].
    pub(super) cost: f64,
    low: Side,
    high: Side,
}

/// What is in a bin, and how many begin and end there.
#[derive(Clone, Copy)]
struct Bin {
    bounds: Box8,
    enter: u32,
    exit: u32,
}

type Bins = [[Bin; MANY]; 3];

/// How planes cut what is put into bins.
#[derive(Clone, Copy)]
pub(super) enum Parts {
    /// Boxes of the parts of triangles.
    Triangles,
    /// Parts of the boxes of triangles, which are found faster and no smaller. For the first cut of all, with many more items on
    /// either side than are cut, they choose the same plane.
    Boxes,
}

/// The best plane through a range; `None` if none has items on both sides.
pub(super) fn best_slab(
    items: &[Item],
    extent: &Extent,
    parts: Parts,
    triangles: &impl Cuttable,
) -> Option<Slab> {
    let count = if items.len() < FEW_ITEMS { FEW } else { MANY };
    let grids = [0, 1, 2].map(|axis| Grid::new(&extent.bounds, axis, count));
    let bins = match parts {
        Parts::Triangles => filled(items, |bins, item| put(bins, &grids, item, triangles)),
        Parts::Boxes => {
            let layers = Layers::new(&grids, count);
            filled(items, |bins, item| layers.put(bins, &grids, item, triangles))
        }
    };
    let best = grids.iter().zip(&bins).filter_map(|(grid, bins)| best_on(grid.as_ref()?, bins));
    best.reduce(|a, b| if b.cost < a.cost { b } else { a })
}

/// Bins with all items, which take turns between two sets of them as in [`super::bins`].
fn filled(items: &[Item], put: impl Fn(&mut Bins, &Item) + Sync) -> Bins {
    let run = |run: &[Item]| {
        let mut sets = [[[Bin { bounds: Box8::EMPTY, enter: 0, exit: 0 }; MANY]; 3]; 2];
        for (i, item) in run.iter().enumerate() {
            put(&mut sets[i & 1], item);
        }
        join(sets[0], sets[1])
    };
    reduce(items, &run, &join)
}

fn join(mut a: Bins, b: Bins) -> Bins {
    for (to, from) in a.iter_mut().flatten().zip(b.iter().flatten()) {
        to.bounds = to.bounds.join(from.bounds);
        to.enter += from.enter;
        to.exit += from.exit;
    }
    a
}

/// Puts an item into the bins of each axis, cut by the planes between them.
fn put(bins: &mut Bins, grids: &[Option<Grid>; 3], item: &Item, triangles: &impl Cuttable) {
    for (grid, bins) in grids.iter().zip(bins) {
        let Some(grid) = grid else { continue };
        let [lo, hi] = item.bounds.along(grid.axis);
        let (first, last) = (grid.bin(lo), grid.bin(hi));
        if first == last {
            put_whole(&mut bins[first], item);
        } else if let Some(corners) = triangles.corners(item.number()) {
            put_parts(&mut bins[first..=last], &Sweep::new(corners, grid.axis), item, |i| {
                if i == 0 { lo } else { grid.plane(first + i).min(hi) }
            });
        } else {
            put_whole(&mut bins[grid.bin(0.5 * lo + 0.5 * hi)], item);
        }
    }
}

/// What the bins of each axis hold, and how to find them.
struct Layers {
    spread: Spread,
    layers: [[Box8; MANY]; 3],
}

impl Layers {
    fn new(grids: &[Option<Grid>; 3], bins: usize) -> Self {
        let layers =
            grids.map(|grid| std::array::from_fn(|bin| grid.map_or(Box8::EMPTY, |grid| grid.layer(bin))));
        Self { spread: Spread::new(grids, bins), layers }
    }

    /// Puts the parts of the box of an item into the bins of each axis.
    #[inline(always)]
    fn put(&self, bins: &mut Bins, grids: &[Option<Grid>; 3], item: &Item, triangles: &impl Cuttable) {
        let [first, last] = self.spread.ends(item);
        if !triangles.is_cuttable(item.number()) {
            return put(bins, grids, item, triangles);
        }
        for ((axis, bins), layers) in bins.iter_mut().enumerate().zip(&self.layers) {
            let (first, last) = (first[axis], last[axis]);
            for (bin, &layer) in bins[first..=last].iter_mut().zip(&layers[first..=last]) {
                bin.bounds = bin.bounds.join(item.bounds.intersection(layer));
            }
            bins[first].enter += 1;
            bins[last].exit += 1;
        }
    }
}

#[inline(always)]
fn put_whole(bin: &mut Bin, item: &Item) {
    bin.bounds = bin.bounds.join(item.bounds);
    bin.enter += 1;
    bin.exit += 1;
}

/// Puts the part of a triangle between planes `i` and `i + 1` into bin `i`.
fn put_parts(bins: &mut [Bin], sweep: &Sweep, item: &Item, plane: impl Fn(usize) -> f32) {
    let mut start = (plane(0), sweep.section(plane(0)));
    for (i, bin) in bins.iter_mut().enumerate() {
        let end = (plane(i + 1), sweep.section(plane(i + 1)));
        let part = sweep.between([start.0, end.0], [start.1, end.1]);
        bin.bounds = bin.bounds.join_part(part.intersection(item.bounds));
        start = end;
    }
    bins[0].enter += 1;
    bins[bins.len() - 1].exit += 1;
}

fn best_on(grid: &Grid, bins: &[Bin; MANY]) -> Option<Slab> {
    let mut highs = [Side::EMPTY; MANY];
    let mut high = Side::EMPTY;
    for bin in (1..grid.bins).rev() {
        high.add(Side { bounds: bins[bin].bounds, count: bins[bin].exit });
        highs[bin] = high;
    }
    let mut low = Side::EMPTY;
    let mut best: Option<Slab> = None;
    for bin in 1..grid.bins {
        low.add(Side { bounds: bins[bin - 1].bounds, count: bins[bin - 1].enter });
        let high = highs[bin];
        let cost = low.cost() + high.cost();
        if low.count > 0 && high.count > 0 && best.is_none_or(|best| cost < best.cost) {
            best = Some(Slab { axis: grid.axis, at: grid.plane(bin), cost, low, high });
        }
    }
    best
}

impl Slab {
    /// References that cutting adds to a range of `len`.
    pub(super) fn extra(&self, len: usize) -> usize {
        (self.low.count as usize + self.high.count as usize).saturating_sub(len)
    }

    /// The items on either side; what crosses the plane is cut, unless whole on one side is cheaper.
    pub(super) fn part(mut self, items: &[Item], triangles: &impl Cuttable) -> [Vec<Item>; 2] {
        let mut low = Vec::with_capacity(self.low.count as usize);
        let mut high = Vec::with_capacity(self.high.count as usize);
        for item in items {
            let [below, above] = self.sides(item, triangles);
            low.extend(below);
            high.extend(above);
        }
        [low, high]
    }

    fn sides(&mut self, item: &Item, triangles: &impl Cuttable) -> [Option<Item>; 2] {
        let [lo, hi] = item.bounds.along(self.axis);
        if hi <= self.at {
            return [Some(*item), None];
        }
        if lo >= self.at {
            return [None, Some(*item)];
        }
        let Some(corners) = triangles.corners(item.number()) else {
            return if 0.5 * lo + 0.5 * hi < self.at { [Some(*item), None] } else { [None, Some(*item)] };
        };
        let parts = Sweep::new(corners, self.axis).cut(item.bounds, self.at);
        let [below, above] = parts.map(|part| (!part.is_empty()).then(|| item.with_bounds(part)));
        match (below, above) {
            (None, None) => [Some(*item), None],
            (Some(_), Some(_)) => self.whole(item).unwrap_or([below, above]),
            // What the other side would have held is within rounding of nothing.
            one_sided => one_sided.into(),
        }
    }

    /// The item whole on one side, if that is cheaper than a part on each.
    fn whole(&mut self, item: &Item) -> Option<[Option<Item>; 2]> {
        let (low, high) = (self.low, self.high);
        let cost = |side: Side| side.bounds.half_area() * f64::from(side.count);
        let grown = |side: Side| Side { bounds: side.bounds.join(item.bounds), ..side };
        let without = |side: Side| Side { count: side.count.saturating_sub(1), ..side };
        let apart = cost(low) + cost(high);
        let all_low = cost(grown(low)) + cost(without(high));
        let all_high = cost(without(low)) + cost(grown(high));
        if apart <= all_low.min(all_high) {
            return None;
        }
        if all_low <= all_high {
            (self.low, self.high) = (grown(low), without(high));
            Some([Some(*item), None])
        } else {
            (self.low, self.high) = (without(low), grown(high));
            Some([None, Some(*item)])
        }
    }
}
