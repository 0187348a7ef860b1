//! `bench`: rays a second of every engine, over the same deterministic sets of rays.
//!
//! A scene becomes a [`Subject`]; a [`Class`] of rays over it becomes a [`RaySet`]; every [`Engine`] is first checked and
//! then timed, all in turns within one process; what comes out is a [`Report`], for people and for programs.

mod baseline;
mod census;
mod check;
mod classes;
mod counters;
mod engine;
mod generate;
mod octray;
mod rays;
mod report;
mod roofline;
mod run;
mod scaling;
mod subject;
mod table;
#[cfg(test)]
mod testing;
mod timing;
mod view;

pub use baseline::{Baseline, BaselineError, Comparison, comparison_table};
pub use census::{Visits, count_visits};
pub use check::{BruteForce, Difference, Mismatch, agree, difference, fingerprint};
pub use classes::{Class, Question};
pub use counters::{CounterReading, Counters};
pub use engine::{Answers, Engine, ask};
pub use generate::ray_set;
pub use octray::Octray;
pub use rays::{HitColumns, Hits, NO_HIT, RayColumns, RaySet};
pub use report::{BuildReport, ClassReport, EngineReport, Report, SceneReport, Settings};
pub use roofline::box_tests_a_second;
pub use run::{BenchError, Options, PeerScene, bench_scene};
pub use scaling::{Curve, Law, Point, Quantity, Scaling, Step, TooFewSizes, scaling_plot};
pub use subject::{Subject, Target};
pub(super) use table::aligned;
pub use table::table;
pub use timing::Spread;
#[cfg(feature = "peers")]
pub(super) use timing::timed;
pub use view::View;
