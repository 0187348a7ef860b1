//! From radiance to pixels and bytes.

use super::common::{at_centres, builtin, film, film_with, parse};
use octray::film::Tone;
use octray::output::{Format, encode};

/// Three times the pixels: every third one looks through the same place of the window.
#[test]
fn the_window_does_not_depend_on_the_number_of_pixels() {
    let (small, large) =
        (film(&at_centres(builtin("seed", [32, 24], 1))), film(&at_centres(builtin("seed", [96, 72], 1))));
    let places = (0..24u32).flat_map(|y| (0..32u32).map(move |x| (x, y)));
    let off = places.filter(|&(x, y)| {
        let (a, b) = (small.pixel(x, y), large.pixel(3 * x + 1, 3 * y + 1));
        (0..3).any(|c| (a[c] - b[c]).abs() > 1e-3)
    });
    assert!(off.count() <= 3, "only rays that graze something may differ");
}

#[test]
fn no_pixel_depends_on_another() {
    let scene = builtin("seed", [24, 18], 2);
    let whole = film(&scene);
    for (x, y) in [(0, 0), (11, 9), (5, 12), (23, 17)] {
        assert_eq!(film_with(&scene, 1, Some([x, y, 1, 1])).pixels, [whole.pixel(x, y)], "pixel {x}, {y}");
    }
}

/// The sRGB curve of IEC 61966-2-1.
fn srgb(light: f64) -> u8 {
    let encoded = match light.clamp(0.0, 1.0) {
        low if low <= 0.003_130_8 => 12.92 * low,
        high => 1.055 * high.powf(1.0 / 2.4) - 0.055,
    };
    (255.0 * encoded).round() as u8
}

#[test]
fn bytes_are_clamped_srgb() {
    for exposure in [-1.0f32, 0.0, 1.0] {
        let text = format!(
            "[camera]\nposition = [0, 0, 0]\nlook_at = [0, 0, 1]\n[render]\nsize = [16, 64]\nspp = 1\n\
             exposure = {exposure}\n[background]\nbottom = [0, 0.001, 0.2]\ntop = [1.5, 0.01, 1]\n"
        );
        let film = film(&parse(&text));
        let mut bytes = Vec::new();
        encode(&film, Format::Ppm, Tone { exposure_ev: exposure, ..Tone::default() }, &mut bytes).unwrap();
        let samples = &bytes[bytes.len() - 16 * 64 * 3..];
        for (byte, light) in samples.iter().zip(film.pixels.iter().flatten()) {
            let expected = srgb(f64::from(*light) * f64::from(exposure).exp2());
            assert!(byte.abs_diff(expected) == 0, "{light} at {exposure}: {byte}, not {expected}");
        }
    }
}
