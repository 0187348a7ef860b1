//! Measuring: what a scene costs to build and to ask, here and in other ray tracers; and how exact the answers are.

pub mod bench;
#[cfg(feature = "peers")]
pub mod peers;
pub mod verify;
