//! What the workers of a render share: the picture and the counts.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use super::render::{Progress, RenderOptions};
use super::tile::{Rect, mean};
use super::wave::{RayCounts, WaveCounts};
use crate::film::Film;

/// What the workers of a render share.
pub(super) struct Shared<'a> {
    pub(super) part: Rect,
    options: &'a RenderOptions<'a>,
    film: Mutex<(Film, RayCounts)>,
    pixels_done: AtomicU64,
    nan_samples: AtomicU64,
}

impl<'a> Shared<'a> {
    pub(super) fn new(part: Rect, options: &'a RenderOptions<'a>) -> Self {
        Self {
            part,
            options,
            film: Mutex::new((Film::new(part[2], part[3]), RayCounts::default())),
            pixels_done: AtomicU64::new(0),
            nan_samples: AtomicU64::new(0),
        }
    }

    pub(super) fn is_cancelled(&self) -> bool {
        self.options.cancel.is_some_and(|c| c.load(Ordering::Relaxed))
    }

    pub(super) fn pixels_total(&self) -> u64 {
        u64::from(self.part[2]) * u64::from(self.part[3])
    }

    /// Takes note of what waves did; gives the rays so far.
    pub(super) fn count(&self, counts: WaveCounts) -> u64 {
        self.nan_samples.fetch_add(counts.nan_samples, Ordering::Relaxed);
        let mut shared = self.film.lock().expect("no worker panics while it writes");
        shared.1 = shared.1.plus(&counts.rays);
        shared.1.total()
    }

    /// Writes pixels, given with the sums of their samples.
    pub(super) fn store(&self, pixels: &[[u32; 2]], totals: impl Iterator<Item = [f32; 4]>) {
        let film = &mut self.film.lock().expect("no worker panics while it writes").0;
        for (&[x, y], total) in pixels.iter().zip(totals) {
            let at = (y - self.part[1]) as usize * self.part[2] as usize + (x - self.part[0]) as usize;
            film.pixels[at] = mean(total);
        }
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

    pub(super) fn finish(self) -> (Film, RayCounts, u64) {
        let (film, rays) = self.film.into_inner().expect("no worker panics while it writes");
        (film, rays, self.nan_samples.into_inner())
    }
}
