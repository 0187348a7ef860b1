//! Named materials, those of mesh files, and their textures, as rows.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::CompileError;
use super::rows::room;
use crate::describe::{Material, MaterialKind, SceneDescription};
use crate::load::{Texture, load_texture};
use crate::scene::{MaterialRow, Materials, NO_TEXTURE, Scatter};
use crate::shading::Shininess;

/// Rows by name, and what is needed to make more. A material becomes a row when something is made of it: what is only
/// declared requires nothing.
pub(super) struct MaterialTable {
    rows: Materials,
    /// With their numbers, from 1.
    declared: HashMap<String, (u32, Material)>,
    /// Number of the next material that is not declared.
    next_id: u32,
    /// Rows by name; that of objects without a material has none.
    by_name: HashMap<Option<String>, u32>,
    textures: Vec<Texture>,
    texture_of: HashMap<PathBuf, u32>,
    folder: PathBuf,
    ambient: [f64; 3],
}

impl MaterialTable {
    pub(super) fn new(description: &SceneDescription) -> Self {
        Self {
            rows: Materials::default(),
            declared: (1..)
                .zip(&description.material)
                .map(|(id, m)| (m.name.clone(), (id, m.clone())))
                .collect(),
            next_id: description.material.len() as u32 + 1,
            by_name: HashMap::new(),
            textures: Vec::new(),
            texture_of: HashMap::new(),
            folder: description.folder.clone(),
            ambient: description.background.ambient(),
        }
    }

    /// The row of a material's name; that of a plain grey one without.
    pub(super) fn row(&mut self, name: Option<&str>) -> Result<u32, CompileError> {
        let key = name.map(str::to_owned);
        if let Some(&row) = self.by_name.get(&key) {
            return Ok(row);
        }
        let declared = name.and_then(|name| self.declared.get(name)).cloned();
        let (id, mut material) = declared.unwrap_or_else(|| (0, Material::new("", MaterialKind::Diffuse)));
        material.texture = material.texture.map(|path| self.folder.join(path));
        let row = self.push(&material, id)?;
        self.by_name.insert(key, row);
        Ok(row)
    }

    /// A new row for a material whose texture path is complete, as those of mesh files are.
    pub(super) fn add(&mut self, m: &Material) -> Result<u32, CompileError> {
        self.next_id += 1;
        self.push(m, self.next_id - 1)
    }

    fn push(&mut self, m: &Material, id: u32) -> Result<u32, CompileError> {
        room("materials", self.rows.len() + 1)?;
        let texture = m.texture.as_deref().map_or(Ok(NO_TEXTURE), |path| self.texture(path))?;
        let (ka, tint, emission) = (m.ka(), m.tint(), m.emission());
        let glow = std::array::from_fn(|c| (ka[c] * self.ambient[c] + emission[c]) as f32);
        Ok(self.rows.push(MaterialRow {
            glow,
            diffuse: m.kd().map(|k| k as f32),
            specular: m.ks().map(|k| k as f32),
            tint: tint.map(|k| (k * m.attenuation) as f32),
            shininess: Shininess::new(m.shininess as f32).word(),
            ior: m.ior as f32,
            scatter: scatter(m),
            texture,
            id,
        }))
    }

    fn texture(&mut self, path: &Path) -> Result<u32, CompileError> {
        if let Some(&row) = self.texture_of.get(path) {
            return Ok(row);
        }
        let row = self.textures.len() as u32;
        self.textures.push(load_texture(path)?);
        self.texture_of.insert(path.to_owned(), row);
        Ok(row)
    }

    pub(super) fn finish(self) -> (Materials, Vec<Texture>) {
        (self.rows, self.textures)
    }
}

/// What becomes of rays at a material. A tint of zero brings nothing back, so no ray need go.
fn scatter(m: &Material) -> Scatter {
    let brings_nothing = m.tint().iter().all(|&k| k * m.attenuation == 0.0);
    match m.kind {
        _ if brings_nothing => Scatter::Absorb,
        MaterialKind::Diffuse if m.bounce => Scatter::Diffuse,
        MaterialKind::Diffuse => Scatter::Absorb,
        MaterialKind::Metal => Scatter::Metal,
        MaterialKind::Dielectric => Scatter::Dielectric,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::describe::Camera;

    #[test]
    fn materials_are_as_many_as_shapes_may_be() {
        let camera = Camera::perspective([0.0; 3], [0.0, 0.0, 1.0], 40.0);
        let mut table = MaterialTable::new(&SceneDescription::new(camera));
        let glass = Material::new("glass", MaterialKind::Dielectric);
        let rows: Vec<u32> = (0..70_000).map(|_| table.add(&glass).unwrap()).collect();
        assert!(rows.iter().copied().eq(0..70_000));
    }
}
