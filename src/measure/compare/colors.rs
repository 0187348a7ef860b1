//! Pictures as numbers to compare.

use crate::film::{linear_from_srgb8, srgb8_from_linear};
use crate::output::Picture;

/// The colours of a picture.
///
/// **Shape**: a row after the other, the top row first. **Units**: 0 to 1 for what a screen shows.
#[derive(Clone, Debug, PartialEq)]
pub struct Colors {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Red, green and blue.
    pub values: Vec<[f64; 3]>,
}

impl Colors {
    /// Two pictures as numbers of one kind: as the files hold them, sRGB for 8-bit pictures and light for others; light
    /// where one is of each kind.
    pub fn of_same_kind(a: &Picture, b: &Picture) -> [Self; 2] {
        match (a, b) {
            (Picture::Display(_), Picture::Display(_)) => [a, b].map(Self::encoded),
            _ => [a, b].map(Self::light),
        }
    }

    /// sRGB, from 0 to 1; light beyond what a screen shows is clipped, and rounded as it is for 8-bit files.
    pub fn encoded(picture: &Picture) -> Self {
        let scaled = |bytes: [u8; 3]| bytes.map(|byte| f64::from(byte) / 255.0);
        match picture {
            Picture::Display(shown) => {
                let values = shown.bytes.as_chunks::<3>().0.iter().map(|&pixel| scaled(pixel)).collect();
                Self::new(shown.width, shown.height, values)
            }
            Picture::Light(film) => {
                let values = film.pixels.iter().map(|pixel| scaled(pixel.map(srgb8_from_linear))).collect();
                Self::new(film.width, film.height, values)
            }
        }
    }

    /// Linear light.
    pub fn light(picture: &Picture) -> Self {
        match picture {
            Picture::Display(shown) => {
                let pixels = shown.bytes.as_chunks::<3>().0.iter();
                let values =
                    pixels.map(|pixel| pixel.map(|byte| f64::from(linear_from_srgb8(byte)))).collect();
                Self::new(shown.width, shown.height, values)
            }
            Picture::Light(film) => {
                let values = film.pixels.iter().map(|pixel| pixel.map(f64::from)).collect();
                Self::new(film.width, film.height, values)
            }
        }
    }

    fn new(width: u32, height: u32, values: Vec<[f64; 3]>) -> Self {
        Self { width: width as usize, height: height as usize, values }
    }

    pub(super) fn size(&self) -> [u32; 2] {
        [self.width as u32, self.height as u32]
    }
}
