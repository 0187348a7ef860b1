//! The picture: sums of samples in a fixed order, pixels in linear light, and their way to bytes for a screen.

mod accumulate;
mod aov;
mod exact;
mod image;
mod partial;
mod spread;
mod srgb;
mod tone;

pub use accumulate::{BlockNode, BlockTree, NotAdjacent, PixelSum, SAMPLES_PER_BLOCK, total};
pub use aov::{Aov, AovSample, AovSet};
pub(crate) use exact::contributes;
pub use exact::{CONTRIBUTION_LIMIT, SampleSums};
pub use image::{Film, Plane, PlaneValues, Rgb8};
pub use partial::{TileSums, joined, node_places};
pub use spread::Spread;
pub use srgb::{linear_from_srgb8, srgb8_from_linear};
pub use tone::{Developed, Tone, ToneCurve, develop, develop_row};
