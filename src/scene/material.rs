//! Materials as columns.

use crate::geometry::push3;

/// What a surface does with rays beyond the light it gets directly.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Scatter {
    /// Nothing: shaded by lights alone.
    Absorb = 0,
    /// One cosine-distributed bounce.
    Diffuse = 1,
    /// A mirror.
    Metal = 2,
    /// Reflection and refraction, weighted by Fresnel's formulas.
    Dielectric = 3,
}

impl Scatter {
    /// All kinds, in the order of their numbers.
    pub const ALL: [Self; 4] = [Self::Absorb, Self::Diffuse, Self::Metal, Self::Dielectric];
    /// Name as printed.
    pub fn name(self) -> &'static str {
        ["no bounce", "diffuse bounce", "mirror reflection", "reflection and refraction"][self as usize]
    }
}

/// No texture.
pub const NO_TEXTURE: u32 = u32::MAX;

/// One row of the material columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaterialRow {
    /// Radiance that does not depend on lights: ambient coefficient times ambient colour, plus emission.
    pub glow: [f32; 3],
    /// Diffuse coefficient.
    pub diffuse: [f32; 3],
    /// Specular coefficient.
    pub specular: [f32; 3],
    /// Factor on the radiance that secondary rays bring: tint times attenuation.
    pub tint: [f32; 3],
    /// Exponent of the highlight in units of 1/256.
    pub shininess: u32,
    /// Index of refraction.
    pub ior: f32,
    /// What becomes of rays.
    pub scatter: Scatter,
    /// Texture row on the diffuse coefficient, or [`NO_TEXTURE`].
    pub texture: u32,
    /// Number as pictures show it ([`crate::film::Aov::MaterialId`]).
    pub id: u32,
}

/// All materials of a scene, by column.
#[derive(Clone, Debug, Default)]
pub struct Materials {
    /// See [`MaterialRow::glow`].
    pub glow: [Vec<f32>; 3],
    /// See [`MaterialRow::diffuse`].
    pub diffuse: [Vec<f32>; 3],
    /// See [`MaterialRow::specular`].
    pub specular: [Vec<f32>; 3],
    /// See [`MaterialRow::tint`].
    pub tint: [Vec<f32>; 3],
    /// See [`MaterialRow::shininess`].
    pub shininess: Vec<u32>,
    /// See [`MaterialRow::ior`].
    pub ior: Vec<f32>,
    /// See [`MaterialRow::scatter`].
    pub scatter: Vec<Scatter>,
    /// See [`MaterialRow::texture`].
    pub texture: Vec<u32>,
    /// See [`MaterialRow::id`].
    pub id: Vec<u32>,
}

impl Materials {
    /// Number of rows.
    pub fn len(&self) -> usize {
        self.ior.len()
    }
    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.ior.is_empty()
    }
    /// Appends a row and gives its number.
    pub fn push(&mut self, row: MaterialRow) -> u32 {
        push3(&mut self.glow, row.glow);
        push3(&mut self.diffuse, row.diffuse);
        push3(&mut self.specular, row.specular);
        push3(&mut self.tint, row.tint);
        self.shininess.push(row.shininess);
        self.ior.push(row.ior);
        self.scatter.push(row.scatter);
        self.texture.push(row.texture);
        self.id.push(row.id);
        self.len() as u32 - 1
    }
}
