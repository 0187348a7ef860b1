//! Samples until a pixel is good enough, or until time is up.
//!
//! Pixels get samples in rounds. After each round a pixel whose own samples say that it is near enough its mean gets no
//! more: nothing that other pixels, threads or tiles do plays a part, so a goal of `max_error` alone gives the same bytes
//! everywhere. Under a time limit, the rounds go over the whole picture and end wherever they are.

use std::time::{Duration, Instant};

use rayon::prelude::*;

use super::adaptive_tile::{Limits, TileState, TileTally};
use super::shared::Shared;
use super::wave::Frame;
use super::wave_runner::WaveRunner;
use crate::intersect::Tier;

/// When pixels have samples enough. The scene's `spp` is then the most that a pixel gets.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Goal {
    /// Pixels whose estimated error is no larger get no more samples. **Units:** linear light; the root of the mean square over
    /// channels, so that the picture's root mean squared error is estimated to be no larger either.
    pub max_error: Option<f64>,
    /// Rendering ends after this time, but not before each pixel has a sample.
    pub time_limit: Option<Duration>,
}

/// How near the goal a render came.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reached {
    /// Estimated root mean squared error of the picture; infinite where a pixel has too few samples to tell.
    pub rmse_estimate: f64,
    /// Pixels whose estimated error is larger than was asked for, if anything was.
    pub pixels_above: Option<u64>,
    /// Samples of the pixels that have fewest and most.
    pub samples: [u32; 2],
    /// Whether the time limit was over before each pixel had its first sample, which it got all the same.
    pub first_sample_late: bool,
}

/// Renders the part of the picture that is asked for, until the goal is reached or the render cancelled.
pub(super) fn render<T: Tier>(frame: &Frame, shared: &Shared, goal: Goal, start: Instant) -> Reached {
    let limits = Limits {
        max_error: goal.max_error,
        // A limit beyond the end of time is none.
        deadline: goal.time_limit.and_then(|limit| start.checked_add(limit)),
        start,
        spp: frame.scene.settings.spp,
    };
    match limits.deadline {
        None => reached(&tile_by_tile::<T>(frame, shared, &limits), &limits, false),
        Some(_) => round_by_round::<T>(frame, shared, &limits),
    }
}

/// Finishes a tile before the next: what is kept of each is small.
fn tile_by_tile<T: Tier>(frame: &Frame, shared: &Shared, limits: &Limits) -> Vec<TileTally> {
    let finish = |waves: &mut WaveRunner<T>, tile| {
        let mut state = TileState::new(tile);
        while !shared.is_cancelled() && state.round(waves, limits, &|| shared.is_cancelled()) {}
        let rays = shared.count(waves.take_counts());
        shared.advance(state.pixels().len() as u64, rays);
        state.finish(waves, shared, limits)
    };
    shared.tiles.par_iter().copied().map_init(|| WaveRunner::new(frame), finish).collect()
}

/// Goes over the whole picture again and again.
fn round_by_round<T: Tier>(frame: &Frame, shared: &Shared, limits: &Limits) -> Reached {
    let mut states: Vec<TileState> = shared.tiles.iter().copied().map(TileState::new).collect();
    let stop = || shared.is_cancelled() || limits.is_late();
    let round = |waves: &mut WaveRunner<T>, state: &mut TileState| {
        let more = !shared.is_cancelled() && state.round(waves, limits, &stop);
        let rays = shared.count(waves.take_counts());
        shared.say((limits.share_of_time() * shared.pixels_total() as f64) as u64, rays);
        more
    };
    let mut next_round = || {
        let rounds = states.par_iter_mut().map_init(|| WaveRunner::new(frame), round);
        rounds.reduce(|| false, |a, b| a | b) && !stop()
    };
    let more = next_round();
    let first_sample_late = limits.is_late();
    while more && next_round() {}
    let finish = |waves: &mut WaveRunner<T>, state: TileState| state.finish(waves, shared, limits);
    let tallies: Vec<_> = states.into_par_iter().map_init(|| WaveRunner::new(frame), finish).collect();
    reached(&tallies, limits, first_sample_late)
}

/// In the order of tiles, so that the sum is the same in any order of threads.
fn reached(tallies: &[TileTally], limits: &Limits, first_sample_late: bool) -> Reached {
    let pixels: u64 = tallies.iter().map(|tally| tally.pixels).sum();
    let variance: f64 = tallies.iter().map(|tally| tally.variance).sum();
    let fewest = tallies.iter().map(|tally| tally.samples[0]).min().unwrap_or(0);
    let most = tallies.iter().map(|tally| tally.samples[1]).max().unwrap_or(0);
    Reached {
        rmse_estimate: (variance / pixels.max(1) as f64).sqrt(),
        pixels_above: limits.max_error.map(|_| tallies.iter().map(|tally| tally.pixels_above).sum()),
        samples: [fewest, most],
        first_sample_late,
    }
}
