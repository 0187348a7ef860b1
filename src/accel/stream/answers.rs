//! What streams are asked, by packets and by single rays, and where the answers go.

use super::columns::HitColumns;
use super::flight::Flight;
use super::{BUNDLE, no_rays};
use crate::accel::Accel;
use crate::accel::query::{AnyHit, Closest, Query};
use crate::intersect::{RayLanes, Tier};
use crate::math::WIDTH;

/// Where the answers of a stream go.
pub(super) trait Answers<T: Tier> {
    /// What packets ask.
    type Query: Query<T::Wide> + Copy;
    /// What single rays ask.
    type One: Query<T::Real> + Copy;
    /// The question of eight rays.
    fn ask(rays: &RayLanes<T::Wide>) -> Self::Query;
    /// What one of the eight asks.
    fn one(query: &Self::Query, i: usize) -> Self::One;
    /// Writes the answers of eight rays from row `at` on.
    fn store(&mut self, at: usize, query: &Self::Query);
    /// Writes the answer of one.
    fn store_one(&mut self, row: usize, query: &Self::One);
    /// The scratch for these questions.
    fn scratch(scratch: &mut Scratch<T>) -> &mut Asked<T, Self::Query, Self::One>;
}

impl<T: Tier> Answers<T> for HitColumns<'_, T::Real> {
    type Query = Closest<T::Wide>;
    type One = Closest<T::Real>;

    #[inline(always)]
    fn ask(rays: &RayLanes<T::Wide>) -> Self::Query {
        Closest::new(rays.t_max)
    }
    #[inline(always)]
    fn one(query: &Self::Query, i: usize) -> Self::One {
        query.get(i)
    }
    #[inline(always)]
    fn store(&mut self, at: usize, query: &Self::Query) {
        HitColumns::store(self, at, query);
    }
    #[inline(always)]
    fn store_one(&mut self, row: usize, query: &Self::One) {
        HitColumns::store_one(self, row, query);
    }
    fn scratch(scratch: &mut Scratch<T>) -> &mut Asked<T, Self::Query, Self::One> {
        &mut scratch.closest
    }
}

/// Bit `i` of byte `k`: whether ray `8 k + i` hits anything.
pub(super) struct Occluded<'a>(pub(super) &'a mut [u8]);

impl<T: Tier> Answers<T> for Occluded<'_> {
    type Query = AnyHit<T::Wide>;
    type One = AnyHit<T::Real>;

    #[inline(always)]
    fn ask(rays: &RayLanes<T::Wide>) -> Self::Query {
        AnyHit::new(rays.t_max)
    }
    #[inline(always)]
    fn one(query: &Self::Query, i: usize) -> Self::One {
        query.get(i)
    }
    #[inline(always)]
    fn store(&mut self, at: usize, query: &Self::Query) {
        self.0[at / WIDTH] = query.hits() as u8;
    }
    #[inline(always)]
    fn store_one(&mut self, row: usize, query: &Self::One) {
        let bit = 1 << (row % WIDTH);
        let byte = &mut self.0[row / WIDTH];
        *byte = if query.hits() != 0 { *byte | bit } else { *byte & !bit };
    }
    fn scratch(scratch: &mut Scratch<T>) -> &mut Asked<T, Self::Query, Self::One> {
        &mut scratch.any
    }
}

/// What is asked of a stream, by packets and by single rays.
pub(super) struct Asked<T: Tier, Q, O> {
    pub(super) queries: Box<[Q; BUNDLE]>,
    pub(super) flight: Flight<T, O>,
}

impl<T: Tier, Q: Copy, O: Query<T::Real> + Copy> Asked<T, Q, O> {
    pub(super) fn new(accel: &Accel, ask: impl Fn(&RayLanes<T::Wide>) -> Q) -> Self {
        Self { queries: Box::new([ask(&no_rays()); BUNDLE]), flight: Flight::new(accel) }
    }
}

/// Room for each of the questions.
pub(super) struct Scratch<T: Tier> {
    pub(super) closest: Asked<T, Closest<T::Wide>, Closest<T::Real>>,
    pub(super) any: Asked<T, AnyHit<T::Wide>, AnyHit<T::Real>>,
}
