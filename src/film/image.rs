//! Pictures in memory.

/// A finished picture in linear light.
///
/// **Shape**: `pixels` holds `width * height` red, green, blue triples, row by row, the top row first; every plane
/// holds one value for each pixel in the same order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Film {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green and blue of each pixel, linear, Rec. 709 primaries.
    pub pixels: Vec<[f32; 3]>,
    /// Further values for each pixel (depth, ids, ...); empty unless the scene asks for them.
    pub planes: Vec<Plane>,
}

/// One named value for each pixel, such as depth.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane {
    /// The channel's name in a file, such as `depth.Z`.
    pub name: String,
    /// One value for each pixel, in the order of [`Film::pixels`].
    pub values: PlaneValues,
}

/// The values of a plane.
#[derive(Clone, Debug, PartialEq)]
pub enum PlaneValues {
    /// Measures.
    Float(Vec<f32>),
    /// Ids and counts.
    Uint(Vec<u32>),
}

impl PlaneValues {
    /// How many there are.
    pub fn len(&self) -> usize {
        match self {
            Self::Float(values) => values.len(),
            Self::Uint(values) => values.len(),
        }
    }
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// A picture as a screen shows it: 8 bits a channel in the sRGB encoding.
///
/// **Shape**: `bytes` holds `width * height` red, green, blue triples, row by row, the top row first.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Rgb8 {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green, blue, red, green, ...
    pub bytes: Vec<u8>,
}

impl Film {
    /// A black picture without planes.
    pub fn new(width: u32, height: u32) -> Self {
        Self { width, height, pixels: vec![[0.0; 3]; width as usize * height as usize], planes: Vec::new() }
    }

    /// The picture made of these pixels, or nothing if their number is not `width * height`.
    pub fn from_pixels(width: u32, height: u32, pixels: Vec<[f32; 3]>) -> Option<Self> {
        let count = (width as usize).checked_mul(height as usize)?;
        (pixels.len() == count).then_some(Self { width, height, pixels, planes: Vec::new() })
    }

    /// Red, green and blue at column `x`, row `y` from the top.
    ///
    /// **Panics** outside the picture.
    pub fn pixel(&self, x: u32, y: u32) -> [f32; 3] {
        assert!(x < self.width, "column {x} of a picture {} wide", self.width);
        self.pixels[y as usize * self.width as usize + x as usize]
    }

    /// The plane of [`super::Aov::SampleCount`], if there is one.
    pub(crate) fn sample_counts(&mut self) -> Option<&mut [u32]> {
        let name = super::Aov::SampleCount.channels()[0];
        match &mut self.planes.iter_mut().find(|plane| plane.name == name)?.values {
            PlaneValues::Uint(values) => Some(values),
            PlaneValues::Float(_) => None,
        }
    }

    /// The rows from the top.
    pub fn rows(&self) -> impl DoubleEndedIterator<Item = &[[f32; 3]]> {
        self.pixels.chunks_exact(self.width.max(1) as usize)
    }

    /// The values of the plane of this name.
    pub fn plane(&self, name: &str) -> Option<&PlaneValues> {
        self.planes.iter().find(|plane| plane.name == name).map(|plane| &plane.values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_run_from_the_top() {
        let pixels = (0..6).map(|i| [i as f32; 3]).collect();
        let film = Film::from_pixels(2, 3, pixels).unwrap();
        assert_eq!(film.rows().map(|row| row[0][0]).collect::<Vec<_>>(), [0.0, 2.0, 4.0]);
        assert_eq!(film.pixel(1, 2), [5.0; 3]);
    }

    #[test]
    fn a_wrong_number_of_pixels_is_refused() {
        assert_eq!(Film::from_pixels(2, 2, vec![[0.0; 3]; 3]), None);
        assert_eq!(Film::from_pixels(u32::MAX, u32::MAX, vec![[0.0; 3]; 3]), None);
    }

    #[test]
    fn an_empty_picture_has_no_rows() {
        assert_eq!(Film::new(0, 5).rows().count(), 0);
        assert_eq!(Film::new(5, 0).rows().count(), 0);
    }

    #[test]
    fn planes_are_found_by_name() {
        let mut film = Film::new(1, 1);
        film.planes.push(Plane { name: "depth.Z".into(), values: PlaneValues::Uint(vec![3]) });
        assert_eq!(film.plane("depth.Z"), Some(&PlaneValues::Uint(vec![3])));
        assert_eq!(film.plane("depth"), None);
    }
}
