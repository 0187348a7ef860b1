//! The command line: one file a verb, and what the verbs share.
//!
//! Data goes to standard output, everything else to standard error. Exit codes: 0 done, 1 failed while running,
//! 2 wrong use, 3 bad scene or asset, 75 stopped by a signal, 4 beyond a limit: slower than the baseline, a documented bound is broken, or pictures that differ by too much.

mod args;
pub mod batch;
mod begun;
pub mod bench;
pub mod compare;
pub mod completions;
mod destination;
mod error;
mod goal;
mod human;
pub mod inspect;
mod log;
pub mod man;
mod memory;
mod pipeline;
mod progress;
pub mod render;
mod rhythm;
pub mod scenes;
pub mod schema;
mod signals;
mod simd;
mod source;
mod stdio;
mod summary;
mod threads;
pub mod tradeoff;
pub mod verify;

pub use args::{
    Args, BuildQuality, CompletionsArgs, InspectArgs, ManArgs, ProgressMode, RenderArgs, SceneArgs,
    ScenesArgs, Tier, Verb,
};
pub use begun::begin;
pub use bench::BenchArgs;
pub use compare::CompareArgs;
pub use error::{CliError, Exit, exit_code};
pub use goal::GoalArgs;
pub use source::SceneSource;
pub use tradeoff::TradeoffArgs;
pub use verify::VerifyArgs;
