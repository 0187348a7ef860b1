//! Measuring: what a scene costs to build and to ask, here and in other ray tracers; how exact the answers are; how
//! far pictures differ.

pub mod bench;
pub mod compare;
#[cfg(feature = "peers")]
pub mod peers;
pub mod verify;
