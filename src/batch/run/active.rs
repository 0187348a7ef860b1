//! A unit in work: any number of threads paint its tiles.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};
use std::time::Instant;

use super::queue::Waiting;
use super::work::Work;
use crate::batch::compose::aov_bits;
use crate::batch::part::Part;
use crate::batch::{BatchError, Store};
use crate::film::TileSums;
use crate::scene::Scene;
use crate::wavefront::{Painted, Rect, Scratch, Tiles, paint};

/// A unit in work.
pub(super) struct Active {
    pub(super) scene: Scene,
    pub(super) of: Waiting,
    samples: std::ops::Range<u32>,
    /// Tiles that were not done when it was opened: number and place.
    tiles: Vec<(usize, Rect)>,
    taken: AtomicUsize,
    /// Tiles not yet done.
    left: AtomicUsize,
    /// Whether a thread panicked at it.
    spoiled: AtomicBool,
    sums: Mutex<Sums>,
}

struct Sums {
    part: Part,
    kept: Instant,
}

impl Work<'_> {
    /// A unit with its scene, and with what its checkpoint holds.
    pub(super) fn open(&self, of: Waiting) -> Result<Active, BatchError> {
        let unit = self.plan.unit(of.unit);
        let picture = &self.plan.pictures[unit.picture];
        let scene = self.scenes.scene(picture, self.queue.bytes())?;
        if (scene.settings.size, scene.settings.spp) != (picture.size, picture.spp) {
            return Err(BatchError::Job("the plan's size or samples are not those of the scene".into()));
        }
        let (samples, cost) = (unit.samples.clone(), unit.cost());
        let part = self.store.resumed(Part::new(unit, scene.settings.aovs))?;
        let missing = part.missing();
        let tiles: Vec<(usize, Rect)> = missing.into_iter().map(|tile| (tile, part.tiles[tile])).collect();
        let to_do: u64 = tiles.iter().map(|(_, rect)| u64::from(rect[2]) * u64::from(rect[3])).sum();
        self.advance(cost - to_do * samples.len() as u64, 0);
        tracing::info!(unit = of.unit, picture = picture.name, tiles = tiles.len(), "unit opened");
        Ok(Active {
            scene,
            of,
            samples,
            taken: AtomicUsize::new(0),
            left: AtomicUsize::new(tiles.len()),
            spoiled: AtomicBool::new(false),
            tiles,
            sums: Mutex::new(Sums { part, kept: Instant::now() }),
        })
    }
}

impl Active {
    /// Tiles that nobody has taken.
    pub(super) fn tiles_left(&self) -> usize {
        self.tiles.len().saturating_sub(self.taken.load(Relaxed))
    }

    /// Leaves no tile to take after a panic; that one's tile is never done, so neither is the unit. True for the first panic.
    pub(super) fn spoil(&self) -> bool {
        self.taken.store(self.tiles.len(), Relaxed);
        !self.spoiled.swap(true, Relaxed)
    }

    /// Paints tiles until none is left to take; true for the one thread after which the unit is done.
    pub(super) fn paint(&self, work: &Work, scratch: &mut Scratch) -> bool {
        let painter = Painter { active: self, work, done: AtomicUsize::new(0) };
        paint(&self.scene, self.samples.clone(), &painter, scratch);
        let done = painter.done.into_inner();
        // A unit whose checkpoint has every tile is done without painting any.
        self.left.fetch_sub(done, std::sync::atomic::Ordering::AcqRel) == done
            && (done > 0 || self.tiles.is_empty())
    }

    /// Its sums, which it then has no more.
    pub(super) fn take(&self) -> Part {
        let mut sums = self.sums.lock().expect("no thread panics while it stores a tile");
        let emptied = sums.part.emptied();
        std::mem::replace(&mut sums.part, emptied)
    }

    /// Keeps what is done.
    pub(super) fn keep(&self, store: &Store) -> Result<(), BatchError> {
        let sums = self.sums.lock().expect("no thread panics while it stores a tile");
        if sums.part.is_untouched() {
            return Ok(());
        }
        tracing::info!(unit = self.of.unit, "checkpoint");
        store.checkpoint(&sums.part)
    }
}

/// One thread at a unit.
struct Painter<'a> {
    active: &'a Active,
    work: &'a Work<'a>,
    done: AtomicUsize,
}

impl Tiles for Painter<'_> {
    fn next(&self) -> Option<Rect> {
        if self.work.is_stopped() {
            return None;
        }
        self.active.tiles.get(self.active.taken.fetch_add(1, Relaxed)).map(|(_, rect)| *rect)
    }

    fn cancelled(&self) -> bool {
        false
    }

    fn done(&self, painted: Painted<'_>) {
        // Parts with later samples have none; the thread may remember those of a tile before.
        let aovs = match self.active.samples.start {
            0 => aov_bits(self.active.scene.settings.aovs, painted.seen),
            _ => Vec::new(),
        };
        let nodes = node_major(painted.sums);
        let samples = painted.pixels.len() as u64 * self.active.samples.len() as u64;
        let mut sums = self.active.sums.lock().expect("no thread panics while it stores a tile");
        let tile = sums.part.tiles.iter().position(|rect| *rect == painted.tile).expect("a tile of the unit");
        sums.part.sums[tile] = Some(TileSums { nodes, aovs });
        sums.part.nan_samples += painted.counts.nan_samples;
        self.done.fetch_add(1, Relaxed);
        if sums.kept.elapsed() >= self.work.options.checkpoint_every {
            sums.kept = Instant::now();
            tracing::info!(unit = self.active.of.unit, "checkpoint");
            if let Err(error) = self.work.store.checkpoint(&sums.part) {
                tracing::warn!(unit = self.active.of.unit, error = error.told(), "checkpoint failed");
            }
        }
        drop(sums);
        self.work.advance(samples, painted.counts.rays.total());
    }
}

/// Sums node by node, in each pixel by pixel.
fn node_major(sums: &mut [crate::film::PixelSum<4>]) -> Vec<[f32; 4]> {
    let nodes = sums.iter_mut().map(|sum| sum.finish().nodes().len()).next().unwrap_or(0);
    let mut list = Vec::with_capacity(nodes * sums.len());
    for node in 0..nodes {
        list.extend(sums.iter_mut().map(|sum| sum.finish().nodes()[node].sum));
    }
    list
}
