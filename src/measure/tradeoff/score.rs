//! Pictures to figures.

use super::figures::{Figures, Pictures};
use crate::film::{Film, Tone, develop};
use crate::measure::compare::{Metric, SizeMismatch, difference, heatmap};
use crate::output::{Format, Picture, encode};

/// Added to the squared truth, so that dark pixels do not decide a relative error.
const RELATIVE_FLOOR: f64 = 0.01;

/// The film with each pixel as a square of `by` times as many along both sides.
pub(super) fn enlarged(film: &Film, by: u32) -> Film {
    let [width, height] = [film.width * by, film.height * by];
    let at = |x: u32, y: u32| film.pixel(x / by, y / by);
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| at(x, y))).collect();
    Film { width, height, pixels, planes: Vec::new() }
}

/// Compares a film of the truth's size; what it sees is for others to say.
///
/// **Errors:** films of different size.
pub(super) fn score(
    film: &Film,
    truth: &Film,
    tone: Tone,
    wrong_visibility: f64,
) -> Result<(Figures, Pictures), SizeMismatch> {
    let shown = |film: &Film| Picture::Display(develop(film, tone).picture);
    let light = difference(&Picture::Light(film.clone()), &Picture::Light(truth.clone()), false)?;
    let seen = difference(&shown(film), &shown(truth), true)?;
    let figures = Figures {
        rmse: light.by(Metric::Rmse).unwrap_or_default(),
        relative_mse: relative_mse(film, truth),
        psnr_db: light.by(Metric::Psnr).unwrap_or_default(),
        flip: seen.by(Metric::Flip).unwrap_or_default(),
        max_error: light.max,
        wrong_visibility,
    };
    let pictures = Pictures {
        picture: png(film, tone),
        difference: png(&heatmap(&seen, Metric::Flip), Tone::default()),
    };
    Ok((figures, pictures))
}

fn relative_mse(film: &Film, truth: &Film) -> f64 {
    let values = film.pixels.iter().flatten().zip(truth.pixels.iter().flatten());
    let each = values.map(|(&a, &b)| {
        let (a, b) = (f64::from(a), f64::from(b));
        (a - b).powi(2) / (b * b + RELATIVE_FLOOR)
    });
    each.sum::<f64>() / (3 * film.pixels.len().max(1)) as f64
}

/// The film as a PNG file; empty for a film without pixels.
pub(super) fn png(film: &Film, tone: Tone) -> Vec<u8> {
    let mut bytes = Vec::new();
    match encode(film, Format::Png, tone, &mut bytes) {
        Ok(_) => bytes,
        Err(_) => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn film(pixels: &[f32]) -> Film {
        Film::from_pixels(pixels.len() as u32, 1, pixels.iter().map(|&x| [x; 3]).collect()).unwrap()
    }

    #[test]
    fn figures_worked_out_by_hand() {
        let (found, _) = score(&film(&[0.5, 1.0]), &film(&[0.0, 1.0]), Tone::default(), 0.25).unwrap();
        assert!((found.rmse - 0.125f64.sqrt()).abs() < 1e-12);
        assert!((found.relative_mse - 12.5).abs() < 1e-9, "half of 0.25 / 0.01");
        assert!((found.psnr_db - 9.0309).abs() < 1e-4);
        assert_eq!((found.max_error, found.wrong_visibility), (0.5, 0.25));
        assert!(found.flip > 0.0 && found.flip < 1.0);
        assert!(score(&film(&[0.0]), &film(&[0.0; 2]), Tone::default(), 0.0).is_err());
    }

    #[test]
    fn a_picture_is_like_itself() {
        let truth = film(&[0.2, 7.0, 0.0]);
        let (found, pictures) = score(&truth, &truth, Tone::default(), 0.0).unwrap();
        assert_eq!((found.rmse, found.relative_mse, found.flip, found.max_error), (0.0, 0.0, 0.0, 0.0));
        assert_eq!(found.psnr_db, f64::INFINITY);
        assert!(pictures.picture.starts_with(b"\x89PNG") && pictures.difference.starts_with(b"\x89PNG"));
    }

    #[test]
    fn enlarged_pixels_are_squares() {
        let large = enlarged(&film(&[1.0, 2.0]), 2);
        let row: Vec<f32> = large.pixels.iter().map(|p| p[0]).collect();
        assert_eq!((large.width, large.height, row), (4, 2, vec![1., 1., 2., 2., 1., 1., 2., 2.]));
    }
}
