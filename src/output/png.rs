//! PNG: 8 bits a channel in sRGB, through the `image` crate.

use std::io::{self, Cursor, Write};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, ImageFormat};

use crate::film::{Film, Rgb8, Tone, develop};

/// Writes `film`; gives the number of values that were not a number.
pub(super) fn write(film: &Film, tone: Tone, writer: &mut dyn Write) -> io::Result<u64> {
    let developed = develop(film, tone);
    let picture = &developed.picture;
    // Encoded in memory: the encoder drops the cause of a failed write, and ignores one at the end.
    let mut bytes = Vec::new();
    PngEncoder::new_with_quality(&mut bytes, CompressionType::Fast, FilterType::Paeth)
        .write_image(&picture.bytes, picture.width, picture.height, ExtendedColorType::Rgb8)
        .map_err(io::Error::other)?;
    writer.write_all(&bytes)?;
    Ok(developed.nan_values)
}

/// The picture in a PNG file, reduced to 8 bits and without transparency.
pub(super) fn read(bytes: &[u8]) -> Result<Rgb8, String> {
    let mut reader = image::ImageReader::new(Cursor::new(bytes));
    reader.set_format(ImageFormat::Png);
    let picture = reader.decode().map_err(|error| error.to_string())?.into_rgb8();
    Ok(Rgb8 { width: picture.width(), height: picture.height(), bytes: picture.into_raw() })
}
