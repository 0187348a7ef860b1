//! One thread's way through tiles: all samples of a tile's pixels, then the next tile.

use std::ops::Range;

use bumpalo::Bump;

use super::aov::look;
use super::run::{CHUNK, run_wave};
use super::tile::{Rect, Sums, pixels};
use super::wave::{Frame, RayCounts, WaveSamples, Worker};
use crate::accel::stream::RayStream;
use crate::film::{AovSample, PixelSum, SAMPLES_PER_BLOCK, SampleSums};
use crate::intersect::{Exact, Fast, Tier, TierName, Watertight};
use crate::math::Real;
use crate::scene::Scene;

/// Bytes that a full queue with all its columns hardly exceeds; those that stay untouched cost nothing.
const ARENA: usize = 1 << 20;

/// What became of a tile.
pub(crate) struct Painted<'a> {
    /// Left, top, width, height.
    pub(crate) tile: Rect,
    /// Its pixels, in the order of what follows.
    pub(crate) pixels: &'a [[u32; 2]],
    /// Sums of the samples.
    pub(crate) sums: &'a mut [PixelSum<4>],
    /// Values beside colour; empty unless the scene wants them, and for samples other than the first.
    pub(crate) seen: &'a [AovSample],
    /// Rays traced.
    pub(crate) rays: RayCounts,
    /// Contributions left out because they were not numbers.
    pub(crate) nan_samples: u64,
}

/// Which tiles a thread paints, and when it stops.
pub(crate) trait Tiles {
    /// The next tile, or nothing if there are no more.
    fn next(&self) -> Option<Rect>;
    /// Whether to stop in the middle of a tile.
    fn cancelled(&self) -> bool;
    /// Takes a finished tile.
    fn done(&self, painted: Painted<'_>);
}

/// Renders samples of the pixels of tiles until there are no more tiles, on this thread.
///
/// **Needs:** `samples` begins with a block of [`SAMPLES_PER_BLOCK`], and ends with one or at the scene's last sample.
pub(crate) fn paint(scene: &Scene, samples: Range<u32>, tiles: &impl Tiles) {
    match scene.settings.tier {
        TierName::Fast => paint_tier::<Fast>(scene, samples, tiles),
        TierName::Watertight => paint_tier::<Watertight>(scene, samples, tiles),
        TierName::Exact => paint_tier::<Exact>(scene, samples, tiles),
    }
}

fn paint_tier<T: Tier>(scene: &Scene, samples: Range<u32>, tiles: &impl Tiles) {
    let Some(first) = tiles.next() else { return };
    let frame = Frame::new(scene);
    let mut painter = Painter::<T>::new(&frame, samples);
    let mut next = Some(first);
    while let Some(tile) = next {
        if !painter.render(tile, || tiles.cancelled()) {
            return;
        }
        tiles.done(painter.painted(tile));
        next = tiles.next();
    }
}

/// One thread's scratch.
struct Painter<'a, T: Tier> {
    worker: Worker<'a, T>,
    arenas: Vec<Bump>,
    pixels: Vec<[u32; 2]>,
    sums: Sums,
    weights: Vec<f32>,
    seen: Vec<AovSample>,
    samples: Range<u32>,
    nan_samples: u64,
}

impl<'a, T: Tier> Painter<'a, T> {
    fn new(frame: &'a Frame<'a>, samples: Range<u32>) -> Self {
        let scene = frame.scene;
        // One for the camera rays, one for each depth.
        let depths =
            if scene.requirements.children() == 0 { 1 } else { scene.settings.max_depth as usize + 1 };
        Self {
            worker: Worker {
                frame,
                stream: RayStream::new(&scene.accel),
                radiance: SampleSums::default(),
                rays: RayCounts::default(),
            },
            arenas: (0..=depths).map(|_| Bump::with_capacity(ARENA)).collect(),
            pixels: Vec::new(),
            sums: Vec::new(),
            weights: Vec::new(),
            seen: Vec::new(),
            samples,
            nan_samples: 0,
        }
    }

    /// What the last render gave.
    fn painted(&mut self, tile: Rect) -> Painted<'_> {
        Painted {
            tile,
            pixels: &self.pixels,
            sums: &mut self.sums,
            seen: &self.seen,
            rays: std::mem::take(&mut self.worker.rays),
            nan_samples: std::mem::take(&mut self.nan_samples),
        }
    }

    /// Renders all samples of a tile; false if cancelled before the end.
    fn render(&mut self, tile: Rect, cancelled: impl Fn() -> bool) -> bool {
        pixels(tile, &mut self.pixels);
        self.sums.resize_with(self.pixels.len(), PixelSum::default);
        let Range { start, end } = self.samples;
        self.sums.iter_mut().for_each(|sum| sum.reset(u64::from(start / SAMPLES_PER_BLOCK)));
        let per_wave = (CHUNK / self.pixels.len()).max(1) as u32;
        for first_sample in (start..end).step_by(per_wave as usize) {
            if cancelled() {
                return false;
            }
            self.render_samples(first_sample, per_wave.min(end - first_sample));
        }
        if start == 0 && self.worker.frame.scene.settings.aovs.needs_rays() {
            look(&mut self.worker, &self.pixels, &mut self.arenas, &mut self.seen);
        }
        true
    }

    fn render_samples(&mut self, first_sample: u32, samples: u32) {
        let wave = WaveSamples { pixels: &self.pixels, first_sample, samples };
        self.weights.clear();
        self.weights.resize(wave.len(), 1.0);
        let weights = &mut self.weights;
        run_wave(&mut self.worker, wave, &mut self.arenas, |slot, w: T::Real| weights[slot] = w.to_f32());
        self.nan_samples += self.worker.radiance.nan_count();
        let n = self.pixels.len();
        for slot in 0..wave.len() {
            let weight = self.weights[slot];
            let [r, g, b] = self.worker.radiance.rgb(slot);
            self.sums[slot % n].push([r * weight, g * weight, b * weight, weight]);
        }
    }
}
