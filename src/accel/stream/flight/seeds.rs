//! Rays that are about to start, prepared eight at a time.

use wide::f32x8;

use super::super::Answers;
use super::super::columns::RayColumns;
use super::view::Views;
use crate::accel::Accel;
use crate::accel::leaf::cull_rays;
use crate::accel::query::Query;
use crate::accel::traversal::ask_planes;
use crate::intersect::{RayLanes, Tier};
use crate::math::{Stored, WIDTH};

/// Eight rays and all that their way down the tree needs to know of them.
pub(super) struct Seeds<T: Tier, A: Answers<T>> {
    pub(super) views: Views<T>,
    pub(super) t_min: f32x8,
    pub(super) limit: f32x8,
    queries: A::Query,
    /// Row of the first.
    first: u32,
}

impl<T: Tier, A: Answers<T>> Seeds<T, A> {
    /// The rays from a row on.
    #[inline(always)]
    pub(super) fn new<S: Stored<T::Wide>>(accel: &Accel, rays: &RayColumns<S>, first: u32) -> Self {
        let rays: RayLanes<T::Wide> = rays.load(first as usize);
        let mut queries = A::ask(&rays);
        ask_planes(accel, &rays, &mut queries);
        Self {
            t_min: T::below_f32(rays.t_min),
            limit: T::above_f32(queries.limit()),
            views: Views::new(rays, cull_rays::<T>(&rays, accel.world)),
            queries,
            first,
        }
    }

    /// Row of ray `i`.
    pub(super) fn row(&self, i: usize) -> u32 {
        self.first + i as u32
    }

    /// What ray `i` asks.
    #[inline(always)]
    pub(super) fn query(&self, i: usize) -> A::One {
        A::one(&self.queries, i)
    }
}

/// Rows of rays that go alone, in runs of up to eight, each at a row that is a multiple of eight.
#[derive(Default)]
pub(in super::super) struct Alone {
    runs: Vec<u32>,
}

impl Alone {
    pub(in super::super) fn clear(&mut self) {
        self.runs.clear();
    }
    pub(in super::super) fn is_empty(&self) -> bool {
        self.runs.is_empty()
    }
    /// Adds the run from a row on.
    pub(in super::super) fn push(&mut self, first: usize) {
        self.runs.push(first as u32);
    }
}

/// Rays that wait, of which up to eight are prepared.
pub(super) struct Waiting<'r, T: Tier, A: Answers<T>, S> {
    accel: &'r Accel,
    rays: &'r RayColumns<'r, S>,
    runs: std::slice::Iter<'r, u32>,
    seeds: Seeds<T, A>,
    /// Lanes of the seeds that have started, and how many are to.
    next: usize,
    count: usize,
}

impl<'r, T: Tier, A: Answers<T>, S: Stored<T::Wide>> Waiting<'r, T, A, S> {
    /// `None` without any.
    pub(super) fn new(accel: &'r Accel, rays: &'r RayColumns<'r, S>, alone: &'r Alone) -> Option<Self> {
        let mut runs = alone.runs.iter();
        let first = *runs.next()?;
        let seeds = Seeds::new(accel, rays, first);
        Some(Self { accel, rays, runs, seeds, next: 0, count: run_from(rays.len, first) })
    }

    /// The next to start, as a lane of seeds.
    #[inline(always)]
    pub(super) fn next(&mut self) -> Option<(&Seeds<T, A>, usize)> {
        if self.next == self.count {
            let first = *self.runs.next()?;
            self.seeds = Seeds::new(self.accel, self.rays, first);
            (self.next, self.count) = (0, run_from(self.rays.len, first));
        }
        self.next += 1;
        Some((&self.seeds, self.next - 1))
    }
}

fn run_from(len: usize, first: u32) -> usize {
    WIDTH.min(len - first as usize)
}
