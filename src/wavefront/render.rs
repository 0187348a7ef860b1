//! The door: a scene in, a film out.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use super::paint::{Painted, Tiles, paint};
use super::tile::{Rect, mean, tiles};
use super::wave::RayCounts;
use crate::film::{AovSet, Film};
use crate::scene::Scene;

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
/// The film has the size of that part, and the planes that the scene's settings ask for. Its bytes depend on the scene
/// alone: not on threads, nor on the crop.
///
/// **Errors:** [`RenderError`].
pub fn render(scene: &Scene, options: &RenderOptions) -> Result<(Film, RenderReport), RenderError> {
    let start = Instant::now();
    let part = part(scene, options.crop)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads).build()?;
    let shared = Shared::new(scene, part, options);
    pool.broadcast(|_| paint(scene, 0..scene.settings.spp, &shared));
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

/// What the threads of a render share.
struct Shared<'a> {
    part: Rect,
    aovs: AovSet,
    options: &'a RenderOptions<'a>,
    tiles: Vec<Rect>,
    tiles_taken: AtomicUsize,
    film: Mutex<(Film, RayCounts)>,
    pixels_done: AtomicU64,
    nan_samples: AtomicU64,
}

impl<'a> Shared<'a> {
    fn new(scene: &Scene, part: Rect, options: &'a RenderOptions<'a>) -> Self {
        let mut film = Film::new(part[2], part[3]);
        film.planes = scene.settings.aovs.planes(film.pixels.len());
        film.count_samples(scene.settings.spp);
        Self {
            part,
            aovs: scene.settings.aovs,
            options,
            tiles: tiles(part),
            tiles_taken: AtomicUsize::new(0),
            film: Mutex::new((film, RayCounts::default())),
            pixels_done: AtomicU64::new(0),
            nan_samples: AtomicU64::new(0),
        }
    }

    /// Writes a finished tile; gives the rays so far.
    fn store(&self, painted: &mut Painted) -> u64 {
        let mut shared = self.film.lock().expect("no thread panics while it writes");
        let (film, counts) = &mut *shared;
        for (k, (&[x, y], sum)) in painted.pixels.iter().zip(painted.sums.iter_mut()).enumerate() {
            let at = (y - self.part[1]) as usize * self.part[2] as usize + (x - self.part[0]) as usize;
            film.pixels[at] = mean(sum.total());
            if let Some(seen) = painted.seen.get(k) {
                seen.store(self.aovs, &mut film.planes, at);
            }
        }
        *counts = counts.plus(&painted.rays);
        counts.total()
    }

    fn finish(self) -> (Film, RayCounts, u64) {
        let (film, rays) = self.film.into_inner().expect("no thread panics while it writes");
        (film, rays, self.nan_samples.into_inner())
    }
}

impl Tiles for Shared<'_> {
    fn next(&self) -> Option<Rect> {
        self.tiles.get(self.tiles_taken.fetch_add(1, Ordering::Relaxed)).copied()
    }

    fn cancelled(&self) -> bool {
        self.options.cancel.is_some_and(|c| c.load(Ordering::Relaxed))
    }

    fn done(&self, mut painted: Painted<'_>) {
        self.nan_samples.fetch_add(painted.nan_samples, Ordering::Relaxed);
        let rays = self.store(&mut painted);
        let done = painted.pixels.len() as u64;
        let pixels_done = self.pixels_done.fetch_add(done, Ordering::Relaxed) + done;
        if let Some(progress) = self.options.progress {
            let pixels_total = u64::from(self.part[2]) * u64::from(self.part[3]);
            progress(Progress { pixels_done, pixels_total, rays });
        }
    }
}
