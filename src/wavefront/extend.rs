//! Paths to their nearest hits, sorted by the kind of primitive.

use std::ops::Range;

use bumpalo::Bump;

use super::queue::{PathQueue, column};
use super::wave::Worker;
use crate::accel::Hint;
use crate::accel::stream::{Apex, Bound, HitColumns, RayColumns};
use crate::intersect::{PrimId, PrimKind, Tier};
use crate::math::{Lane, Real, WIDTH, eight};

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
    pub(super) misses: bumpalo::collections::Vec<'a, u32>,
    pub(super) by_kind: [bumpalo::collections::Vec<'a, u32>; 4],
}

/// Traces the paths of rows `first..first + n` of a queue.
pub(super) fn extend<'a, T: Tier>(
    worker: &mut Worker<T>,
    queue: &PathQueue<T::Real>,
    (first, n): (usize, usize),
    apex: Option<Apex>,
    arena: &'a Bump,
) -> Hits<'a, T::Real> {
    let requirements = &worker.frame.scene.requirements;
    let list = || bumpalo::collections::Vec::with_capacity_in(n, arena);
    let mut hits = Hits {
        t: column(arena, n),
        u: column(arena, n),
        v: column(arena, n),
        prim: column(arena, n),
        instance: column(arena, if requirements.instances { n } else { 0 }),
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
    hits.sort(n);
    hits
}

impl<'a, R: Real> Hits<'a, R> {
    /// Sorts the paths by what they hit, eight together where that is the same.
    fn sort(&mut self, n: usize) {
        for first in (0..n).step_by(WIDTH) {
            let end = n.min(first + WIDTH);
            if end == first + WIDTH && self.are_alike(first..end) {
                self.list(self.kind(first)).extend_from_slice_copy(&eight(|i| (first + i) as u32));
                continue;
            }
            for row in first..end {
                self.list(self.kind(row)).push(row as u32);
            }
        }
    }

    /// Whether all paths missed, or all hit the same kind of primitive.
    #[inline(always)]
    fn are_alike(&self, rows: Range<usize>) -> bool {
        let (t, prim) = (&self.t[rows.clone()], &self.prim[rows]);
        let hits = t.iter().filter(|&&t| t < R::constant(f64::INFINITY)).count();
        let differing = prim.iter().fold(0, |bits, p| bits | (p ^ prim[0]));
        hits == 0 || hits == t.len() && (differing as usize) < PrimId::MAX_ROWS
    }

    /// What kind of primitive a path hit; 0 is none.
    #[inline(always)]
    fn kind(&self, row: usize) -> usize {
        let is_hit = self.t[row] < R::constant(f64::INFINITY);
        if is_hit { PrimId(self.prim[row]).kind() as usize } else { 0 }
    }

    #[inline(always)]
    fn list(&mut self, kind: usize) -> &mut bumpalo::collections::Vec<'a, u32> {
        if kind == 0 { &mut self.misses } else { &mut self.by_kind[kind - 1] }
    }
}

/// The kinds of primitive, with their rows among the lists of hits.
pub(super) const KINDS: [PrimKind; 4] = PrimKind::ALL;
