//! The same verification for any other intersector.

use super::bounds::Bounds;
use super::families::Family;
use super::report::FamilyReport;
use super::run::{Effort, Subject, verify_subject};
use super::tally::{Answers, Numbers};
use super::trial::{Shape, Trial};
use crate::intersect::Ray;
use crate::math::Real;

/// What can be verified: anything that answers rays in `f32`.
pub trait Intersector: Sync {
    /// Some shapes, made ready to be asked.
    type Scene;

    /// Makes shapes ready; nothing if it knows one of them not, and then the trial is left out.
    fn build(&self, shapes: &[Shape]) -> Option<Self::Scene>;

    /// `t` of the nearest hit with `t_min < t < t_max`, in units of the direction's length. For a box, any number where the
    /// ray meets it at all.
    fn nearest(&self, scene: &Self::Scene, ray: &Ray) -> Option<f32>;
}

/// An [`Intersector`] as the judge sees it.
struct Foreign<'a, I>(&'a I);

impl<I: Intersector> Subject for Foreign<'_, I> {
    fn numbers(&self) -> Numbers {
        Numbers { roundoff: f32::ROUNDOFF, round: |t| f64::from(t as f32) }
    }

    fn answers(&self, trial: &Trial) -> Option<Answers> {
        let scene = self.0.build(&trial.shapes)?;
        let nearest = trial.rays.iter().map(|ray| self.0.nearest(&scene, ray).map(f64::from)).collect();
        Some(Answers { nearest, differing: Vec::new() })
    }
}

/// Verifies an intersector over a family, against bounds of its own. Nothing for families of paths, which are octray's own,
/// and of shapes that it does not know.
pub fn verify_intersector(
    name: &str,
    intersector: &impl Intersector,
    family: &Family,
    bounds: &Bounds,
    effort: Effort,
) -> Option<FamilyReport> {
    verify_subject(family, name, &Foreign(intersector), bounds, effort)
}

/// Families for property tests (feature `testkit`).
#[cfg(any(test, feature = "testkit"))]
pub mod strategies {
    use proptest::prelude::*;

    use super::{Family, Trial};

    /// Trials of a family; a failing one shrinks to the first few of its seed.
    pub fn trials(family: &'static Family) -> impl Strategy<Value = Trial> {
        (any::<u64>(), 0..1_000_000u64)
            .prop_filter_map("paths have no trials", |(seed, number)| family.trial(seed, number))
    }
}
