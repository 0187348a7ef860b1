//! Binary PPM (P6): 8 bits a channel in sRGB.
//!
//! **Source**: <https://netpbm.sourceforge.net/doc/ppm.html>

use std::io::{self, Write};

use super::netpbm::Header;
use crate::film::{Film, Rgb8, Tone, develop_row};

/// Writes `film`; gives the number of values that were not a number.
pub(super) fn write(film: &Film, tone: Tone, writer: &mut dyn Write) -> io::Result<u64> {
    write!(writer, "P6\n{} {}\n255\n", film.width, film.height)?;
    let mut nan_values = 0;
    let mut line = Vec::with_capacity(film.width as usize * 3);
    for row in film.rows() {
        line.clear();
        nan_values += develop_row(row, tone, &mut line);
        writer.write_all(&line)?;
    }
    Ok(nan_values)
}

/// The picture in a P6 file of 8 bits.
pub(super) fn read(bytes: &[u8]) -> Result<Rgb8, String> {
    let mut header = Header::new(bytes, "P6")?;
    let (width, height) = header.size()?;
    let brightest: u32 = header.number("greatest value")?;
    if brightest != 255 {
        return Err(format!("greatest value {brightest}; only 255 is supported"));
    }
    let bytes = header.pixels((width, height), 3)?.to_vec();
    Ok(Rgb8 { width, height, bytes })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_by_two_has_the_known_bytes() {
        let pixels = vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.5, 2.0, -1.0]];
        let film = Film::from_pixels(2, 2, pixels).unwrap();
        let mut bytes = Vec::new();
        assert_eq!(write(&film, Tone::default(), &mut bytes).unwrap(), 0);
        let body = [255, 0, 0, 0, 255, 0, 0, 0, 255, 188, 255, 0];
        assert_eq!(bytes, [b"P6\n2 2\n255\n".as_slice(), &body].concat());
    }

    #[test]
    fn comments_are_skipped() {
        let picture = read(b"P6 # made by hand\n1 # width\n1\n# depth\n255\n\x01\x02\x03").unwrap();
        assert_eq!(picture, Rgb8 { width: 1, height: 1, bytes: vec![1, 2, 3] });
    }

    #[test]
    fn bad_files_are_named() {
        let reason = |bytes: &[u8]| read(bytes).unwrap_err();
        assert!(reason(b"").contains("P6"));
        assert!(reason(b"P5\n1 1\n255\n\0").contains("P6"));
        assert!(reason(b"P6\n1").contains("cut short"));
        assert!(reason(b"P6\n1 1\n255\n\0\0").contains("2 of 3 bytes"));
        assert!(reason(b"P6\n4000000000 4000000000\n255\n").contains("cut short"));
        assert!(reason(b"P6\n0 1\n255\n").contains("empty"));
        assert!(reason(b"P6\n-1 1\n255\n").contains("width `-1`"));
        assert!(reason(b"P6\n1 1\n65535\n\0\0\0\0\0\0").contains("65535"));
    }
}
