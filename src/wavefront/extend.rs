//! Paths to their nearest hits, sorted by the kind of primitive.

use bumpalo::Bump;

use super::queue::{PathQueue, column, padded};
use super::wave::Worker;
use crate::accel::Hint;
use crate::accel::query::Closest;
use crate::intersect::{PrimId, PrimKind, RayLanes, Tier};
use crate::math::{Lane, Mask, Real, WIDTH};

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
    hint: Hint,
    arena: &'a Bump,
) -> Hits<'a, T::Real> {
    let requirements = &worker.frame.scene.requirements;
    let list = || bumpalo::collections::Vec::new_in(arena);
    let mut hits = Hits {
        t: column(arena, n),
        u: column(arena, n),
        v: column(arena, n),
        prim: column(arena, n),
        instance: column(arena, if requirements.instances { n } else { 0 }),
        misses: list(),
        by_kind: [list(), list(), list(), list()],
    };
    for at in (0..padded(n)).step_by(WIDTH) {
        let count = (n - at).min(WIDTH);
        let ray = load_rays::<T>(queue, first + at, count);
        let found = worker.traversal.closest::<T>(&ray, hint);
        hits.store::<T>(at, count, &found, found.t.lt(ray.t_max).bits());
    }
    hits
}

impl<R: Real> Hits<'_, R> {
    /// Takes note of what eight paths hit, of which the first `count` are there.
    #[inline(always)]
    fn store<T: Tier<Real = R>>(&mut self, at: usize, count: usize, found: &Closest<T::Wide>, hit: u32) {
        found.t.store(&mut self.t[at..]);
        found.u.store(&mut self.u[at..]);
        found.v.store(&mut self.v[at..]);
        let prims = found.prim.to_array();
        self.prim[at..at + WIDTH].copy_from_slice(&prims);
        if let Some(instance) = self.instance.get_mut(at..at + WIDTH) {
            instance.copy_from_slice(&found.instance.to_array());
        }
        for (i, &prim) in prims.iter().enumerate().take(count) {
            let row = (at + i) as u32;
            match hit >> i & 1 {
                0 => self.misses.push(row),
                _ => self.by_kind[PrimId(prim).kind() as usize - 1].push(row),
            }
        }
    }
}

/// Eight paths as rays without end; lanes beyond `count` are turned off.
#[inline(always)]
fn load_rays<T: Tier>(queue: &PathQueue<T::Real>, at: usize, count: usize) -> RayLanes<T::Wide> {
    let infinity = <T::Real as Lane>::constant(f64::INFINITY);
    RayLanes {
        origin: queue.origin.load(at),
        direction: queue.direction.load(at),
        t_min: T::Wide::load(&queue.t_min[at..]),
        t_max: T::Wide::from_fn(|i| if i < count { infinity } else { -infinity }),
    }
}

/// The kinds of primitive, with their rows among the lists of hits.
pub(super) const KINDS: [PrimKind; 4] = PrimKind::ALL;
