//! Paths to their nearest hits, sorted by the kind of primitive.

use bumpalo::Bump;

use super::queue::{PathQueue, column};
use super::wave::Worker;
use crate::accel::Hint;
use crate::accel::stream::{Apex, Bound, HitColumns, RayColumns};
use crate::intersect::{PrimId, PrimKind, Tier};
use crate::math::{Lane, Real};

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
        t_min: Bound::Each(&queue.t_min[first..]),
        t_max: Bound::All(T::Real::constant(f64::INFINITY)),
    };
    let mut found = HitColumns { t: hits.t, u: hits.u, v: hits.v, prim: hits.prim, instance: hits.instance };
    worker.stream.closest(&rays, apex, Hint::Auto, &mut found);
    hits.sort(n);
    hits
}

impl<R: Real> Hits<'_, R> {
    /// Sorts the paths by what they hit.
    fn sort(&mut self, n: usize) {
        let infinity = R::constant(f64::INFINITY);
        for row in 0..n {
            match self.t[row] < infinity {
                false => self.misses.push(row as u32),
                true => self.by_kind[PrimId(self.prim[row]).kind() as usize - 1].push(row as u32),
            }
        }
    }
}

/// The kinds of primitive, with their rows among the lists of hits.
pub(super) const KINDS: [PrimKind; 4] = PrimKind::ALL;
