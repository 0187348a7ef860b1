//! Where two pictures differ, as a picture.

use super::metrics::{Difference, Metric};
use crate::film::Film;

/// Colours from no difference to the largest, in linear light.
const RAMP: [[f32; 3]; 5] =
    [[0.0, 0.0, 0.0], [0.08, 0.0, 0.25], [0.65, 0.03, 0.1], [1.0, 0.45, 0.0], [1.0, 1.0, 0.75]];

/// The map of a metric: of FLIP as it is, of the others over the largest difference. Black is equal.
pub fn heatmap(difference: &Difference, metric: Metric) -> Film {
    let (values, scale) = match metric {
        Metric::Flip => (&difference.flip, 1.0),
        _ => (&difference.channels, difference.max),
    };
    let pixels: Vec<[f32; 3]> = values.iter().map(|value| color(value / scale)).collect();
    let width = difference.width.max(1);
    let (width, height) = (width as u32, (pixels.len() / width) as u32);
    Film { width, height, pixels, planes: Vec::new() }
}

/// Nothing over nothing is no difference; what is infinite is the largest.
fn color(share: f64) -> [f32; 3] {
    let share = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) } * (RAMP.len() - 1) as f64;
    let step = (share as usize).min(RAMP.len() - 2);
    let along = (share - step as f64) as f32;
    std::array::from_fn(|k| RAMP[step][k] + along * (RAMP[step + 1][k] - RAMP[step][k]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_difference_is_brightest_and_none_is_black() {
        let difference =
            Difference { width: 2, mse: 0.0, max: 4.0, flip: Vec::new(), channels: vec![0.0, 4.0, 2.0, 1.0] };
        let map = heatmap(&difference, Metric::Rmse);
        assert_eq!((map.width, map.height), (2, 2));
        assert_eq!((map.pixels[0], map.pixels[1]), (RAMP[0], RAMP[4]));
        assert_eq!(
            heatmap(&Difference { max: 0.0, channels: vec![0.0; 4], ..difference }, Metric::Max).pixels,
            [[0.0; 3]; 4]
        );
    }
}
