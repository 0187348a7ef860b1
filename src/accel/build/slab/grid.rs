//! Planes at equal distances across an axis, and the bins between them.

use wide::f32x8;

use super::super::box8::Box8;
use super::super::item::{Item, XYZXYZ};
use super::MANY;

/// The planes between bins of an axis.
#[derive(Clone, Copy)]
pub(super) struct Grid {
    pub(super) axis: usize,
    pub(super) bins: usize,
    start: f32,
    step: f32,
    bins_a_unit: f32,
}

impl Grid {
    /// `None` where there is nothing to cut.
    pub(super) fn new(bounds: &Box8, axis: usize, bins: usize) -> Option<Self> {
        let [start, end] = bounds.along(axis);
        let (step, bins_a_unit) = ((end - start) / bins as f32, bins as f32 / (end - start));
        let apart = start + step > start && end - step < end;
        let usable = step.is_normal() && bins_a_unit.is_normal() && apart;
        usable.then_some(Self { axis, bins, start, step, bins_a_unit })
    }
    /// The plane below a bin.
    #[inline(always)]
    pub(super) fn plane(&self, bin: usize) -> f32 {
        self.start + self.step * bin as f32
    }
    /// What lies between two planes; beyond the ends everything.
    pub(super) fn layer(&self, bin: usize) -> Box8 {
        let mut lanes = [f32::NEG_INFINITY; 8];
        if bin > 0 {
            lanes[self.axis] = self.plane(bin);
        }
        if bin + 1 < self.bins {
            lanes[self.axis + 4] = -self.plane(bin + 1);
        }
        Box8(f32x8::new(lanes))
    }
    #[inline(always)]
    pub(super) fn bin(&self, place: f32) -> usize {
        (((place - self.start) * self.bins_a_unit) as usize).min(self.bins - 1)
    }
}

/// From coordinates to bins, by axis: least coordinates, and greatest with the sign turned.
pub(super) struct Spread {
    start: f32x8,
    bins_a_unit: f32x8,
    last: f32x8,
}

impl Spread {
    pub(super) fn new(grids: &[Option<Grid>; 3], bins: usize) -> Self {
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
    pub(super) fn ends(&self, item: &Item) -> [[usize; 4]; 2] {
        let place = (item.bounds.0 & XYZXYZ) - self.start;
        let place = (place * self.bins_a_unit).fast_max(f32x8::ZERO).fast_min(self.last);
        let bins: [[i32; 4]; 2] = bytemuck::cast(place.fast_trunc_int());
        bins.map(|bins| bins.map(|bin| bin as usize % MANY))
    }
}
