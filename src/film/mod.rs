//! The picture: pixels in linear light, and their way to bytes for a screen.

mod image;
mod srgb;
mod tone;

pub use image::{Film, Plane, Rgb8};
pub use srgb::{linear_from_srgb8, srgb8_from_linear};
pub use tone::{Developed, Tone, ToneCurve, develop, develop_row};
