//! What the threads of a render share: the picture and the counts.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

use super::paint::{Painted, Tiles};
use super::render::{Progress, RenderOptions};
use super::tile::{Rect, mean, tiles};
use super::wave::{RayCounts, WaveCounts};
use crate::film::{AovSample, AovSet, Film, PixelSum};
use crate::scene::Scene;

/// What the threads of a render share.
pub(super) struct Shared<'a> {
    pub(super) part: Rect,
    pub(super) tiles: Vec<Rect>,
    aovs: AovSet,
    options: &'a RenderOptions<'a>,
    tiles_taken: AtomicUsize,
    film: Mutex<(Film, WaveCounts)>,
    pixels_done: AtomicU64,
}

/// A finished picture.
pub(super) struct Finished {
    pub(super) film: Film,
    pub(super) rays: RayCounts,
    pub(super) samples: u64,
    pub(super) nan_samples: u64,
}

impl<'a> Shared<'a> {
    pub(super) fn new(scene: &Scene, part: Rect, options: &'a RenderOptions<'a>) -> Self {
        let mut film = Film::new(part[2], part[3]);
        film.planes = scene.settings.aovs.planes(film.pixels.len());
        if let Some(counts) = film.sample_counts() {
            counts.fill(scene.settings.spp);
        }
        Self {
            part,
            tiles: tiles(part),
            aovs: scene.settings.aovs,
            options,
            tiles_taken: AtomicUsize::new(0),
            film: Mutex::new((film, WaveCounts::default())),
            pixels_done: AtomicU64::new(0),
        }
    }

    pub(super) fn is_cancelled(&self) -> bool {
        self.options.cancel.is_some_and(|c| c.load(Ordering::Relaxed))
    }

    pub(super) fn pixels_total(&self) -> u64 {
        u64::from(self.part[2]) * u64::from(self.part[3])
    }

    /// Takes note of what waves did; gives the rays so far.
    pub(super) fn count(&self, more: WaveCounts) -> u64 {
        let counts = &mut self.film.lock().expect("no thread panics while it writes").1;
        *counts = WaveCounts {
            rays: counts.rays.plus(&more.rays),
            samples: counts.samples + more.samples,
            nan_samples: counts.nan_samples + more.nan_samples,
        };
        counts.rays.total()
    }

    /// Writes pixels: sums of their samples, and what they see if the scene wants that.
    pub(super) fn store(
        &self,
        pixels: &[[u32; 2]],
        totals: impl Iterator<Item = [f32; 4]>,
        seen: &[AovSample],
    ) {
        let film = &mut self.film.lock().expect("no thread panics while it writes").0;
        for (k, (&pixel, total)) in pixels.iter().zip(totals).enumerate() {
            let at = self.place(pixel);
            film.pixels[at] = mean(total);
            if let Some(seen) = seen.get(k) {
                seen.store(self.aovs, &mut film.planes, at);
            }
        }
    }

    /// Writes how many samples pixels have, where that is not what the scene says.
    pub(super) fn store_counts(&self, pixels: &[[u32; 2]], counts: impl Iterator<Item = u32>) {
        let film = &mut self.film.lock().expect("no thread panics while it writes").0;
        if let Some(plane) = film.sample_counts() {
            pixels.iter().zip(counts).for_each(|(&pixel, count)| plane[self.place(pixel)] = count);
        }
    }

    fn place(&self, [x, y]: [u32; 2]) -> usize {
        (y - self.part[1]) as usize * self.part[2] as usize + (x - self.part[0]) as usize
    }

    /// Takes note of finished pixels and says how far the render is.
    pub(super) fn advance(&self, pixels: u64, rays: u64) {
        let pixels_done = self.pixels_done.fetch_add(pixels, Ordering::Relaxed) + pixels;
        self.say(pixels_done, rays);
    }

    /// Says how far the render is.
    pub(super) fn say(&self, pixels_done: u64, rays: u64) {
        if let Some(progress) = self.options.progress {
            progress(Progress { pixels_done, pixels_total: self.pixels_total(), rays });
        }
    }

    pub(super) fn finish(self) -> Finished {
        let (film, WaveCounts { rays, samples, nan_samples }) =
            self.film.into_inner().expect("no thread panics while it writes");
        Finished { film, rays, samples, nan_samples }
    }
}

impl Tiles for Shared<'_> {
    fn next(&self) -> Option<Rect> {
        self.tiles.get(self.tiles_taken.fetch_add(1, Ordering::Relaxed)).copied()
    }

    fn cancelled(&self) -> bool {
        self.is_cancelled()
    }

    fn done(&self, painted: Painted<'_>) {
        let rays = self.count(painted.counts);
        self.store(painted.pixels, painted.sums.iter_mut().map(PixelSum::total), painted.seen);
        self.advance(painted.pixels.len() as u64, rays);
    }
}
