//! The door: a scene in, a film out.

use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use super::adaptive::{self, Goal, Reached};
use super::paint::{Scratch, paint};
use super::shared::{Finished, Shared};
use super::tile::Rect;
use super::wave::{Frame, RayCounts};
use crate::film::Film;
use crate::intersect::{Exact, Fast, TierName, Watertight};
use crate::scene::Scene;

/// How a scene is rendered; nothing here but `goal` changes the bytes of the pixels it renders.
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
    /// When pixels have samples enough; without it each gets all that the scene asks for.
    pub goal: Option<Goal>,
}

/// How far a render is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Pixels finished; under a time limit, such a share of them as of the time.
    pub pixels_done: u64,
    /// Pixels in all.
    pub pixels_total: u64,
    /// Rays traced.
    pub rays: u64,
}

/// What a render did.
#[derive(Clone, Copy, Debug, PartialEq)]
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
    /// How near the goal the picture came, where there was one.
    pub reached: Option<Reached>,
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
/// The film has the size of that part, and the planes that the scene's settings ask for. Its bytes depend on the scene alone: not on threads, nor on the crop. With a goal of
/// `max_error` they depend on that too, and with one of `time_limit` on the machine.
///
/// **Errors:** [`RenderError`].
pub fn render(scene: &Scene, options: &RenderOptions) -> Result<(Film, RenderReport), RenderError> {
    let start = Instant::now();
    let part = part(scene, options.crop)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads).build()?;
    let shared = Shared::new(scene, part, options);
    let reached = match options.goal {
        None => {
            pool.broadcast(|_| paint(scene, 0..scene.settings.spp, &shared, &mut Scratch::default()));
            None
        }
        Some(goal) => Some(pool.install(|| match scene.settings.tier {
            TierName::Fast => adaptive::render::<Fast>(&Frame::new(scene), &shared, goal, start),
            TierName::Watertight => adaptive::render::<Watertight>(&Frame::new(scene), &shared, goal, start),
            TierName::Exact => adaptive::render::<Exact>(&Frame::new(scene), &shared, goal, start),
        })),
    };
    if shared.is_cancelled() {
        return Err(RenderError::Cancelled);
    }
    let threads = pool.current_num_threads();
    let Finished { film, rays, samples, nan_samples } = shared.finish();
    Ok((film, RenderReport { rays, samples, nan_samples, render_time: start.elapsed(), threads, reached }))
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
