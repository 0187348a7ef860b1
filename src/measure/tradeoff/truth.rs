//! The picture that all others are compared with.

use std::time::Duration;

use super::report::Truth;
use super::score::png;
use super::setting::{Setting, Stage};
use crate::film::Film;
use crate::intersect::TierName;
use crate::sampling::SamplerKind;
use crate::wavefront::{Goal, RenderError, RenderOptions, render};

/// Most samples of a pixel.
const SPP: u32 = 4096;
/// Paths that would bring less than this share of their radiance end.
const CUTOFF: f64 = 1.0 / 16384.0;

/// Renders the truth within some time: in the exact tier, twice as deep as the scene asks for, and with random numbers that
/// no other picture has.
///
/// **Errors:** [`RenderError`].
pub(super) fn truth(
    stage: &mut Stage,
    options: &RenderOptions,
    limit: Duration,
) -> Result<(Film, Truth), RenderError> {
    let base = Setting::of(stage.scene());
    let setting = Setting {
        tier: TierName::Exact,
        spp: SPP,
        sampler: SamplerKind::Sobol,
        max_depth: base.max_depth.saturating_mul(2),
        min_throughput: base.min_throughput.min(CUTOFF),
        ..base
    };
    let seed = stage.scene().settings.seed;
    let goal = Some(Goal { max_error: None, time_limit: Some(limit) });
    let rendered = render(stage.set_with_seed(&setting, !seed), &RenderOptions { goal, ..*options });
    let tone = stage.set_with_seed(&base, seed).settings.tone;
    let (film, report) = rendered?;
    let reached = report.reached;
    let [fewest_samples, most] = reached.map_or([SPP; 2], |reached| reached.samples);
    let truth = Truth {
        setting: Setting { spp: most, ..setting },
        fewest_samples,
        rmse_estimate: reached.map(|reached| reached.rmse_estimate).filter(|error| error.is_finite()),
        time_s: report.render_time.as_secs_f64(),
        picture: png(&film, tone),
    };
    Ok((film, truth))
}
