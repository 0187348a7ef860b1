//! LDR-FLIP: how much a person sees of the difference who flips between two pictures on a screen.
//!
//! Plainly: what the eye cannot resolve at the usual distance is blurred away; the colours that are left are compared in a
//! space that is even to the eye; where edges or points differ, that difference is raised. Each pixel gets a number from 0
//! to 1. No departures, but that the filters run axis by axis, which gives the same sums since each is a product.
//!
//! **Source:** Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astroem and Fairchild, FLIP: A Difference Evaluator for
//! Alternating Images, 2020.

mod colorspace;
mod filter;

use super::Colors;
use colorspace::{Lab, hunt, hyab, lab, opponent, unopponent};
use filter::{Kernel, Plane};

/// Pixels a degree: a screen 0.7 m wide with 3840 pixels seen from 0.7 m.
const PIXELS_A_DEGREE: f64 = 0.7 * (3840.0 / 0.7) * (std::f64::consts::PI / 180.0);

/// Gaussians of the eye's contrast sensitivity, as weight and width: for light, red against green, blue against yellow.
const SENSITIVITY: [&[(f64, f64)]; 3] = [&[(1.0, 0.0047)], &[(1.0, 0.0053)], &[(34.1, 0.04), (13.5, 0.025)]];

/// The exponent that brings large colour differences together.
const COLOR_EXPONENT: f64 = 0.7;
/// Colour differences up to this share of the largest are mapped to the lower part of the range.
const LOWER_DIFFERENCES: f64 = 0.4;
/// That part of the range.
const LOWER_RANGE: f64 = 0.95;
/// The exponent that raises feature differences.
const FEATURE_EXPONENT: f64 = 0.5;
/// Width of an edge that the eye detects, in degrees.
const FEATURE_WIDTH_DEG: f64 = 0.082;

/// LDR-FLIP of each pixel of two pictures in sRGB.
///
/// **Needs:** pictures of one size with values from 0 to 1.
pub fn flip(a: &Colors, b: &Colors) -> Vec<f64> {
    let [seen_a, seen_b] = [a, b].map(Seen::of);
    let largest = hyab(hunt(lab([0.0, 1.0, 0.0])), hunt(lab([0.0, 0.0, 1.0]))).powf(COLOR_EXPONENT);
    (0..a.values.len())
        .map(|i| {
            let color = color_difference(seen_a.colors[i], seen_b.colors[i], largest);
            let feature = |k: usize| (seen_a.features[k][i] - seen_b.features[k][i]).abs();
            let feature = (feature(0).max(feature(1)) / std::f64::consts::SQRT_2).powf(FEATURE_EXPONENT);
            color.powf(1.0 - feature.min(1.0))
        })
        .collect()
}

fn color_difference(a: Lab, b: Lab, largest: f64) -> f64 {
    let difference = hyab(a, b).powf(COLOR_EXPONENT);
    let lower = LOWER_DIFFERENCES * largest;
    if difference < lower {
        return LOWER_RANGE / lower * difference;
    }
    LOWER_RANGE + (difference - lower) / (largest - lower) * (1.0 - LOWER_RANGE)
}

/// What the eye makes of a picture.
struct Seen {
    colors: Vec<Lab>,
    /// Strength of edges and of points.
    features: [Vec<f64>; 2],
}

impl Seen {
    fn of(picture: &Colors) -> Self {
        let light: Vec<[f64; 3]> = picture.values.iter().map(|p| p.map(colorspace::linear)).collect();
        let opponents: Vec<[f64; 3]> = light.iter().map(|&p| opponent(p)).collect();
        let plane = |k: usize| Plane {
            width: picture.width,
            height: picture.height,
            values: opponents.iter().map(|p| p[k]).collect(),
        };
        let blurred = [0, 1, 2].map(|k| sensed(&plane(k), SENSITIVITY[k]));
        let colors = (0..light.len()).map(|i| {
            let visible = unopponent([0, 1, 2].map(|k| blurred[k].values[i]));
            hunt(lab(visible.map(|x| x.clamp(0.0, 1.0))))
        });
        let mut luminance = plane(0);
        luminance.values.iter_mut().for_each(|y| *y = (*y + 16.0) / 116.0);
        Self {
            colors: colors.collect(),
            features: [Kernel::edge, Kernel::point].map(|of| strength(&luminance, of)),
        }
    }
}

/// A plane blurred by a sum of Gaussians with a whole of one.
fn sensed(plane: &Plane, gaussians: &[(f64, f64)]) -> Plane {
    // One radius for all of them, that of the widest of all channels.
    let widest = SENSITIVITY.iter().copied().flatten().fold(0.0, |w: f64, (_, width)| w.max(*width));
    let deviation = |width: f64| (width / (2.0 * std::f64::consts::PI.powi(2))).sqrt() * PIXELS_A_DEGREE;
    let radius = (3.0 * deviation(widest)).ceil() as usize;
    let parts: Vec<(f64, Kernel)> = gaussians
        .iter()
        .map(|&(weight, width)| {
            let (kernel, sum) = Kernel::gaussian(deviation(width), radius);
            (weight * (std::f64::consts::PI / width).sqrt() * sum * sum, kernel)
        })
        .collect();
    let whole: f64 = parts.iter().map(|(weight, _)| weight).sum();
    let mut out = Plane { values: vec![0.0; plane.values.len()], ..*plane };
    for (weight, kernel) in &parts {
        let blurred = plane.filtered(kernel, kernel);
        out.values.iter_mut().zip(blurred.values).for_each(|(sum, x)| *sum += weight / whole * x);
    }
    out
}

/// How strong a feature is, whatever its direction.
fn strength(luminance: &Plane, feature: fn(f64, usize) -> Kernel) -> Vec<f64> {
    let deviation = 0.5 * FEATURE_WIDTH_DEG * PIXELS_A_DEGREE;
    let radius = (3.0 * deviation).ceil() as usize;
    let (across, (along, _)) = (feature(deviation, radius), Kernel::gaussian(deviation, radius));
    let (x, y) = (luminance.filtered(&across, &along), luminance.filtered(&along, &across));
    x.values.iter().zip(&y.values).map(|(x, y)| x.hypot(*y)).collect()
}

#[cfg(test)]
mod tests;
