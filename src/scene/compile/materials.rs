//! Named materials, those of mesh files, and their textures, as rows.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::CompileError;
use crate::describe::{Material, MaterialKind, SceneDescription};
use crate::load::{Texture, load_texture};
use crate::scene::{MaterialRow, Materials, NO_TEXTURE, Scatter};
use crate::shading::Shininess;

/// Most material rows: a dielectric's row plus one fits the 16 bits of the nesting record.
const MAX_ROWS: usize = u16::MAX as usize;

/// Rows by name, and what is needed to make more.
pub(super) struct MaterialTable {
    rows: Materials,
    by_name: HashMap<String, u32>,
    textures: Vec<Texture>,
    texture_of: HashMap<PathBuf, u32>,
    folder: PathBuf,
    ambient: [f64; 3],
    plain: Option<u32>,
}

impl MaterialTable {
    pub(super) fn new(description: &SceneDescription) -> Result<Self, CompileError> {
        let mut table = Self {
            rows: Materials::default(),
            by_name: HashMap::new(),
            textures: Vec::new(),
            texture_of: HashMap::new(),
            folder: description.folder.clone(),
            ambient: description.background.ambient(),
            plain: None,
        };
        for material in &description.material {
            let texture = material.texture.as_ref().map(|path| table.folder.join(path));
            let row = table.add(&Material { texture, ..material.clone() })?;
            table.by_name.insert(material.name.clone(), row);
        }
        Ok(table)
    }

    /// The row of a material's name; that of a plain grey one without.
    pub(super) fn row(&mut self, name: Option<&str>) -> Result<u32, CompileError> {
        match (name.and_then(|n| self.by_name.get(n)), self.plain) {
            (Some(&row), _) | (None, Some(row)) => Ok(row),
            (None, None) => {
                let row = self.add(&Material::new("", MaterialKind::Diffuse))?;
                self.plain = Some(row);
                Ok(row)
            }
        }
    }

    /// A new row for a material whose texture path is complete, as those of mesh files are.
    pub(super) fn add(&mut self, m: &Material) -> Result<u32, CompileError> {
        if self.rows.len() == MAX_ROWS {
            return Err(CompileError::TooMany { what: "materials", limit: MAX_ROWS });
        }
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
