//! How far a picture is from the truth, in numbers and as pictures.

use serde::Serialize;

/// How far a picture is from the truth.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// Root of the mean squared difference in linear light.
    pub rmse: f64,
    /// Mean of the squared difference over the squared truth plus 0.01, in linear light.
    pub relative_mse: f64,
    /// Peak signal to noise ratio for a peak of 1, in decibels; infinite, `null` in JSON, where there is no difference.
    pub psnr_db: f64,
    /// Mean of LDR-FLIP of the pictures as a screen shows them.
    pub flip: f64,
    /// The largest difference of a channel in linear light.
    pub max_error: f64,
    /// Share of pixels whose middle shows another primitive, or the same one lit by other lights.
    pub wrong_visibility: f64,
}

/// A picture beside what is wrong with it, as files in PNG.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pictures {
    /// As a screen shows it.
    pub picture: Vec<u8>,
    /// LDR-FLIP from black, which is none, to white.
    pub difference: Vec<u8>,
}
