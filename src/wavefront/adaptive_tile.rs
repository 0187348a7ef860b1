//! One tile of a picture whose pixels get as many samples as they need.

use std::time::Instant;

use super::run::CHUNK;
use super::shared::Shared;
use super::tile::{Rect, pixels};
use super::wave::WaveSamples;
use super::wave_runner::WaveRunner;
use crate::film::{PixelSum, Spread};
use crate::intersect::Tier;

/// Samples that an estimate of the error needs to be trusted.
const FEWEST: u32 = 16;

/// When a render ends.
pub(super) struct Limits {
    /// Pixels with no larger an error are done.
    pub(super) max_error: Option<f64>,
    pub(super) deadline: Option<Instant>,
    pub(super) start: Instant,
    /// Most samples of a pixel.
    pub(super) spp: u32,
}

impl Limits {
    pub(super) fn is_late(&self) -> bool {
        self.deadline.is_some_and(|deadline| Instant::now() >= deadline)
    }

    /// How much of the time has passed.
    pub(super) fn share_of_time(&self) -> f64 {
        let whole = self.deadline.map_or(0.0, |deadline| (deadline - self.start).as_secs_f64());
        if whole > 0.0 { (self.start.elapsed().as_secs_f64() / whole).min(1.0) } else { 1.0 }
    }

    fn is_enough(&self, spread: &Spread) -> bool {
        let small = |max_error| spread.variance() <= max_error * max_error;
        spread.samples() >= FEWEST && self.max_error.is_some_and(small)
    }

    /// Samples after the round that begins with `done`: half as many again, by powers of two, which suit Sobol points.
    fn next(&self, done: u32) -> u32 {
        let step = match done {
            0 if self.deadline.is_none() => FEWEST,
            0 => 1,
            done => (1 << done.ilog2()) / 2,
        };
        done.saturating_add(step.max(1)).min(self.spp)
    }
}

/// A pixel as it grows.
#[derive(Default)]
struct Pixel {
    sum: PixelSum<4>,
    spread: Spread,
}

/// The pixels of a tile, and which of them go on.
pub(super) struct TileState {
    pixels: Vec<[u32; 2]>,
    states: Vec<Pixel>,
    /// Rows of the pixels that go on, and where they lie.
    active: Vec<u32>,
    wave: Vec<[u32; 2]>,
    /// Samples that each of them has.
    done: u32,
}

impl TileState {
    pub(super) fn new(tile: Rect) -> Self {
        let mut list = Vec::new();
        pixels(tile, &mut list);
        let states = list.iter().map(|_| Pixel::default()).collect();
        Self { active: (0..list.len() as u32).collect(), wave: list.clone(), pixels: list, states, done: 0 }
    }

    pub(super) fn pixels(&self) -> &[[u32; 2]] {
        &self.pixels
    }

    /// Gives the pixels that go on some more samples, at least one in the first round, until `stop` says so; true if there
    /// is more to do.
    pub(super) fn round<T: Tier>(
        &mut self,
        waves: &mut WaveRunner<T>,
        limits: &Limits,
        stop: &dyn Fn() -> bool,
    ) -> bool {
        let end = limits.next(self.done);
        while self.done < end && !self.active.is_empty() && (self.done == 0 || !stop()) {
            let per_wave = (CHUNK / self.active.len()).max(1) as u32;
            self.samples(waves, per_wave.min(end - self.done));
        }
        if self.done == end {
            self.retire(limits);
        }
        self.done < limits.spp && !self.active.is_empty()
    }

    fn samples<T: Tier>(&mut self, waves: &mut WaveRunner<T>, samples: u32) {
        let (states, active, n) = (&mut self.states, &self.active, self.active.len());
        let wave = WaveSamples { pixels: &self.wave, first_sample: self.done, samples };
        waves.run(wave, |slot, sample| {
            let pixel = &mut states[active[slot % n] as usize];
            pixel.sum.push(sample);
            pixel.spread.push(sample);
        });
        self.done += samples;
    }

    /// Lets go of pixels that have enough.
    fn retire(&mut self, limits: &Limits) {
        let (states, pixels) = (&self.states, &self.pixels);
        self.active.retain(|&row| !limits.is_enough(&states[row as usize].spread));
        self.wave.clear();
        self.wave.extend(self.active.iter().map(|&row| pixels[row as usize]));
    }

    /// Writes the pixels, and says how good they are.
    pub(super) fn finish<T: Tier>(
        mut self,
        waves: &mut WaveRunner<T>,
        shared: &Shared,
        limits: &Limits,
    ) -> TileTally {
        let mut seen = Vec::new();
        waves.look(&self.pixels, &mut seen);
        shared.count(waves.take_counts());
        shared.store(&self.pixels, self.states.iter_mut().map(|pixel| pixel.sum.total()), &seen);
        let spreads = || self.states.iter().map(|pixel| &pixel.spread);
        shared.store_counts(&self.pixels, spreads().map(Spread::samples));
        TileTally {
            pixels: self.states.len() as u64,
            variance: spreads().map(Spread::variance).sum(),
            pixels_above: spreads().filter(|spread| !limits.is_enough(spread)).count() as u64,
            samples: [
                spreads().map(Spread::samples).min().unwrap_or(0),
                spreads().map(Spread::samples).max().unwrap_or(0),
            ],
        }
    }
}

/// How good the pixels of a tile are.
pub(super) struct TileTally {
    pub(super) pixels: u64,
    /// Sum over pixels.
    pub(super) variance: f64,
    pub(super) pixels_above: u64,
    /// Fewest and most.
    pub(super) samples: [u32; 2],
}
