//! How much memory materials and textures take.

use super::Scene;
use crate::geometry::{bytes, bytes_of};

impl Scene {
    /// Bytes of all that the scene holds.
    pub fn size_bytes(&self) -> u64 {
        let columns =
            self.geometry.memory().into_iter().chain(self.accel.memory()).chain(self.surface_memory());
        columns.map(|column| column.1).sum()
    }

    /// Name and bytes of materials and textures.
    pub fn surface_memory(&self) -> Vec<(String, u64)> {
        let m = &self.materials;
        let colors = bytes_of(&m.glow) + bytes_of(&m.diffuse) + bytes_of(&m.specular) + bytes_of(&m.tint);
        let rest = bytes(&m.shininess) + bytes(&m.ior) + bytes(&m.scatter) + bytes(&m.texture);
        let textures = self.textures.iter().map(|t| bytes(&t.texels)).sum();
        vec![("materials".to_owned(), colors + rest), ("textures".to_owned(), textures)]
    }
}
