//! What was measured of a family, for programs and for people.

use serde::Serialize;

use super::bounds::Bounds;
use super::tally::{Fault, Tally};
use crate::intersect::testing::percentile;

/// Everything that was measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Version of the program, and for which instructions it was built.
    pub octray: String,
    /// Least number of rays a family.
    pub rays: usize,
    /// Which rays.
    pub seed: u64,
    /// Families, tier by tier.
    pub families: Vec<FamilyReport>,
}

/// A count a million rays beside what is allowed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Rate {
    /// What was counted.
    pub what: &'static str,
    /// How often.
    pub count: usize,
    /// A million rays.
    pub per_million: f64,
    /// The most that is promised a million rays.
    pub bound: Option<f64>,
    /// The first of them, such that it can be asked again.
    pub example: Option<String>,
}

/// Errors of `t` in ulps of `f32`, over rays that rightly hit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Ulps {
    /// Half are not larger.
    pub p50: f64,
    /// 99 in 100 are not larger.
    pub p99: f64,
    /// What `p99` is at least, by all but the chance of so many hits.
    pub p99_least: f64,
    /// The largest.
    pub max: f64,
    /// The most that is promised of `p99`.
    pub p99_bound: Option<f64>,
}

/// What was measured of an intersector over a family.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FamilyReport {
    /// Name of the family.
    pub family: String,
    /// Name of the tier, or of the intersector.
    pub tier: String,
    /// Rays asked.
    pub rays: usize,
    /// Rays that hit.
    pub hits: usize,
    /// Errors by kind.
    pub rates: Vec<Rate>,
    /// Errors of `t`; nothing where no ray hits, and for boxes.
    pub t_ulps: Option<Ulps>,
    /// Whether all bounds hold.
    pub holds: bool,
}

impl FamilyReport {
    pub(super) fn new(family: &str, tier: &str, mut tally: Tally, bounds: &Bounds) -> Self {
        let rate = |fault: Fault| {
            let count = tally.count(fault);
            let per_million = count as f64 * 1e6 / tally.rays.max(1) as f64;
            let example = tally.examples[fault as usize].clone();
            Rate { what: fault.name(), count, per_million, bound: bounds.of(fault), example }
        };
        let rates: Vec<Rate> = Fault::ALL.into_iter().map(rate).collect();
        let hits = tally.ulps.len().max(1) as f64;
        let t_ulps = (!tally.ulps.is_empty()).then(|| Ulps {
            p50: percentile(&mut tally.ulps, 0.5),
            p99: percentile(&mut tally.ulps, 0.99),
            p99_least: percentile(&mut tally.ulps, 0.99 - CHANCE * (0.99 * 0.01 / hits).sqrt()),
            max: percentile(&mut tally.ulps, 1.0),
            p99_bound: bounds.t_p99,
        });
        let holds = rates.iter().all(Rate::holds) && t_ulps.is_none_or(|ulps| ulps.holds());
        Self {
            family: family.into(),
            tier: tier.into(),
            rays: tally.rays,
            hits: tally.hits,
            rates,
            t_ulps,
            holds,
        }
    }

    /// The rate of a kind of error.
    pub fn rate(&self, what: &str) -> Option<&Rate> {
        self.rates.iter().find(|rate| rate.what == what)
    }

    /// What broke a bound, in words, with an example.
    pub fn breaches(&self) -> Vec<String> {
        let rates = self.rates.iter().filter(|rate| !rate.holds());
        let mut told: Vec<String> = rates
            .map(|rate| {
                let example = rate.example.as_deref().unwrap_or("no example");
                format!(
                    "{}, {}: {} of {} rays: {}: {example}",
                    self.family, self.tier, rate.count, self.rays, rate.what
                )
            })
            .collect();
        if let Some(ulps) = self.t_ulps.filter(|ulps| !ulps.holds()) {
            told.push(format!("{}, {}: t is off by {:.3} ulp at p99", self.family, self.tier, ulps.p99));
        }
        told
    }
}

impl Rate {
    /// Whether the bound, if there is one, holds. One above zero is not broken by what chance makes of few rays.
    pub fn holds(&self) -> bool {
        let millions = self.count as f64 / self.per_million.max(f64::MIN_POSITIVE);
        self.bound.is_none_or(|bound| {
            let by_chance = CHANCE * (bound / millions).sqrt();
            self.count == 0 || self.per_million <= bound + by_chance
        })
    }
}

/// Standard deviations that are left to chance.
const CHANCE: f64 = 4.0;

/// A rounded `t` is half an ulp off at most; this is what rounding the exact `t` to `f64` first may add.
const ULPS_SLACK: f64 = 1e-6;

impl Ulps {
    fn holds(&self) -> bool {
        self.p99_bound.is_none_or(|bound| self.p99_least <= bound + ULPS_SLACK)
    }
}
