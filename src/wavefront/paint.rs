//! One thread's way through tiles: all samples of a tile's pixels, then the next tile.

use std::ops::Range;

use super::arena::Arena;
use super::run::CHUNK;
use super::tile::{Rect, Sums, pixels};
use super::wave::{Frame, WaveCounts, WaveSamples};
use super::wave_runner::WaveRunner;
use crate::film::{AovSample, PixelSum, SAMPLES_PER_BLOCK};
use crate::intersect::{Exact, Fast, Tier, TierName, Watertight};
use crate::scene::Scene;

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
    /// What it took.
    pub(crate) counts: WaveCounts,
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

/// One thread's memory, to be kept for its next picture: the system gives pages slowly.
#[derive(Default)]
pub(crate) struct Scratch {
    arenas: Vec<Arena>,
    pixels: Vec<[u32; 2]>,
    sums: Sums,
    seen: Vec<AovSample>,
}

/// Renders samples of the pixels of tiles until there are no more tiles, on this thread.
///
/// **Needs:** `samples` begins with a block of [`SAMPLES_PER_BLOCK`], and ends with one or at the scene's last sample.
pub(crate) fn paint(scene: &Scene, samples: Range<u32>, tiles: &impl Tiles, scratch: &mut Scratch) {
    match scene.settings.tier {
        TierName::Fast => paint_tier::<Fast>(scene, samples, tiles, scratch),
        TierName::Watertight => paint_tier::<Watertight>(scene, samples, tiles, scratch),
        TierName::Exact => paint_tier::<Exact>(scene, samples, tiles, scratch),
    }
}

fn paint_tier<T: Tier>(scene: &Scene, samples: Range<u32>, tiles: &impl Tiles, scratch: &mut Scratch) {
    let Some(first) = tiles.next() else { return };
    let frame = Frame::new(scene);
    let mut painter = Painter::<T>::new(&frame, samples, std::mem::take(scratch));
    let mut next = Some(first);
    while let Some(tile) = next {
        if !painter.render(tile, || tiles.cancelled()) {
            break;
        }
        tiles.done(painter.painted(tile));
        next = tiles.next();
    }
    *scratch = painter.into_scratch();
}

/// One thread at one picture.
struct Painter<'a, T: Tier> {
    waves: WaveRunner<'a, T>,
    samples: Range<u32>,
    pixels: Vec<[u32; 2]>,
    sums: Sums,
    seen: Vec<AovSample>,
}

impl<'a, T: Tier> Painter<'a, T> {
    fn new(frame: &'a Frame<'a>, samples: Range<u32>, scratch: Scratch) -> Self {
        let Scratch { arenas, pixels, sums, seen } = scratch;
        Self { waves: WaveRunner::with_arenas(frame, arenas), samples, pixels, sums, seen }
    }

    fn into_scratch(self) -> Scratch {
        Scratch { arenas: self.waves.into_arenas(), pixels: self.pixels, sums: self.sums, seen: self.seen }
    }

    /// What the last render gave.
    fn painted(&mut self, tile: Rect) -> Painted<'_> {
        let counts = self.waves.take_counts();
        Painted { tile, pixels: &self.pixels, sums: &mut self.sums, seen: &self.seen, counts }
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
        if start == 0 {
            self.waves.look(&self.pixels, &mut self.seen);
        }
        true
    }

    fn render_samples(&mut self, first_sample: u32, samples: u32) {
        let sums = &mut self.sums;
        let wave = WaveSamples { pixels: &self.pixels, first_sample, samples };
        // Slots count pixels, over and over.
        let mut pixel = 0;
        self.waves.run(wave, |_, sample| {
            sums[pixel].push(sample);
            pixel = if pixel + 1 == sums.len() { 0 } else { pixel + 1 };
        });
    }
}
