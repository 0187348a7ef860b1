//! From linear light to the bytes of a screen: exposure, tone curve, sRGB.
//!
//! Only additions, multiplications, divisions and one `libm` power are used, so a film gives the same bytes on every
//! machine.

use std::str::FromStr;

use super::image::{Film, Rgb8};
use super::srgb::SrgbTable;
use crate::math::WIDTH;

/// How far exposure may go, either way, in stops.
const MAX_STOPS: f32 = 64.0;

/// Light beyond any screen; the squares of it are still finite.
const BRIGHTEST: f32 = 1e9;

/// How linear light is brought into the range of a screen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tone {
    /// Exposure in stops: light is multiplied by two to this power. Limited to -64..=64.
    pub exposure_ev: f32,
    /// What happens to light that is too bright.
    pub curve: ToneCurve,
}

/// How bright light is compressed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneCurve {
    /// Not at all: values above one are cut.
    #[default]
    None,
    /// `L / (1 + L)` on the luminance, which keeps the hue.
    ///
    /// **Source**: Reinhard, Stark, Shirley, Ferwerda: Photographic Tone Reproduction for Digital Images, SIGGRAPH
    /// 2002, equation 3.
    Reinhard,
    /// A film-like shoulder and toe, each channel by itself.
    ///
    /// **Source**: Narkowicz: ACES Filmic Tone Mapping Curve, 2016; the fit as published, without its further factor
    /// of 0.6 on the exposure.
    Filmic,
}

impl ToneCurve {
    /// The names that a scene file may use, in the order of the enum.
    pub const NAMES: [&'static str; 3] = ["none", "reinhard", "filmic"];
}

impl FromStr for ToneCurve {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        match name {
            "none" => Ok(Self::None),
            "reinhard" => Ok(Self::Reinhard),
            "filmic" => Ok(Self::Filmic),
            _ => Err(format!("unknown tone curve `{name}`; known are {}", Self::NAMES.join(", "))),
        }
    }
}

/// What [`develop`] gives.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Developed {
    /// The picture for the screen.
    pub picture: Rgb8,
    /// Channel values that were not a number; they are shown as 0.
    pub nan_values: u64,
}

/// The film as a screen shows it.
pub fn develop(film: &Film, tone: Tone) -> Developed {
    let mut bytes = Vec::with_capacity(film.pixels.len() * 3);
    let nan_values = develop_row(&film.pixels, tone, &mut bytes);
    Developed { picture: Rgb8 { width: film.width, height: film.height, bytes }, nan_values }
}

/// Appends the bytes of `pixels`; gives the number of channel values that were not a number.
pub fn develop_row(pixels: &[[f32; 3]], tone: Tone, bytes: &mut Vec<u8>) -> u64 {
    // Once a row, so that the loop over pixels has neither branch nor table lookup for it.
    match tone.curve {
        ToneCurve::None => encode(pixels, tone, bytes, |light| light),
        ToneCurve::Reinhard => encode(pixels, tone, bytes, reinhard),
        ToneCurve::Filmic => encode(pixels, tone, bytes, |light| light.map(filmic)),
    }
}

fn encode(pixels: &[[f32; 3]], tone: Tone, bytes: &mut Vec<u8>, curve: impl Fn([f32; 3]) -> [f32; 3]) -> u64 {
    let table = SrgbTable::get();
    let gain = libm::exp2f(tone.exposure_ev.clamp(-MAX_STOPS, MAX_STOPS));
    let start = bytes.len();
    bytes.resize(start + 3 * pixels.len(), 0);
    // Eight pixels are 24 values, three vectors.
    let (eights, rest) = pixels.as_chunks::<WIDTH>();
    let (of_eights, of_rest) = bytes[start..].as_chunks_mut::<{ 3 * WIDTH }>();
    let many =
        eights.iter().zip(of_eights).map(|(pixels, bytes)| encode_some(table, pixels, (gain, &curve), bytes));
    let few = rest.iter().zip(of_rest.as_chunks_mut::<3>().0);
    many.sum::<u64>()
        + few.map(|(pixel, bytes)| encode_some(table, &[*pixel], (gain, &curve), bytes)).sum::<u64>()
}

/// The bytes of some pixels; gives the number of channel values that were not a number.
#[inline(always)]
fn encode_some<const PIXELS: usize, const VALUES: usize>(
    table: &SrgbTable,
    pixels: &[[f32; 3]; PIXELS],
    (gain, curve): (f32, impl Fn([f32; 3]) -> [f32; 3]),
    bytes: &mut [u8; VALUES],
) -> u64 {
    let mut light = [0.0; VALUES];
    for (light, &value) in light.iter_mut().zip(pixels.as_flattened()) {
        *light = expose(value, gain);
    }
    for light in light.as_chunks_mut().0 {
        *light = curve(*light);
    }
    table.encode_all(&light, bytes);
    pixels.as_flattened().iter().map(|value| u64::from(value.is_nan())).sum()
}

/// Light after exposure, finite and not negative; NaN gives 0.
fn expose(value: f32, gain: f32) -> f32 {
    // Infinity times the least gain is still far above `BRIGHTEST`.
    if value > 0.0 { (value.min(f32::MAX) * gain).min(BRIGHTEST) } else { 0.0 }
}

fn reinhard(light: [f32; 3]) -> [f32; 3] {
    let luminance = 0.2126 * light[0] + 0.7152 * light[1] + 0.0722 * light[2];
    light.map(|value| value / (1.0 + luminance))
}

fn filmic(x: f32) -> f32 {
    (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CURVES: [ToneCurve; 3] = [ToneCurve::None, ToneCurve::Reinhard, ToneCurve::Filmic];

    fn bytes(pixel: [f32; 3], tone: Tone) -> (Vec<u8>, u64) {
        let mut bytes = Vec::new();
        let nan_values = develop_row(&[pixel], tone, &mut bytes);
        (bytes, nan_values)
    }

    fn with(curve: ToneCurve, exposure_ev: f32) -> Tone {
        Tone { exposure_ev, curve }
    }

    #[test]
    fn plain_light_is_only_encoded() {
        assert_eq!(bytes([0.0, 0.5, 1.0], Tone::default()), (vec![0, 188, 255], 0));
    }

    #[test]
    fn one_stop_doubles() {
        let once = bytes([0.1, 0.2, 0.3], with(ToneCurve::None, 1.0));
        assert_eq!(once, bytes([0.2, 0.4, 0.6], Tone::default()));
    }

    #[test]
    fn light_that_is_no_number_is_black_and_counted() {
        for curve in CURVES {
            let (bytes, nan_values) = bytes([f32::NAN, 1e3, f32::NAN], with(curve, 0.0));
            assert_eq!((bytes[0], bytes[2], nan_values), (0, 0, 2), "{curve:?}");
        }
    }

    #[test]
    fn infinite_and_negative_light_is_clamped_at_any_exposure() {
        for curve in CURVES {
            for ev in [-1e9, -64.0, 0.0, 64.0, 1e9] {
                let tone = with(curve, ev);
                assert_eq!(bytes([f32::NEG_INFINITY, -1.0, -0.0], tone), (vec![0; 3], 0), "{tone:?}");
                assert_eq!(bytes([f32::INFINITY; 3], tone), (vec![255; 3], 0), "{tone:?}");
            }
        }
    }

    #[test]
    fn reinhard_halves_light_of_luminance_one_and_keeps_its_hue() {
        let white = reinhard([1.0; 3]);
        assert!(white.iter().all(|value| (value - 0.5).abs() < 1e-6));
        let [red, green, blue] = reinhard([0.8, 0.4, 0.2]);
        assert!((red / green - 2.0).abs() < 1e-6 && (green / blue - 2.0).abs() < 1e-6);
    }

    #[test]
    fn filmic_has_the_published_values() {
        assert_eq!(filmic(0.0), 0.0);
        assert!((filmic(1.0) - 2.54 / 3.16).abs() < 1e-6);
        assert!((filmic(0.18) - 0.267).abs() < 1e-3);
    }

    #[test]
    fn brighter_light_is_never_darker() {
        for curve in CURVES {
            let greys: Vec<u8> =
                (0..4000).map(|i| bytes([i as f32 / 400.0; 3], with(curve, 0.0)).0[0]).collect();
            assert!(greys.is_sorted(), "{curve:?}");
        }
    }

    #[test]
    fn names_lead_to_curves() {
        assert_eq!(ToneCurve::NAMES.map(|name| name.parse()), CURVES.map(Ok));
        assert!("aces".parse::<ToneCurve>().unwrap_err().contains("none, reinhard, filmic"));
    }

    #[test]
    fn develop_keeps_the_shape() {
        let film = Film::from_pixels(3, 1, vec![[1.0; 3]; 3]).unwrap();
        let developed = develop(&film, Tone::default());
        assert_eq!(developed.picture, Rgb8 { width: 3, height: 1, bytes: vec![255; 9] });
    }
}
