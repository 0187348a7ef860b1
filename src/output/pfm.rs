//! Portable float map: 32-bit linear light, the bottom row first.
//!
//! **Source**: <https://www.pauldebevec.com/Research/HDR/PFM/>

use std::io::{self, Write};

use super::netpbm::Header;
use crate::film::Film;

/// Writes `film` in little-endian order.
pub(super) fn write(film: &Film, writer: &mut dyn Write) -> io::Result<()> {
    // The sign of the scale says little-endian.
    write!(writer, "PF\n{} {}\n-1.0\n", film.width, film.height)?;
    let mut line = Vec::with_capacity(film.width as usize * 12);
    for row in film.rows().rev() {
        line.clear();
        line.extend(row.as_flattened().iter().flat_map(|value| value.to_le_bytes()));
        writer.write_all(&line)?;
    }
    Ok(())
}

/// The film in a colour PFM file of either byte order; the size of the scale is ignored, as is usual.
pub(super) fn read(bytes: &[u8]) -> Result<Film, String> {
    let mut header = Header::new(bytes, "PF")?;
    let size = header.size()?;
    let scale: f32 = header.number("scale")?;
    let value = if scale < 0.0 { f32::from_le_bytes } else { f32::from_be_bytes };
    let (values, _) = header.pixels(size, 12)?.as_chunks::<4>();
    let row_values = size.0 as usize * 3;
    let from_top = values.chunks_exact(row_values).rev().flatten().map(|bytes| value(*bytes));
    let pixels = from_top.collect::<Vec<f32>>().as_chunks::<3>().0.to_vec();
    Film::from_pixels(size.0, size.1, pixels).ok_or_else(|| "the pixels do not match the size".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_by_two_has_the_known_bytes() {
        let pixels = vec![[1.0, 2.0, 0.5], [0.0, -1.0, 0.25], [4.0, 8.0, 16.0], [1e-3, f32::INFINITY, 3.0]];
        let mut bytes = Vec::new();
        write(&Film::from_pixels(2, 2, pixels.clone()).unwrap(), &mut bytes).unwrap();
        let from_bottom = [pixels[2], pixels[3], pixels[0], pixels[1]];
        let body: Vec<u8> = from_bottom.as_flattened().iter().flat_map(|value| value.to_le_bytes()).collect();
        assert_eq!(bytes, [b"PF\n2 2\n-1.0\n".as_slice(), &body].concat());
        assert_eq!(&bytes[12..16], [0, 0, 128, 64], "4.0 of the bottom left comes first");
    }

    #[test]
    fn big_endian_files_are_read() {
        let body: Vec<u8> = [1.0f32, 2.0, 3.0].iter().flat_map(|value| value.to_be_bytes()).collect();
        let film = read(&[b"PF 1 1 1.0\n".as_slice(), &body].concat()).unwrap();
        assert_eq!(film.pixels, [[1.0, 2.0, 3.0]]);
    }

    #[test]
    fn values_that_are_no_number_stay() {
        let mut bytes = Vec::new();
        write(&Film::from_pixels(1, 1, vec![[f32::NAN, 0.0, -0.0]]).unwrap(), &mut bytes).unwrap();
        let film = read(&bytes).unwrap();
        assert!(film.pixels[0][0].is_nan());
        assert!(film.pixels[0][2].is_sign_negative());
    }

    #[test]
    fn bad_files_are_named() {
        let reason = |bytes: &[u8]| read(bytes).unwrap_err();
        assert!(reason(b"Pf\n1 1\n-1\n\0\0\0\0").contains("PF"));
        assert!(reason(b"PF\n1 1\nx\n").contains("scale `x`"));
        assert!(reason(b"PF\n1 1\n-1.0\n\0").contains("1 of 12 bytes"));
    }
}
