//! The door: a scene in, a film out.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use bumpalo::Bump;
use rayon::prelude::*;

use super::run::{CHUNK, run_wave};
use super::tile::{Rect, Sums, mean, pixels, tiles};
use super::wave::{Frame, RayCounts, WaveSamples, Worker};
use crate::accel::stream::RayStream;
use crate::film::{Film, PixelSum, SampleSums};
use crate::intersect::{Exact, Fast, Tier, TierName, Watertight};
use crate::math::Real;
use crate::scene::Scene;

/// Bytes that a full queue with all its columns hardly exceeds; those that stay untouched cost nothing.
const ARENA: usize = 1 << 20;

/// How a scene is rendered; nothing here changes the bytes of the pixels it renders.
#[derive(Clone, Copy, Default)]
pub struct RenderOptions<'a> {
    /// Worker threads; 0 takes as many as this process may use.
    pub threads: usize,
    /// Left, top, width and height of the part to render; its pixels are those of the whole picture.
    pub crop: Option<[u32; 4]>,
    /// Called after each tile, from any thread.
    pub progress: Option<&'a (dyn Fn(Progress) + Sync)>,
    /// Rendering stops soon after this turns true.
    pub cancel: Option<&'a AtomicBool>,
}

/// How far a render is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Pixels finished.
    pub pixels_done: u64,
    /// Pixels in all.
    pub pixels_total: u64,
    /// Rays traced.
    pub rays: u64,
}

/// What a render did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderReport {
    /// Rays by their reason.
    pub rays: RayCounts,
    /// Camera samples.
    pub samples: u64,
    /// Contributions left out because they were not numbers.
    pub nan_samples: u64,
    /// Wall time.
    pub render_time: Duration,
    /// Worker threads.
    pub threads: usize,
}

/// Why there is no film.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// `cancel` turned true.
    #[error("cancelled")]
    Cancelled,
    /// The crop reaches beyond the picture, or is empty.
    #[error("crop {crop:?} does not lie within the picture of {size:?} pixels")]
    Crop {
        /// As asked.
        crop: [u32; 4],
        /// Size of the picture.
        size: [u32; 2],
    },
    /// Worker threads could not be started.
    #[error("worker threads cannot be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// Renders a scene, or the part of it that `options.crop` names.
///
/// The film has the size of that part. Its bytes depend on the scene alone: not on threads, nor on the crop.
///
/// **Errors:** [`RenderError`].
pub fn render(scene: &Scene, options: &RenderOptions) -> Result<(Film, RenderReport), RenderError> {
    match scene.settings.tier {
        TierName::Fast => render_tier::<Fast>(scene, options),
        TierName::Watertight => render_tier::<Watertight>(scene, options),
        TierName::Exact => render_tier::<Exact>(scene, options),
    }
}

fn render_tier<T: Tier>(scene: &Scene, options: &RenderOptions) -> Result<(Film, RenderReport), RenderError> {
    let start = Instant::now();
    let part = part(scene, options.crop)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads).build()?;
    let frame = Frame::new(scene);
    let shared = Shared::new(part, options);
    pool.install(|| {
        tiles(part)
            .into_par_iter()
            .for_each_init(|| TileWorker::<T>::new(&frame), |worker, tile| shared.render(worker, tile))
    });
    if options.cancel.is_some_and(|c| c.load(Ordering::Relaxed)) {
        return Err(RenderError::Cancelled);
    }
    let (film, rays, nan_samples) = shared.finish();
    let samples = film.pixels.len() as u64 * u64::from(scene.settings.spp);
    let threads = pool.current_num_threads();
    Ok((film, RenderReport { rays, samples, nan_samples, render_time: start.elapsed(), threads }))
}

fn part(scene: &Scene, crop: Option<[u32; 4]>) -> Result<Rect, RenderError> {
    let size @ [width, height] = scene.settings.size;
    let crop = crop.unwrap_or([0, 0, width, height]);
    let fits = |from: u32, length: u32, whole: u32| {
        length > 0 && from.checked_add(length).is_some_and(|end| end <= whole)
    };
    let inside = fits(crop[0], crop[2], width) && fits(crop[1], crop[3], height);
    if inside { Ok(crop) } else { Err(RenderError::Crop { crop, size }) }
}

/// What the workers of a render share.
struct Shared<'a> {
    part: Rect,
    options: &'a RenderOptions<'a>,
    film: Mutex<(Film, RayCounts)>,
    pixels_done: AtomicU64,
    nan_samples: AtomicU64,
}

impl<'a> Shared<'a> {
    fn new(part: Rect, options: &'a RenderOptions<'a>) -> Self {
        Self {
            part,
            options,
            film: Mutex::new((Film::new(part[2], part[3]), RayCounts::default())),
            pixels_done: AtomicU64::new(0),
            nan_samples: AtomicU64::new(0),
        }
    }

    fn is_cancelled(&self) -> bool {
        self.options.cancel.is_some_and(|c| c.load(Ordering::Relaxed))
    }

    fn render<T: Tier>(&self, tile_worker: &mut TileWorker<T>, tile: Rect) {
        if !tile_worker.render(tile, || self.is_cancelled()) {
            return;
        }
        let rays = std::mem::take(&mut tile_worker.worker.rays);
        self.nan_samples.fetch_add(tile_worker.take_nans(), Ordering::Relaxed);
        let total = self.store(tile_worker, rays);
        let done = tile_worker.pixels.len() as u64;
        let pixels_done = self.pixels_done.fetch_add(done, Ordering::Relaxed) + done;
        if let Some(progress) = self.options.progress {
            let pixels_total = u64::from(self.part[2]) * u64::from(self.part[3]);
            progress(Progress { pixels_done, pixels_total, rays: total });
        }
    }

    /// Writes a finished tile; gives the rays so far.
    fn store<T: Tier>(&self, tile: &mut TileWorker<T>, rays: RayCounts) -> u64 {
        let mut shared = self.film.lock().expect("no worker panics while it writes");
        let (film, counts) = &mut *shared;
        for (&[x, y], sum) in tile.pixels.iter().zip(&mut tile.sums) {
            let at = (y - self.part[1]) as usize * self.part[2] as usize + (x - self.part[0]) as usize;
            film.pixels[at] = mean(sum.total());
        }
        *counts = counts.plus(&rays);
        counts.total()
    }

    fn finish(self) -> (Film, RayCounts, u64) {
        let (film, rays) = self.film.into_inner().expect("no worker panics while it writes");
        (film, rays, self.nan_samples.into_inner())
    }
}

/// One thread's scratch.
struct TileWorker<'a, T: Tier> {
    worker: Worker<'a, T>,
    arenas: Vec<Bump>,
    pixels: Vec<[u32; 2]>,
    sums: Sums,
    weights: Vec<f32>,
    nan_samples: u64,
}

impl<'a, T: Tier> TileWorker<'a, T> {
    fn new(frame: &'a Frame<'a>) -> Self {
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
            nan_samples: 0,
        }
    }

    fn take_nans(&mut self) -> u64 {
        std::mem::take(&mut self.nan_samples)
    }

    /// Renders all samples of a tile; false if cancelled before the end.
    fn render(&mut self, tile: Rect, cancelled: impl Fn() -> bool) -> bool {
        pixels(tile, &mut self.pixels);
        self.sums.resize_with(self.pixels.len(), PixelSum::default);
        self.sums.iter_mut().for_each(|sum| sum.reset(0));
        let spp = self.worker.frame.scene.settings.spp;
        let per_wave = (CHUNK / self.pixels.len()).max(1) as u32;
        for first_sample in (0..spp).step_by(per_wave as usize) {
            if cancelled() {
                return false;
            }
            self.render_samples(first_sample, per_wave.min(spp - first_sample));
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
