//! `compare`: how far two pictures of one size differ, as a number and as a map.

mod colors;
pub mod flip;
mod heatmap;
mod metrics;

pub use colors::Colors;
pub use heatmap::heatmap;
pub use metrics::{Difference, Metric, difference};

/// Two pictures that cannot be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the pictures differ in size: {}x{} and {}x{}", .first[0], .first[1], .second[0], .second[1])]
pub struct SizeMismatch {
    /// Width and height of the first.
    pub first: [u32; 2],
    /// Width and height of the second.
    pub second: [u32; 2],
}
