//! Counter-based random numbers, low-discrepancy points and pixel filters.
//!
//! Every number is a function of (seed, pixel, sample, dimension). Nothing here has a state, so threads, tile order and
//! packet width cannot change a picture.

mod dimension;
mod filter;
mod hash;
mod owen;
mod permute;
mod quantile;
mod sampler;
#[cfg(test)]
pub(crate) mod twin;
mod warp;

pub use dimension::{FILTER, LENS, ScatterDraw, bounce, child_branch};
pub use filter::{FilterSampler, PixelFilter};
pub(crate) use hash::splitmix64;
pub use hash::{pcg4d, unit};
pub use sampler::{Sampler, SamplerKind};
pub use warp::{concentric_disk, cosine_hemisphere, cosine_hemisphere_pdf, frame, to_frame};
