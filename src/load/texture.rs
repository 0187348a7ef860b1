//! Pictures as textures.

use super::LoadError;
use std::path::Path;
use std::sync::LazyLock;

/// A picture, row by row from the top, as it was stored: sRGB with 8 bits and alpha.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Texture {
    /// Width in pixels, at least 1.
    pub width: u32,
    /// Height in pixels, at least 1.
    pub height: u32,
    /// Red, green, blue in sRGB and alpha.
    pub texels: Vec<[u8; 4]>,
}

/// The picture in a PNG or JPEG file.
///
/// # Errors
/// [`LoadError::Read`] when it cannot be read, [`LoadError::Picture`] when it cannot be decoded.
pub fn load_texture(path: &Path) -> Result<Texture, LoadError> {
    let bytes = std::fs::read(path).map_err(|source| LoadError::Read { path: path.to_owned(), source })?;
    let unreadable = |message| LoadError::Picture { path: path.to_owned(), message };
    let picture = image::load_from_memory(&bytes).map_err(|e| unreadable(e.to_string()))?.into_rgba8();
    let (width, height) = picture.dimensions();
    if width == 0 || height == 0 {
        return Err(unreadable("it has no pixels".to_owned()));
    }
    let texels = picture.into_raw().as_chunks().0.to_vec();
    Ok(Texture { width, height, texels })
}

impl Texture {
    /// The linear colour of a texel; columns count from the left, rows from the top.
    ///
    /// # Panics
    /// When the texel lies outside.
    #[must_use]
    pub fn linear(&self, column: u32, row: u32) -> [f32; 3] {
        let [r, g, b, _] = self.texel(column, row);
        [r, g, b].map(srgb_to_linear)
    }

    #[inline(always)]
    pub(crate) fn texel(&self, column: u32, row: u32) -> [u8; 4] {
        self.texels[row as usize * self.width as usize + column as usize]
    }
}

/// The linear value of an 8-bit sRGB value, from a table.
///
/// **Source**: IEC 61966-2-1.
#[must_use]
pub fn srgb_to_linear(value: u8) -> f32 {
    linear_from_srgb()[usize::from(value)]
}

/// That table.
pub(crate) fn linear_from_srgb() -> &'static [f32; 256] {
    static TABLE: LazyLock<[f32; 256]> = LazyLock::new(|| {
        std::array::from_fn(|i| {
            let encoded = i as f64 / 255.0;
            let curve = || libm::pow((encoded + 0.055) / 1.055, 2.4);
            (if encoded <= 0.04045 { encoded / 12.92 } else { curve() }) as f32
        })
    });
    &TABLE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_ends_and_middle_are_known() {
        assert_eq!((srgb_to_linear(0), srgb_to_linear(255)), (0.0, 1.0));
        assert!((srgb_to_linear(188) - 0.5029).abs() < 1e-4);
        assert!((0..255u8).all(|i| srgb_to_linear(i) < srgb_to_linear(i + 1)));
    }

    #[test]
    fn pictures_that_are_none_are_errors_with_their_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("broken.png");
        assert!(load_texture(&path).unwrap_err().to_string().contains("broken.png"));
        std::fs::write(&path, b"\x89PNG\r\n\x1a\nnothing").unwrap();
        assert!(load_texture(&path).unwrap_err().to_string().contains("broken.png: is not a picture"));
    }

    #[test]
    fn a_picture_keeps_its_rows() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("two.png");
        let picture = image::RgbaImage::from_raw(1, 2, vec![255, 0, 0, 255, 0, 0, 255, 128]).unwrap();
        picture.save(&path).unwrap();
        let texture = load_texture(&path).unwrap();
        assert_eq!((texture.width, texture.height), (1, 2));
        assert_eq!((texture.linear(0, 0), texture.linear(0, 1)), ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]));
    }
}
