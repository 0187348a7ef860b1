//! The same number of samples for every pixel, tile by tile.

use super::run::CHUNK;
use super::shared::Shared;
use super::tile::{Rect, Sums, pixels};
use super::wave::{Frame, WaveSamples};
use super::wave_runner::WaveRunner;
use crate::film::PixelSum;
use crate::intersect::Tier;

/// One thread's scratch.
pub(super) struct TileWorker<'a, T: Tier> {
    waves: WaveRunner<'a, T>,
    pixels: Vec<[u32; 2]>,
    sums: Sums,
}

impl<'a, T: Tier> TileWorker<'a, T> {
    pub(super) fn new(frame: &'a Frame<'a>) -> Self {
        Self { waves: WaveRunner::new(frame), pixels: Vec::new(), sums: Vec::new() }
    }

    /// Renders all samples of a tile, unless the render is cancelled before the end.
    pub(super) fn render(&mut self, tile: Rect, shared: &Shared) {
        pixels(tile, &mut self.pixels);
        self.sums.resize_with(self.pixels.len(), PixelSum::default);
        self.sums.iter_mut().for_each(|sum| sum.reset(0));
        let spp = self.waves.spp();
        let per_wave = (CHUNK / self.pixels.len()).max(1) as u32;
        for first_sample in (0..spp).step_by(per_wave as usize) {
            if shared.is_cancelled() {
                return;
            }
            self.render_samples(first_sample, per_wave.min(spp - first_sample));
        }
        let rays = shared.count(self.waves.take_counts());
        shared.store(&self.pixels, self.sums.iter_mut().map(PixelSum::total));
        shared.advance(self.pixels.len() as u64, rays);
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
