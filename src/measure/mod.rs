//! Measuring: what a scene costs to build and to ask, here and in other ray tracers.

pub mod bench;
#[cfg(feature = "peers")]
pub mod peers;
