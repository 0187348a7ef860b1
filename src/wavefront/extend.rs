//! Paths to their nearest hits, sorted by the kind of primitive.

use super::arena::{List, Room};
use super::queue::{PathQueue, words};
use super::wave::Worker;
use crate::accel::Hint;
use crate::accel::stream::{Apex, Bound, HitColumns, RayColumns};
use crate::intersect::{PrimId, PrimKind, Tier};
use crate::math::{BitLane, Lane, Real, WIDTH, eight};

/// Nearest hits of a chunk of paths, and the paths by what they hit.
///
/// **Shape:** columns have a row for each path of the chunk; the lists hold rows, ascending.
pub(super) struct Hits<'a, R> {
    pub(super) t: &'a mut [R],
    pub(super) u: &'a mut [R],
    pub(super) v: &'a mut [R],
    pub(super) prim: &'a mut [u32],
    /// Empty where the scene has no instances.
    pub(super) instance: &'a mut [u32],
    pub(super) misses: List<'a>,
    pub(super) by_kind: [List<'a>; 4],
}

/// Traces the paths of rows `first..first + n` of a queue.
pub(super) fn extend<'a, T: Tier>(
    worker: &mut Worker<T>,
    queue: &PathQueue<T::Real>,
    (first, n): (usize, usize),
    apex: Option<Apex>,
    room: &Room<'a>,
) -> Hits<'a, T::Real> {
    let requirements = &worker.frame.scene.requirements;
    let list = || room.list(n);
    let mut hits = Hits {
        t: room.column(n),
        u: room.column(n),
        v: room.column(n),
        prim: room.column(n),
        instance: room.column(if requirements.instances { n } else { 0 }),
        misses: list(),
        by_kind: [list(), list(), list(), list()],
    };
    let rays = RayColumns {
        len: n,
        origin: queue.origin.rows_from(first),
        direction: queue.direction.rows_from(first),
        t_min: match queue.t_min.get(first..) {
            Some(column) if !column.is_empty() => Bound::Each(column),
            _ => Bound::All(T::Real::constant(0.0)),
        },
        t_max: Bound::All(T::Real::constant(f64::INFINITY)),
    };
    let mut found = HitColumns { t: hits.t, u: hits.u, v: hits.v, prim: hits.prim, instance: hits.instance };
    worker.stream.closest(&rays, apex, Hint::Auto, &mut found);
    hits.sort::<T::Wide>(n);
    hits
}

impl<'a, R: Real> Hits<'a, R> {
    /// Sorts the paths by what they hit, eight together where that is the same.
    fn sort<L: Lane<Scalar = R, Bits = wide::u32x8>>(&mut self, n: usize) {
        for first in (0..n).step_by(WIDTH) {
            let (kinds, rows) = (self.kinds::<L>(first), eight(|i| (first + i) as u32));
            let count = (n - first).min(WIDTH);
            if kinds[..count].iter().all(|&kind| kind == kinds[0]) {
                self.list(kinds[0]).extend(&rows, count);
                continue;
            }
            for i in 0..count {
                self.list(kinds[i]).push(rows[i]);
            }
        }
    }

    /// What kinds of primitive eight paths hit; 0 is none.
    #[inline(always)]
    fn kinds<L: Lane<Scalar = R, Bits = wide::u32x8>>(&self, first: usize) -> [u32; WIDTH] {
        let hit = L::load(&self.t[first..]).lt(L::constant(f64::INFINITY));
        let kinds = wide::u32x8::new(*words(self.prim, first)) >> PrimId::ROW_BITS;
        L::select_bits(hit, kinds, BitLane::splat(0)).to_array()
    }

    #[inline(always)]
    fn list(&mut self, kind: u32) -> &mut List<'a> {
        if kind == 0 { &mut self.misses } else { &mut self.by_kind[kind as usize - 1] }
    }
}

/// The kinds of primitive, with their rows among the lists of hits.
pub(super) const KINDS: [PrimKind; 4] = PrimKind::ALL;
