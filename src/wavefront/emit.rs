//! Radiance that needs no light source: the background for paths that miss, the glow of surfaces for those that hit.

use super::extend::Hits;
use super::queue::{PathQueue, list_lanes};
use super::surface_queue::SurfaceQueue;
use super::wave::Worker;
use crate::geometry::gather3;
use crate::intersect::Tier;
use crate::math::WIDTH;

/// Adds what missing paths see.
pub(super) fn background<T: Tier>(
    worker: &mut Worker<T>,
    queue: &PathQueue<T::Real>,
    first: usize,
    hits: &Hits<T::Real>,
) {
    for at in (0..hits.misses.len()).step_by(WIDTH) {
        let (rows, lanes) = list_lanes(&hits.misses, at);
        let paths = rows.offset(first);
        let direction = queue.direction.gather::<T::Wide>(&paths);
        let seen = worker.frame.scene.background.radiance(direction);
        let radiance = queue.throughput.gather::<T::Wide>(&paths).scale(seen);
        worker.radiance.add(&paths.of(queue.slot), radiance, lanes);
    }
}

/// Adds the glow of surfaces: ambient light and emission.
pub(super) fn glow<T: Tier>(worker: &mut Worker<T>, surfaces: &SurfaceQueue<T::Real>) {
    for at in (0..surfaces.len).step_by(WIDTH) {
        let glow = gather3::<T::Wide>(&worker.frame.scene.materials.glow, surfaces.materials(at));
        let radiance = surfaces.throughput.load::<T::Wide>(at).scale(glow);
        worker.radiance.add(surfaces.slots(at), radiance, surfaces.lanes(at));
    }
}
