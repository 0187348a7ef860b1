//! Rays that are about to start, prepared eight at a time.

use wide::f32x8;

use super::super::answers::Answers;
use super::super::columns::RayColumns;
use super::view::Views;
use crate::accel::Accel;
use crate::accel::leaf::cull_rays;
use crate::accel::node::Node8;
use crate::accel::query::Query;
use crate::accel::traversal::ask_planes;
use crate::intersect::{RayLanes, Tier};
use crate::math::Stored;

/// Eight rays and all that their way down the tree needs to know of them.
pub(super) struct Seeds<T: Tier, A: Answers<T>> {
    pub(super) views: Views<T>,
    pub(super) t_min: f32x8,
    pub(super) limit: f32x8,
    queries: A::Query,
    /// Row of the first.
    first: u32,
    /// Which are to start, as bits.
    pub(super) lanes: u8,
}

impl<T: Tier, A: Answers<T>> Seeds<T, A> {
    /// The rays from a row on.
    #[inline(always)]
    pub(super) fn new<S: Stored<T::Wide>>(accel: &Accel, rays: &RayColumns<S>, run: Run) -> Self {
        let first = run.first;
        let there = rays.there(first as usize) as u8;
        let rays: RayLanes<T::Wide> = rays.load(first as usize);
        let mut queries = A::ask(&rays);
        ask_planes(accel, &rays, &mut queries);
        Self {
            t_min: T::below_f32(rays.t_min),
            limit: T::above_f32(queries.limit()),
            views: Views::new(rays, cull_rays::<T>(&rays, accel.world)),
            queries,
            first,
            lanes: run.lanes & there,
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

/// Up to eight rays that go alone.
#[derive(Clone, Copy)]
pub(super) struct Run {
    /// Row of the first: a multiple of eight.
    pub(super) first: u32,
    /// Which entry they take.
    entry: Option<EntryNumber>,
    /// Which of the eight, as bits.
    lanes: u8,
}

/// The number of an entry.
#[derive(Clone, Copy)]
pub(in super::super) struct EntryNumber(usize);

/// Rows of rays that go alone, in runs, and nodes that stand for the tree to some of them.
#[derive(Default)]
pub(in super::super) struct Alone {
    runs: Vec<Run>,
    entries: Vec<Node8>,
}

impl Alone {
    pub(in super::super) fn clear(&mut self) {
        self.runs.clear();
        self.entries.clear();
    }
    pub(in super::super) fn is_empty(&self) -> bool {
        self.runs.is_empty()
    }
    /// Adds the run from a row on, with what stands for the tree to its rays.
    pub(in super::super) fn push(&mut self, first: usize, entry: Option<EntryNumber>) {
        self.runs.push(Run { first: first as u32, entry, lanes: 0xff });
    }
    /// Adds some of eight rays from a row on.
    pub(in super::super) fn push_some(&mut self, first: usize, lanes: u8) {
        self.runs.push(Run { first: first as u32, entry: None, lanes });
    }
    /// Adds what stands for the tree to runs to come.
    pub(in super::super) fn add_entry(&mut self, node: Node8) -> EntryNumber {
        self.entries.push(node);
        EntryNumber(self.entries.len() - 1)
    }
    /// The runs.
    pub(super) fn runs(&self) -> impl Iterator<Item = Run> {
        self.runs.iter().copied()
    }
    /// What stands for the tree to the rays of a run, if it is not the root.
    pub(super) fn entry(&self, run: Run) -> Option<&Node8> {
        run.entry.map(|EntryNumber(number)| &self.entries[number])
    }
}
