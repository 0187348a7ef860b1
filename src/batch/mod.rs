//! Many pictures: planned once, rendered in any number of pieces by any number of processes, put together to the same bytes.
//!
//! | module | turns |
//! |---|---|
//! | [`job`] | a job file into what the user wrote |
//! | `expand` | a job into pictures, each a list of changes to its scene |
//! | [`plan`] | pictures into numbered units, cut into shards |
//! | `store` | units into records and files of sums, whole or not at all |
//! | [`run`] | units that are not done into ones that are |
//! | [`merge`] | units into pictures, and into a list of what is missing |

mod assets;
mod axis;
mod compose;
mod distinct;
pub mod emit;
mod error;
mod expand;
mod faults;
mod frames;
pub mod job;
mod key;
mod keyframes;
mod likeness;
pub mod merge;
mod neighbours;
mod part;
mod paths;
mod pattern;
mod picture;
pub mod plan;
mod record;
pub mod run;
mod scenes;
mod seed;
pub mod shard;
mod source;
mod store;
mod threads;
mod unit;
mod whole;

pub use error::BatchError;
pub(crate) use faults::first_lines;
pub use job::Job;
pub use plan::{Plan, Split};
pub use shard::Shard;
pub use store::Store;
pub use threads::default_threads;
