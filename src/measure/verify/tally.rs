//! What was counted over the rays of a family.

use super::trial::{Claim, Shape, Trial};
use super::truth::{Truth, leaked};
use crate::intersect::testing::ulps;

/// Errors of `t` beyond this are looked at as if the answer were wrong.
const SUSPECT_ULPS: f64 = 64.0;

/// How an intersector answers the rays of a trial.
#[derive(Clone, Debug, Default)]
pub(super) struct Answers {
    /// `t` of the nearest hit, ray by ray; any number for a box.
    pub(super) nearest: Vec<Option<f64>>,
    /// Rays that other ways of asking answer differently.
    pub(super) differing: Vec<usize>,
}

/// The numbers of an intersector.
#[derive(Clone, Copy)]
pub(super) struct Numbers {
    /// Half the distance from 1 to the next number.
    pub(super) roundoff: f64,
    /// The nearest number, as `f64`.
    pub(super) round: fn(f64) -> f64,
}

/// Kinds of error, for counting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fault {
    FalseMiss,
    FalseHit,
    GrossMiss,
    GrossHit,
    Leak,
    SelfHit,
    Differing,
}

impl Fault {
    pub(super) const ALL: [Self; 7] = [
        Self::FalseMiss,
        Self::FalseHit,
        Self::GrossMiss,
        Self::GrossHit,
        Self::Leak,
        Self::SelfHit,
        Self::Differing,
    ];

    pub(super) fn name(self) -> &'static str {
        ["false miss", "false hit", "gross miss", "gross hit", "leak", "self-hit", "differing answers"]
            [self as usize]
    }
}

/// Counts, and an example of each kind of error.
#[derive(Clone, Debug, Default)]
pub(super) struct Tally {
    pub(super) rays: usize,
    pub(super) hits: usize,
    pub(super) counts: [usize; Fault::ALL.len()],
    pub(super) examples: [Option<String>; Fault::ALL.len()],
    /// Of every ray that hits, rightly.
    pub(super) ulps: Vec<f64>,
}

impl Tally {
    pub(super) fn count(&self, fault: Fault) -> usize {
        self.counts[fault as usize]
    }

    pub(super) fn add(&mut self, fault: Fault, example: impl FnOnce() -> String) {
        self.counts[fault as usize] += 1;
        self.examples[fault as usize].get_or_insert_with(example);
    }

    /// Both, this one first.
    pub(super) fn join(mut self, other: Self) -> Self {
        self.rays += other.rays;
        self.hits += other.hits;
        for (i, (count, example)) in other.counts.into_iter().zip(other.examples).enumerate() {
            self.counts[i] += count;
            self.examples[i] = self.examples[i].take().or(example);
        }
        self.ulps.extend(other.ulps);
        self
    }

    /// Judges the answers to a trial.
    pub(super) fn judge(&mut self, trial: &Trial, truths: &[Truth], answers: &Answers, numbers: Numbers) {
        for (truth, &answer) in truths.iter().zip(&answers.nearest) {
            self.rays += 1;
            self.hits += usize::from(answer.is_some());
            match trial.shapes[..] {
                [Shape::Box { .. }] => self.judge_box(trial, truth, answer.is_some()),
                _ => self.judge_ray(trial, truth, answer, numbers),
            }
        }
        for &ray in &answers.differing {
            self.add(Fault::Differing, || example(trial, &truths[ray], answers.nearest[ray], None));
        }
    }

    fn judge_box(&mut self, trial: &Trial, truth: &Truth, met: bool) {
        let meets = truth.meets_box();
        let told = || example(trial, truth, met.then_some(0.0), meets.then_some(0.0));
        match (met, meets) {
            (false, true) => self.add(Fault::FalseMiss, told),
            (true, false) => self.add(Fault::FalseHit, told),
            _ => {}
        }
    }

    fn judge_ray(&mut self, trial: &Trial, truth: &Truth, answer: Option<f64>, numbers: Numbers) {
        let expected = truth.nearest(numbers.round);
        let told = || example(trial, truth, answer, expected);
        let off = match (answer, expected) {
            (Some(got), Some(want)) => {
                let off = ulps(got as f32, want);
                self.ulps.push(off);
                off > SUSPECT_ULPS
            }
            (None, None) => false,
            (None, Some(_)) => {
                self.add(Fault::FalseMiss, told);
                true
            }
            (Some(_), None) => {
                self.add(Fault::FalseHit, told);
                true
            }
        };
        if off {
            let [missed, made] = truth.is_gross(trial, answer, numbers.roundoff);
            if missed {
                self.add(Fault::GrossMiss, told);
            }
            if made {
                self.add(Fault::GrossHit, told);
            }
        }
        if leaked(trial, truth, answer, numbers.roundoff) {
            self.add(Fault::Leak, told);
        }
        if trial.claim == Claim::Leaving && answer.is_some() {
            self.add(Fault::SelfHit, told);
        }
    }
}

/// A ray, what it was answered and what is true, such that it can be asked again.
fn example(trial: &Trial, truth: &Truth, answer: Option<f64>, expected: Option<f64>) -> String {
    let told = |t: Option<f64>| t.map_or("nothing".into(), |t| format!("t = {t:e}"));
    let shapes = match &trial.shapes[..] {
        few if few.len() <= 4 => format!("{few:?}"),
        many => format!("{} shapes, the first {:?}", many.len(), many[0]),
    };
    format!("{:?} against {shapes} gives {}, exactly {}", truth.ray, told(answer), told(expected))
}
