//! Pictures from files, for comparing.

use std::path::Path;

use super::{Format, OutputError, exr, pfm, png, ppm};
use crate::film::{Film, Rgb8};

/// A picture as a file holds it.
#[derive(Clone, Debug, PartialEq)]
pub enum Picture {
    /// 8 bits in sRGB, from PPM or PNG.
    Display(Rgb8),
    /// Linear light, from EXR or PFM.
    Light(Film),
}

/// The picture in the file at `path`, whose format its extension names.
///
/// **Errors**: an unknown extension, a file that cannot be read, and one that is not a whole picture.
pub fn read_file(path: &Path) -> Result<Picture, OutputError> {
    let format = Format::from_path(path)?;
    let bytes = std::fs::read(path).map_err(|cause| OutputError::Read { path: path.to_owned(), cause })?;
    decode(&bytes, format).map_err(|reason| OutputError::Malformed { path: path.to_owned(), reason })
}

/// The picture in `bytes`, or what is wrong with them.
pub fn decode(bytes: &[u8], format: Format) -> Result<Picture, String> {
    match format {
        Format::Ppm => ppm::read(bytes).map(Picture::Display),
        Format::Png => png::read(bytes).map(Picture::Display),
        Format::Exr => exr::decode(bytes).map(Picture::Light),
        Format::Pfm => pfm::read(bytes).map(Picture::Light),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_name_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let empty = folder.path().join("empty.png");
        std::fs::write(&empty, b"").unwrap();
        assert!(matches!(read_file(&empty), Err(OutputError::Malformed { path, .. }) if path == empty));
        let missing = folder.path().join("missing.exr");
        assert!(matches!(read_file(&missing), Err(OutputError::Read { path, .. }) if path == missing));
        assert!(matches!(read_file(folder.path()), Err(OutputError::UnknownFormat { .. })));
    }
}
