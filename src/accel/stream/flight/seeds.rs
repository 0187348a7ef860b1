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
    /// How many are to start.
    pub(super) count: usize,
}

impl<T: Tier, A: Answers<T>> Seeds<T, A> {
    /// The rays from a row on.
    #[inline(always)]
    pub(super) fn new<S: Stored<T::Wide>>(accel: &Accel, rays: &RayColumns<S>, first: u32) -> Self {
        let count = WIDTH.min(rays.len - first as usize);
        let rays: RayLanes<T::Wide> = rays.load(first as usize);
        let mut queries = A::ask(&rays);
        ask_planes(accel, &rays, &mut queries);
        Self {
            t_min: T::below_f32(rays.t_min),
            limit: T::above_f32(queries.limit()),
            views: Views::new(rays, cull_rays::<T>(&rays, accel.world)),
            queries,
            first,
            count,
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
    /// The first rows of the runs.
    pub(super) fn runs(&self) -> impl Iterator<Item = u32> {
        self.runs.iter().copied()
    }
}
