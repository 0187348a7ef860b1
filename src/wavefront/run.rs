//! One wave through all stages and depths.

use super::arena::Arena;
use super::connect::connect;
use super::emit::{background, glow};
use super::extend::extend;
use super::generate::generate;
use super::queue::PathQueue;
use super::scatter::scatter;
use super::surface_queue::SurfaceQueue;
use super::wave::{WaveSamples, Worker};
use crate::intersect::Tier;
use crate::math::WIDTH;

/// Most paths that go through a stage at once. Queues that grow beyond are cut, and what grows out of the first piece is
/// finished before the next: memory stays bounded however rays split.
pub(super) const CHUNK: usize = 1024;

/// An arena for each depth, opened anew when the queue it holds is done with.
pub(super) type Arenas = [Arena];

/// Traces the samples of a wave: their radiances are in `worker.radiance` afterwards. Gives the samples' weights, one by
/// one, to `weight`, where the filter has any.
pub(super) fn run_wave<T: Tier>(
    worker: &mut Worker<T>,
    wave: WaveSamples,
    arenas: &mut Arenas,
    mut weight: impl FnMut(usize, T::Real),
) {
    let (arena, deeper) = arenas.split_first_mut().expect("an arena for the camera rays");
    worker.radiance.reset(wave.len());
    let (paths, weights) = generate::<T>(worker.frame, wave, &arena.open());
    worker.rays.camera += paths.len as u64;
    for (slot, &w) in weights.iter().enumerate().take(wave.len()) {
        weight(slot, w);
    }
    run_depth(worker, wave, 0, &paths, deeper);
}

/// Shades all paths of a queue, and everything that comes of them.
fn run_depth<T: Tier>(
    worker: &mut Worker<T>,
    wave: WaveSamples,
    depth: u32,
    paths: &PathQueue<T::Real>,
    arenas: &mut Arenas,
) {
    for first in (0..paths.len).step_by(CHUNK) {
        let n = (paths.len - first).min(CHUNK);
        run_chunk(worker, wave, depth, paths, (first, n), arenas);
    }
}

fn run_chunk<T: Tier>(
    worker: &mut Worker<T>,
    wave: WaveSamples,
    depth: u32,
    paths: &PathQueue<T::Real>,
    (first, n): (usize, usize),
    arenas: &mut Arenas,
) {
    let (arena, deeper) = arenas.split_first_mut().expect("an arena for every depth");
    let room = arena.open();
    let scene = worker.frame.scene;
    let apex = if depth == 0 { worker.frame.apex } else { None };
    let hits = extend(worker, paths, (first, n), apex, &room);
    background(worker, paths, first, &hits);
    let surfaces = SurfaceQueue::evaluate::<T::Wide>(scene, paths, first, &hits, &room);
    if scene.requirements.glow {
        glow(worker, &surfaces);
    }
    if scene.requirements.lights {
        connect(worker, &surfaces, &room);
    }
    let children = scene.requirements.children();
    if depth == scene.settings.max_depth || children == 0 {
        return;
    }
    let scattering: usize = surfaces.by_scatter.iter().map(|list| list.len()).sum();
    let mut next = PathQueue::new(&room, scattering * children + WIDTH, worker.frame.secondary_needs());
    scatter(worker, wave, depth, paths, &surfaces, &mut next, &room);
    run_depth(worker, wave, depth + 1, &next, deeper);
}
