//! How much memory columns take.

use super::Geometry;

/// Bytes that a column holds.
pub(crate) fn bytes<T>(column: &[T]) -> u64 {
    size_of_val(column) as u64
}

/// Bytes that several columns hold.
pub(crate) fn bytes_of<T, const N: usize>(columns: &[Vec<T>; N]) -> u64 {
    columns.iter().map(|c| bytes(c)).sum()
}

impl Geometry {
    /// Name and bytes of each group of columns.
    pub fn memory(&self) -> Vec<(String, u64)> {
        let (t, s, c, p) = (&self.triangles, &self.spheres, &self.cylinders, &self.planes);
        let sizes = [
            ("triangles.position", bytes_of(&t.position)),
            ("triangles.normal", bytes_of(&t.normal)),
            ("triangles.uv", bytes_of(&t.uv)),
            ("triangles.vertex", bytes_of(&t.vertex)),
            ("triangles.material", bytes(&t.material)),
            ("spheres", bytes_of(&s.center) + bytes(&s.radius) + bytes(&s.material)),
            (
                "cylinders",
                bytes_of(&c.from)
                    + bytes_of(&c.to)
                    + bytes(&c.radius)
                    + bytes(&c.capped)
                    + bytes(&c.material),
            ),
            ("planes", bytes_of(&p.point) + bytes_of(&p.normal) + bytes(&p.material)),
            ("instances", bytes(&self.instances)),
        ];
        sizes.map(|(name, size)| (name.to_owned(), size)).to_vec()
    }
}
