//! Differences of two pictures as numbers.

use std::fmt;
use std::str::FromStr;

use super::flip::flip;
use super::{Colors, SizeMismatch};
use crate::output::Picture;

/// How a difference is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Metric {
    /// Root of the mean squared difference.
    Rmse,
    /// Mean squared difference.
    Mse,
    /// Peak signal to noise ratio, for a peak of 1.
    Psnr,
    /// The largest difference of a channel.
    Max,
    /// Mean of LDR-FLIP.
    Flip,
}

impl Metric {
    /// Names as on the command line, in the order of [`Metric::ALL`].
    pub const NAMES: [&'static str; 5] = ["rmse", "mse", "psnr", "max", "flip"];
    /// All metrics.
    pub const ALL: [Self; 5] = [Self::Rmse, Self::Mse, Self::Psnr, Self::Max, Self::Flip];
}

impl fmt::Display for Metric {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(Self::NAMES[*self as usize])
    }
}

impl FromStr for Metric {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let known = Self::NAMES.iter().position(|known| *known == name);
        known.map(|index| Self::ALL[index]).ok_or_else(|| format!("unknown metric `{name}`"))
    }
}

/// How two pictures differ.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// Pixels in a row.
    pub width: usize,
    /// Mean squared difference over all channels; infinite where one picture has no number and the other has.
    pub mse: f64,
    /// The largest difference of a channel.
    pub max: f64,
    /// LDR-FLIP of each pixel; empty unless it was asked for.
    pub flip: Vec<f64>,
    /// The largest difference of a channel, pixel by pixel.
    pub channels: Vec<f64>,
}

/// Compares two pictures; FLIP, which takes longest, only if `with_flip`.
///
/// **Errors:** pictures of different size.
pub fn difference(a: &Picture, b: &Picture, with_flip: bool) -> Result<Difference, SizeMismatch> {
    let [first, second] = Colors::of_same_kind(a, b);
    if first.size() != second.size() {
        return Err(SizeMismatch { first: first.size(), second: second.size() });
    }
    let pixels = first.values.iter().zip(&second.values);
    let apart: Vec<[f64; 3]> = pixels.map(|(a, b)| std::array::from_fn(|k| distance(a[k], b[k]))).collect();
    let sum: f64 = apart.iter().flatten().map(|x| x * x).sum();
    let channels: Vec<f64> = apart.iter().map(|x| x[0].max(x[1]).max(x[2])).collect();
    Ok(Difference {
        width: first.width,
        mse: sum / (3 * apart.len().max(1)) as f64,
        max: channels.iter().fold(0.0, |m, x| x.max(m)),
        flip: if with_flip { flip(&Colors::encoded(a), &Colors::encoded(b)) } else { Vec::new() },
        channels,
    })
}

/// Values that are no number, or infinite, are like themselves and unlike all others.
fn distance(a: f64, b: f64) -> f64 {
    if a == b || (a.is_nan() && b.is_nan()) {
        return 0.0;
    }
    let distance = (a - b).abs();
    if distance.is_nan() { f64::INFINITY } else { distance }
}

impl Difference {
    /// The difference by a metric; `None` for FLIP that was not asked for.
    pub fn by(&self, metric: Metric) -> Option<f64> {
        Some(match metric {
            Metric::Rmse => self.mse.sqrt(),
            Metric::Mse => self.mse,
            Metric::Psnr => -10.0 * self.mse.log10(),
            Metric::Max => self.max,
            Metric::Flip if self.flip.is_empty() => return None,
            Metric::Flip => self.flip.iter().sum::<f64>() / self.flip.len() as f64,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::{Film, Rgb8};

    fn light(pixels: Vec<[f32; 3]>) -> Picture {
        Picture::Light(Film::from_pixels(pixels.len() as u32, 1, pixels).unwrap())
    }

    fn shown(bytes: [u8; 3]) -> Picture {
        Picture::Display(Rgb8 { width: 1, height: 1, bytes: bytes.to_vec() })
    }

    #[test]
    fn numbers_worked_out_by_hand() {
        let (a, b) = (light(vec![[0.0; 3], [1.0, 0.5, 2.0]]), light(vec![[0.0, 0.0, 0.5], [1.0, 1.5, 2.0]]));
        let d = difference(&a, &b, false).unwrap();
        assert_eq!((d.mse, d.max, d.by(Metric::Flip)), (1.25 / 6.0, 1.0, None));
        assert_eq!(d.by(Metric::Rmse), Some((1.25f64 / 6.0).sqrt()));
        assert!((d.by(Metric::Psnr).unwrap() - 6.812).abs() < 1e-3);
        let same = difference(&a, &a, true).unwrap();
        assert_eq!(Metric::ALL.map(|m| same.by(m).unwrap()), [0.0, 0.0, f64::INFINITY, 0.0, 0.0]);
    }

    #[test]
    fn pictures_of_one_kind_are_compared_as_stored_and_others_as_light() {
        let (black, white) = (shown([0; 3]), shown([255, 255, 255]));
        assert_eq!(difference(&black, &white, false).unwrap().mse, 1.0);
        assert!((difference(&black, &shown([51; 3]), false).unwrap().max - 0.2).abs() < 1e-12);
        assert!(difference(&light(vec![[1.0; 3]]), &white, false).unwrap().max < 1e-6);
    }

    #[test]
    fn what_is_no_number_differs_from_every_number() {
        let (nan, inf) = (light(vec![[f32::NAN; 3]]), light(vec![[f32::INFINITY; 3]]));
        let zero = light(vec![[0.0; 3]]);
        assert_eq!(difference(&nan, &nan, false).unwrap().mse, 0.0);
        assert_eq!(difference(&inf, &inf, false).unwrap().mse, 0.0);
        for other in [&nan, &inf] {
            assert_eq!(difference(other, &zero, false).unwrap().mse, f64::INFINITY);
        }
    }

    #[test]
    fn sizes_must_be_equal() {
        let error = difference(&shown([0; 3]), &light(vec![[0.0; 3]; 2]), false).unwrap_err();
        assert_eq!(error.to_string(), "the pictures differ in size: 1x1 and 2x1");
    }
}
