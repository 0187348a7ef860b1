//! One thread's scratch: waves in, weighted samples out.

use super::aov::look;
use super::arena::Arena;
use super::run::run_wave;
use super::wave::{Frame, RayCounts, WaveCounts, WaveSamples, Worker};
use crate::accel::stream::RayStream;
use crate::film::{AovSample, SampleSums};
use crate::intersect::Tier;
use crate::math::{Real, WIDTH};

/// Bytes that a full queue with all its columns hardly exceeds; those that stay untouched cost nothing.
const ARENA: usize = 1 << 20;
/// Depths that paths often reach; arenas beyond grow as they are needed.
const USUAL: usize = 16;

/// One thread's scratch.
pub(super) struct WaveRunner<'a, T: Tier> {
    worker: Worker<'a, T>,
    arenas: Vec<Arena>,
    weights: Vec<f32>,
    samples: u64,
    nan_samples: u64,
}

impl<'a, T: Tier> WaveRunner<'a, T> {
    pub(super) fn new(frame: &'a Frame<'a>) -> Self {
        Self::with_arenas(frame, Vec::new())
    }

    /// The same with arenas of another one, whose memory the system has already given.
    pub(super) fn with_arenas(frame: &'a Frame<'a>, mut arenas: Vec<Arena>) -> Self {
        let scene = frame.scene;
        // One for the camera rays, one for each depth.
        let depths =
            if scene.requirements.children() == 0 { 1 } else { scene.settings.max_depth as usize + 1 };
        while arenas.len() <= depths {
            let deep = arenas.len() > USUAL;
            arenas.push(if deep { Arena::default() } else { Arena::with_capacity(ARENA) });
        }
        Self {
            worker: Worker {
                frame,
                stream: RayStream::new(&scene.accel),
                radiance: SampleSums::default(),
                rays: RayCounts::default(),
            },
            arenas,
            weights: Vec::new(),
            samples: 0,
            nan_samples: 0,
        }
    }

    /// The arenas, for another one.
    pub(super) fn into_arenas(self) -> Vec<Arena> {
        self.arenas
    }

    /// Traces a wave; gives each slot and its sample (three channels times the weight, and the weight), sample by sample.
    #[inline(always)]
    pub(super) fn run(&mut self, wave: WaveSamples, mut take: impl FnMut(usize, [f32; 4])) {
        self.weights.clear();
        self.weights.resize(wave.len(), 1.0);
        let weights = &mut self.weights;
        run_wave(&mut self.worker, wave, &mut self.arenas, |slot, w: T::Real| weights[slot] = w.to_f32());
        self.samples += wave.len() as u64;
        self.nan_samples += self.worker.radiance.nan_count();
        for first in (0..wave.len()).step_by(WIDTH) {
            let [r, g, b] = self.worker.radiance.eight(first);
            for (i, &weight) in self.weights[first..].iter().take(WIDTH).enumerate() {
                take(first + i, [r[i] * weight, g[i] * weight, b[i] * weight, weight]);
            }
        }
    }

    /// Looks for the values beside colour of pixels, if the scene wants any: a sample for each, or none at all.
    pub(super) fn look(&mut self, pixels: &[[u32; 2]], seen: &mut Vec<AovSample>) {
        seen.clear();
        if self.worker.frame.scene.settings.aovs.needs_rays() {
            look(&mut self.worker, pixels, &mut self.arenas, seen);
        }
    }

    /// What was done since the last call.
    pub(super) fn take_counts(&mut self) -> WaveCounts {
        WaveCounts {
            rays: std::mem::take(&mut self.worker.rays),
            samples: std::mem::take(&mut self.samples),
            nan_samples: std::mem::take(&mut self.nan_samples),
        }
    }
}
