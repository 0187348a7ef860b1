//! What the stages of one worker share.

use wide::u32x8;

use crate::accel::stream::{Apex, RayStream};
use crate::film::SampleSums;
use crate::intersect::Tier;
use crate::math::{WIDTH, eight};
use crate::sampling::{FilterSampler, Sampler};
use crate::scene::{Scatter, Scene};

use super::queue::PathNeeds;

/// Rays traced, by their reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayCounts {
    /// From the camera.
    pub camera: u64,
    /// Towards lights.
    pub shadow: u64,
    /// Mirrored.
    pub reflected: u64,
    /// Refracted.
    pub refracted: u64,
    /// Scattered at random.
    pub diffuse: u64,
}

impl RayCounts {
    /// All of them.
    pub fn total(&self) -> u64 {
        self.camera + self.shadow + self.reflected + self.refracted + self.diffuse
    }
    /// The sum by reason.
    pub fn plus(&self, o: &Self) -> Self {
        Self {
            camera: self.camera + o.camera,
            shadow: self.shadow + o.shadow,
            reflected: self.reflected + o.reflected,
            refracted: self.refracted + o.refracted,
            diffuse: self.diffuse + o.diffuse,
        }
    }
}

/// What a worker did.
#[derive(Clone, Copy, Default)]
pub(crate) struct WaveCounts {
    /// Rays traced.
    pub(crate) rays: RayCounts,
    /// Camera samples.
    pub(crate) samples: u64,
    /// Contributions left out because they were not numbers.
    pub(crate) nan_samples: u64,
}

/// Which samples a wave holds: slot `k * pixels.len() + p` is sample `first_sample + k` of pixel `p`.
#[derive(Clone, Copy)]
pub(super) struct WaveSamples<'a> {
    pub(super) pixels: &'a [[u32; 2]],
    pub(super) first_sample: u32,
    pub(super) samples: u32,
}

impl WaveSamples<'_> {
    pub(super) fn len(&self) -> usize {
        self.pixels.len() * self.samples as usize
    }
    /// Pixels and sample numbers of the slots from `at` on, by column; the last pixel stands in beyond the end.
    #[inline(always)]
    pub(super) fn eight_slots(&self, at: usize) -> [u32x8; 3] {
        let (pixel, sample) = (at % self.pixels.len(), self.first_sample + (at / self.pixels.len()) as u32);
        match self.pixels[pixel..].first_chunk::<WIDTH>() {
            Some(run) => {
                [u32x8::new(eight(|i| run[i][0])), u32x8::new(eight(|i| run[i][1])), u32x8::splat(sample)]
            }
            None => self.slots_around(pixel, sample),
        }
    }

    /// The same where the pixels end and begin again.
    #[inline(never)]
    fn slots_around(&self, mut pixel: usize, mut sample: u32) -> [u32x8; 3] {
        let slots = eight(|_| {
            let slot = (self.pixels[pixel], sample);
            pixel += 1;
            if pixel == self.pixels.len() {
                (pixel, sample) = (0, sample + 1);
            }
            slot
        });
        [eight(|i| slots[i].0[0]), eight(|i| slots[i].0[1]), eight(|i| slots[i].1)].map(u32x8::new)
    }
    /// Pixel and sample number of a slot.
    #[inline(always)]
    pub(super) fn of_slot(&self, slot: u32) -> ([u32; 2], u32) {
        let n = self.pixels.len() as u32;
        (self.pixels[(slot % n) as usize], self.first_sample + slot / n)
    }
}

/// What does not change while a picture is rendered.
pub(super) struct Frame<'a> {
    pub(super) scene: &'a Scene,
    pub(super) sampler: Sampler,
    pub(super) filter: FilterSampler,
    /// What camera rays have in common.
    pub(super) apex: Option<Apex>,
}

impl<'a> Frame<'a> {
    pub(super) fn new(scene: &'a Scene) -> Self {
        let s = &scene.settings;
        Self {
            scene,
            sampler: Sampler::new(s.sampler, s.spp, s.seed),
            filter: s.filter.sampler(),
            apex: scene.camera.apex(),
        }
    }
    /// What camera rays need.
    pub(super) fn path_needs(&self) -> PathNeeds {
        let r = &self.scene.requirements;
        PathNeeds {
            medium: r.scatters(Scatter::Dielectric),
            branch: r.scatters(Scatter::Diffuse),
            t_min: self.scene.camera.near > 0.0,
        }
    }
    /// What paths beyond the first surface need.
    pub(super) fn secondary_needs(&self) -> PathNeeds {
        PathNeeds { t_min: false, ..self.path_needs() }
    }
}

/// What a worker adds to while it goes through waves.
pub(super) struct Worker<'a, T: Tier> {
    pub(super) frame: &'a Frame<'a>,
    pub(super) stream: RayStream<'a, T>,
    /// Radiance of each slot of the wave.
    pub(super) radiance: SampleSums,
    pub(super) rays: RayCounts,
}
