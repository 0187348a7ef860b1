//! The picture formats and their names.

use std::fmt;
use std::path::Path;
use std::str::FromStr;

use super::error::OutputError;

/// A picture file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Binary PPM (P6), 8 bits in sRGB.
    Ppm,
    /// PNG, 8 bits in sRGB.
    Png,
    /// OpenEXR, 32-bit linear light, with all planes of the film.
    Exr,
    /// Portable float map, 32-bit linear light.
    Pfm,
}

impl Format {
    /// Every format.
    pub const ALL: [Self; 4] = [Self::Ppm, Self::Png, Self::Exr, Self::Pfm];
    /// The extension of every format, in the order of [`Format::ALL`].
    pub const NAMES: [&'static str; 4] = ["ppm", "png", "exr", "pfm"];

    /// The format that the extension of `path` names, in upper or lower case.
    ///
    /// **Errors**: [`OutputError::UnknownFormat`] without an extension or with an unknown one.
    pub fn from_path(path: &Path) -> Result<Self, OutputError> {
        path.extension()
            .and_then(|extension| extension.to_str()?.parse().ok())
            .ok_or_else(|| OutputError::UnknownFormat { path: path.to_owned() })
    }

    /// The format's name, which is its extension.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }

    /// Whether pixels are stored as linear light, without exposure and tone curve.
    pub fn is_float(self) -> bool {
        matches!(self, Self::Exr | Self::Pfm)
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Format {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let known = Self::NAMES.iter().position(|known| known.eq_ignore_ascii_case(name));
        known
            .map(|index| Self::ALL[index])
            .ok_or_else(|| format!("unknown picture format `{name}`; known are {}", Self::NAMES.join(", ")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_extension_leads_to_its_format() {
        for format in Format::ALL {
            assert_eq!(format.name().parse(), Ok(format));
            assert_eq!(Format::from_path(&Path::new("a.b").with_extension(format.name())).unwrap(), format);
        }
        assert_eq!(Format::from_path(Path::new("A.PNG")).unwrap(), Format::Png);
    }

    #[test]
    fn unknown_and_missing_extensions_list_the_known_ones() {
        for name in ["a.jpg", "png", ".png", "", "a.", "/dev/full"] {
            let error = Format::from_path(Path::new(name)).unwrap_err().to_string();
            assert!(error.ends_with("ppm, png, exr, pfm"), "{error}");
        }
    }
}
