//! Queues of path states, and the loop over them: generate, extend, shade, connect, scatter.
//!
//! A wave holds some samples of the pixels of a tile. Its paths go through the stages together, one depth after the other.
//! What a path adds to its sample is added exactly ([`crate::film::SampleSums`]), so neither the order of queues nor the way
//! they are cut changes the picture.

mod adaptive;
mod adaptive_tile;
mod aov;
mod arena;
mod connect;
mod contact;
mod emit;
mod extend;
mod generate;
mod medium;
mod offset;
mod paint;
mod queue;
mod render;
mod run;
mod scatter;
mod shared;
mod surface;
mod surface_queue;
mod tile;
mod walk;
mod wave;
mod wave_runner;

pub use adaptive::{Goal, Reached};
pub(crate) use offset::offset_along;
pub(crate) use paint::{Painted, Scratch, Tiles, paint};
pub use render::{Progress, RenderError, RenderOptions, RenderReport, render};
pub(crate) use surface::{HitLanes, evaluate};
pub(crate) use tile::{Rect, mean, pixels, tiles};
pub(crate) use walk::{Step, walk};
pub use wave::RayCounts;
