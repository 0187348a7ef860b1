//! A film to the bytes of a file.

use std::io::{self, Write};

use super::{Format, exr, pfm, png, ppm};
use crate::film::{Film, Tone};

/// Writes `film` in `format`; gives the number of channel values that were not a number and were written as 0.
///
/// Exposure and tone curve apply to the 8-bit formats; float formats store the light as it is.
///
/// **Errors**: those of `writer`, and `InvalidInput` for a film without pixels or of the wrong shape.
pub fn encode(film: &Film, format: Format, tone: Tone, writer: &mut dyn Write) -> io::Result<u64> {
    check_shape(film)?;
    match format {
        Format::Ppm => ppm::write(film, tone, writer),
        Format::Png => png::write(film, tone, writer),
        Format::Exr => exr::write(film, writer).map(|()| 0),
        Format::Pfm => pfm::write(film, writer).map(|()| 0),
    }
}

fn check_shape(film: &Film) -> io::Result<()> {
    let count = film.width as usize * film.height as usize;
    let wrong = film.pixels.len() != count || film.planes.iter().any(|plane| plane.values.len() != count);
    if count == 0 || wrong {
        let what = if wrong { "the picture's columns do not match its size" } else { "the picture is empty" };
        return Err(io::Error::new(io::ErrorKind::InvalidInput, what));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::{Plane, PlaneValues};
    use crate::output::{Picture, decode};
    use proptest::prelude::*;

    /// Takes `room` bytes, then fails as a full disk does.
    struct Full {
        room: usize,
    }

    impl Write for Full {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let taken = bytes.len().min(self.room);
            self.room -= taken;
            if taken == 0 { Err(io::ErrorKind::StorageFull.into()) } else { Ok(taken) }
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    fn film(width: u32, height: u32) -> Film {
        let pixels = (0..width * height).map(|i| [i as f32 * 0.01, 0.5, 1.0 / (1.0 + i as f32)]).collect();
        Film::from_pixels(width, height, pixels).unwrap()
    }

    fn encoded(film: &Film, format: Format) -> Vec<u8> {
        let mut bytes = Vec::new();
        encode(film, format, Tone::default(), &mut bytes).unwrap();
        bytes
    }

    #[test]
    fn a_full_disk_is_reported_wherever_it_fills() {
        let film = film(16, 16);
        for format in Format::ALL {
            let size = encoded(&film, format).len();
            for room in (0..size).step_by(7).chain([size - 1]) {
                let error = encode(&film, format, Tone::default(), &mut Full { room }).unwrap_err();
                assert_eq!(error.kind(), io::ErrorKind::StorageFull, "{format} with {room} of {size} bytes");
            }
        }
    }

    #[test]
    fn empty_and_misshapen_films_are_refused() {
        let mut misshapen = film(2, 2);
        misshapen.pixels.pop();
        let mut bad_plane = film(2, 2);
        bad_plane.planes.push(Plane { name: "depth.Z".into(), values: PlaneValues::Float(vec![0.0; 3]) });
        for bad in [Film::new(0, 0), Film::new(0, 3), misshapen, bad_plane] {
            for format in Format::ALL {
                let error = encode(&bad, format, Tone::default(), &mut Vec::new()).unwrap_err();
                assert_eq!(error.kind(), io::ErrorKind::InvalidInput);
            }
        }
    }

    #[test]
    fn the_same_film_gives_the_same_bytes() {
        let film = film(33, 17);
        for format in Format::ALL {
            assert_eq!(encoded(&film, format), encoded(&film, format));
        }
    }

    #[test]
    fn values_that_are_no_number_are_counted_where_they_are_replaced() {
        let mut film = film(2, 2);
        film.pixels[1] = [f32::NAN, 0.0, f32::NAN];
        for format in Format::ALL {
            let replaced = encode(&film, format, Tone::default(), &mut Vec::new()).unwrap();
            assert_eq!(replaced, if format.is_float() { 0 } else { 2 }, "{format}");
        }
    }

    fn any_film() -> impl Strategy<Value = Film> {
        (1u32..20, 1u32..20).prop_flat_map(|(width, height)| {
            let count = (width * height) as usize;
            prop::collection::vec(any::<[f32; 3]>(), count)
                .prop_map(move |pixels| Film::from_pixels(width, height, pixels).unwrap())
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn float_formats_keep_every_bit(film in any_film()) {
            for format in [Format::Pfm, Format::Exr] {
                prop_assert_eq!(decode(&encoded(&film, format), format), Ok(Picture::Light(film.clone())));
            }
        }

        #[test]
        fn byte_formats_keep_every_byte(film in any_film()) {
            let picture = crate::film::develop(&film, Tone::default()).picture;
            for format in [Format::Ppm, Format::Png] {
                prop_assert_eq!(decode(&encoded(&film, format), format), Ok(Picture::Display(picture.clone())));
            }
        }

        #[test]
        fn damaged_files_never_panic(film in any_film(), cut in 0usize..200, at: prop::sample::Index, byte: u8) {
            for format in Format::ALL {
                let mut bytes = encoded(&film, format);
                let index = at.index(bytes.len());
                bytes[index] = byte;
                let _ = decode(&bytes, format);
                bytes.truncate(bytes.len().saturating_sub(cut));
                let _ = decode(&bytes, format);
            }
        }
    }
}
