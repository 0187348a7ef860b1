//! The best plane across an axis that parts space itself: what crosses it is cut and counts on both sides.
//!
//! **Source:** Stich, Friedrich and Dietrich, "Spatial Splits in Bounding Volume Hierarchies", 2009, sections 4.2 to 4.4.
//! Changed: a side costs its leaf blocks, as in [`super::bins`]; what is no triangle is not cut and goes where its
//! centre is.

use wide::f32x8;

use super::bins::Side;
use super::box8::Box8;
use super::cut::{Cuttable, Sweep};
use super::item::{Extent, Item, XYZXYZ, reduce};

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

/// The planes between bins of an axis.
#[derive(Clone, Copy)]
struct Grid {
    axis: usize,
    bins: usize,
    start: f32,
    step: f32,
    bins_a_unit: f32,
}

impl Grid {
    /// `None` where there is nothing to cut.
    fn new(bounds: &Box8, axis: usize, bins: usize) -> Option<Self> {
        let [start, end] = bounds.along(axis);
        let (step, bins_a_unit) = ((end - start) / bins as f32, bins as f32 / (end - start));
        let apart = start + step > start && end - step < end;
        let usable = step.is_normal() && bins_a_unit.is_normal() && apart;
        usable.then_some(Self { axis, bins, start, step, bins_a_unit })
    }
    /// The plane below a bin.
    fn plane(&self, bin: usize) -> f32 {
        self.start + self.step * bin as f32
    }
    fn bin(&self, place: f32) -> usize {
        (((place - self.start) * self.bins_a_unit) as usize).min(self.bins - 1)
    }
}

/// What is in a bin, and how many begin and end there.
#[derive(Clone, Copy)]
struct Bin {
    bounds: Box8,
    enter: u32,
    exit: u32,
}

type Bins = [[Bin; MANY]; 3];

/// From coordinates to bins, by axis: least coordinates, and greatest with the sign turned.
struct Spread {
    start: f32x8,
    bins_a_unit: f32x8,
    last: f32x8,
}

impl Spread {
    fn new(grids: &[Option<Grid>; 3], bins: usize) -> Self {
        let of = |value: fn(&Grid) -> f32| grids.each_ref().map(|grid| grid.as_ref().map_or(0.0, value));
        let ([a, b, c], [d, e, f]) = (of(|grid| grid.start), of(|grid| grid.bins_a_unit));
        Self {
            start: f32x8::new([a, b, c, 0.0, -a, -b, -c, 0.0]),
            bins_a_unit: f32x8::new([d, e, f, 0.0, -d, -e, -f, 0.0]),
            last: f32x8::splat((bins - 1) as f32),
        }
    }

    /// As [`Grid::bin`] of both ends of an item on each axis; an axis without a grid has one bin.
    #[inline(always)]
    fn ends(&self, item: &Item) -> [[usize; 4]; 2] {
        let place = (item.bounds.0 & XYZXYZ) - self.start;
        let place = (place * self.bins_a_unit).fast_max(f32x8::ZERO).fast_min(self.last);
        let bins: [[i32; 4]; 2] = bytemuck::cast(place.fast_trunc_int());
        bins.map(|bins| bins.map(|bin| bin as usize % MANY))
    }
}

/// The best plane through a range; `None` if none has items on both sides.
pub(super) fn best_slab(items: &[Item], extent: &Extent, triangles: &impl Cuttable) -> Option<Slab> {
    let count = if items.len() < FEW_ITEMS { FEW } else { MANY };
    let grids = [0, 1, 2].map(|axis| Grid::new(&extent.bounds, axis, count));
    let spread = Spread::new(&grids, count);
    // Two sets of bins: see `bins`.
    let run = |run: &[Item]| {
        let mut sets = [[[Bin { bounds: Box8::EMPTY, enter: 0, exit: 0 }; MANY]; 3]; 2];
        for (i, item) in run.iter().enumerate() {
            put(&mut sets[i & 1], &grids, &spread, item, triangles);
        }
        join(sets[0], sets[1])
    };
    let bins = reduce(items, &run, &join);
    let best = grids.iter().zip(&bins).filter_map(|(grid, bins)| best_on(grid.as_ref()?, bins));
    best.reduce(|a, b| if b.cost < a.cost { b } else { a })
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
#[inline(always)]
fn put(bins: &mut Bins, grids: &[Option<Grid>; 3], spread: &Spread, item: &Item, triangles: &impl Cuttable) {
    let [first, last] = spread.ends(item);
    if first[..3] == last[..3] {
        // Most items are small.
        return bins.iter_mut().zip(first).for_each(|(bins, bin)| put_whole(&mut bins[bin], item));
    }
    for (axis, (grid, bins)) in grids.iter().zip(bins).enumerate() {
        let Some(grid) = grid else { continue };
        put_across(bins, grid, [first[axis], last[axis]], item, triangles);
    }
}

fn put_across(
    bins: &mut [Bin; MANY],
    grid: &Grid,
    [first, last]: [usize; 2],
    item: &Item,
    triangles: &impl Cuttable,
) {
    let [lo, hi] = item.bounds.along(grid.axis);
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
