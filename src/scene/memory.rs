//! How much memory columns take.

use super::{Geometry, Scene};

/// Bytes that a column holds.
fn bytes<T>(column: &[T]) -> u64 {
    size_of_val(column) as u64
}

fn bytes_of<T, const N: usize>(columns: &[Vec<T>; N]) -> u64 {
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

impl Scene {
    /// Name and bytes of materials and textures.
    pub fn surface_memory(&self) -> Vec<(String, u64)> {
        let m = &self.materials;
        let colors = bytes_of(&m.glow) + bytes_of(&m.diffuse) + bytes_of(&m.specular) + bytes_of(&m.tint);
        let rest = bytes(&m.shininess) + bytes(&m.ior) + bytes(&m.scatter) + bytes(&m.texture);
        let textures = self.textures.iter().map(|t| bytes(&t.texels)).sum();
        vec![("materials".to_owned(), colors + rest), ("textures".to_owned(), textures)]
    }
}
