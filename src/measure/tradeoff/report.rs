//! What was measured, for programs and for people.

use serde::Serialize;

use super::figures::{Figures, Pictures};
use super::setting::Setting;

/// Everything that was measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Version of the program, and for which instructions it was built.
    pub octray: String,
    /// The scene's name.
    pub scene: String,
    /// Width and height of the pictures.
    pub size: [u32; 2],
    /// Worker threads.
    pub threads: usize,
    /// The picture that all others are compared with.
    pub truth: Truth,
    /// The scene's own settings, from which each row departs in one thing beside tier and samples.
    pub base: Setting,
    /// What was rendered, fastest first.
    pub rows: Vec<Row>,
    /// Settings for which there was no time.
    pub left_out: Vec<Setting>,
}

/// The picture that all others are compared with.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Truth {
    /// How it was rendered; `spp` is the most that a pixel got.
    pub setting: Setting,
    /// Fewest samples of a pixel.
    pub fewest_samples: u32,
    /// Its own error as estimated from its samples; nothing where they are too few to tell. Errors below it say nothing.
    pub rmse_estimate: Option<f64>,
    /// How long it took.
    pub time_s: f64,
    /// As a PNG file.
    #[serde(skip)]
    pub picture: Vec<u8>,
}

/// One setting.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Which.
    pub setting: Setting,
    /// What is unlike the base, beside tier and samples.
    pub change: Option<&'static str>,
    /// Rays traced.
    pub rays: u64,
    /// How long it took.
    pub times: Times,
    /// How good it is.
    pub figures: Figures,
    /// No other setting is both as fast and as good by RMSE.
    pub on_front: bool,
    /// What it looks like.
    #[serde(skip)]
    pub pictures: Pictures,
}

/// Wall times of a setting in seconds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Times {
    /// Half are not larger.
    pub median_s: f64,
    /// The smallest.
    pub least_s: f64,
    /// The largest.
    pub most_s: f64,
    /// How often it was rendered, in turns with all others.
    pub runs: usize,
}

impl Times {
    /// Of at least one time.
    pub(super) fn of(mut times: Vec<f64>) -> Self {
        times.sort_by(f64::total_cmp);
        let (n, last) = (times.len(), times.len().saturating_sub(1));
        let at = |i: usize| times.get(i).copied().unwrap_or_default();
        Self { median_s: 0.5 * (at(last / 2) + at(n / 2)), least_s: at(0), most_s: at(last), runs: n }
    }

    /// How far the runs spread, as a share of the median.
    pub fn spread(&self) -> f64 {
        (self.most_s - self.least_s) / self.median_s.max(f64::MIN_POSITIVE)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::intersect::TierName;
    use crate::sampling::SamplerKind;

    pub(in super::super) fn row(time_s: f64, rmse: f64) -> Row {
        let setting = Setting {
            tier: TierName::Watertight,
            spp: 4,
            sampler: SamplerKind::Sobol,
            max_depth: 6,
            min_throughput: 0.0,
            shrink: 1,
            shadows: true,
            bounce: true,
        };
        let figures = Figures {
            rmse,
            relative_mse: rmse,
            psnr_db: 30.0,
            flip: rmse,
            max_error: rmse,
            wrong_visibility: 0.0,
        };
        let times = Times::of(vec![time_s]);
        Row {
            setting,
            change: None,
            rays: 1000,
            times,
            figures,
            on_front: false,
            pictures: Pictures::default(),
        }
    }

    #[test]
    fn medians_and_spreads() {
        let times = Times::of(vec![3.0, 1.0, 2.0]);
        assert_eq!((times.median_s, times.least_s, times.most_s, times.runs), (2.0, 1.0, 3.0, 3));
        assert_eq!(times.spread(), 1.0);
        assert_eq!(Times::of(vec![4.0, 1.0]).median_s, 2.5);
    }
}
