//! Families of rays to intersectors, and what comes out to a report.

use std::marker::PhantomData;

use rayon::prelude::*;

use super::bounds::Bounds;
use super::families::Family;
use super::octray::Octray;
use super::report::FamilyReport;
use super::tally::{Answers, Numbers, Tally};
use super::trial::Trial;
use super::truth::Truth;
use crate::intersect::{Exact, Fast, TierName, Watertight};

/// What is verified.
pub(super) trait Subject: Sync {
    /// The numbers that it computes in.
    fn numbers(&self) -> Numbers;
    /// Its answers to a trial, or nothing if it knows no such shape.
    fn answers(&self, trial: &Trial) -> Option<Answers>;
}

/// How much is asked.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Least number of rays a family.
    pub rays: usize,
    /// Which of the endless trials: the same seed gives the same rays.
    pub seed: u64,
}

/// Verifies octray in some tiers over a family.
pub fn verify_family(family: &Family, tiers: &[TierName], effort: Effort) -> Vec<FamilyReport> {
    let subjects: Vec<Box<dyn Subject>> = tiers.iter().map(|&tier| subject(tier)).collect();
    let subjects: Vec<&dyn Subject> = subjects.iter().map(|subject| &**subject).collect();
    let tallies = match family.rays_a_walk() {
        Some(rays) => tiers.iter().map(|&tier| walks(family, tier, effort, rays)).collect(),
        None => tallies(family, &subjects, effort),
    };
    let report = |(&tier, tally): (&TierName, Tally)| {
        FamilyReport::new(family.name, tier.name(), tally, &family.promise.bounds(tier))
    };
    tiers.iter().zip(tallies).map(report).collect()
}

/// Verifies octray in a tier over rays of one's own. **Needs:** finite numbers, directions that are not zero, and triangles
/// with an area.
pub fn verify_trial(trial: &Trial, tier: TierName, bounds: &Bounds) -> FamilyReport {
    let tally = judge(trial, &[&*subject(tier)]).pop().unwrap_or_default();
    FamilyReport::new("trial", tier.name(), tally, bounds)
}

/// Verifies one intersector, of which nothing is promised, over a family; nothing if it knows none of the shapes.
pub(super) fn verify_subject(
    family: &Family,
    name: &str,
    subject: &dyn Subject,
    bounds: &Bounds,
    effort: Effort,
) -> Option<FamilyReport> {
    let tally = tallies(family, &[subject], effort).pop().filter(|tally| tally.rays > 0)?;
    Some(FamilyReport::new(family.name, name, tally, bounds))
}

pub(super) fn subject(tier: TierName) -> Box<dyn Subject> {
    match tier {
        TierName::Fast => Box::new(Octray::<Fast>(PhantomData)),
        TierName::Watertight => Box::new(Octray::<Watertight>(PhantomData)),
        TierName::Exact => Box::new(Octray::<Exact>(PhantomData)),
    }
}

/// One tally a subject; the truth of each ray is found once for all.
fn tallies(family: &Family, subjects: &[&dyn Subject], effort: Effort) -> Vec<Tally> {
    let rays_a_trial = family.trial(effort.seed, 0).map_or(0, |trial| trial.rays.len());
    let trials = effort.rays.div_ceil(rays_a_trial.max(1)) as u64;
    let none = || vec![Tally::default(); subjects.len()];
    let judged = (0..trials)
        .into_par_iter()
        .filter_map(|number| Some(judge(&family.trial(effort.seed, number)?, subjects)));
    let join = |all: Vec<Tally>, one: Vec<Tally>| all.into_iter().zip(one).map(|(a, b)| a.join(b)).collect();
    // Collected first, so that examples and sums do not depend on threads.
    judged.collect::<Vec<_>>().into_iter().fold(none(), join)
}

/// Walks, which no oracle judges but what must come next.
fn walks(family: &Family, tier: TierName, effort: Effort, rays: usize) -> Tally {
    let trials = effort.rays.div_ceil(rays) as u64;
    let walked = (0..trials).into_par_iter().filter_map(|number| family.walk(tier, effort.seed, number));
    walked.collect::<Vec<_>>().into_iter().fold(Tally::default(), Tally::join)
}

fn judge(trial: &Trial, subjects: &[&dyn Subject]) -> Vec<Tally> {
    let shapes: Vec<_> = trial.shapes.iter().map(|shape| shape.exact()).collect();
    let truths: Vec<Truth> = trial.rays.iter().map(|ray| Truth::of(ray, &shapes)).collect();
    let judge = |subject: &&dyn Subject| {
        let mut tally = Tally::default();
        if let Some(answers) = subject.answers(trial) {
            tally.judge(trial, &truths, &answers, subject.numbers());
        }
        tally
    };
    subjects.iter().map(judge).collect()
}
