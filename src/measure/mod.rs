//! Measuring: what a scene costs to build and to ask, here and in other ray tracers; how exact the answers are; how
//! far pictures differ; what settings cost and bring.

pub mod bench;
pub mod compare;
#[cfg(feature = "peers")]
pub mod peers;
mod plot;
pub mod tradeoff;
pub mod verify;
