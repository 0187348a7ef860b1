//! What a scene needs of the renderer: only that is allocated, visited and run.

use super::{Camera, Light, Materials, NO_TEXTURE, Projection, Scatter};
use crate::geometry::Geometry;
use crate::intersect::PrimKind;

/// What a compiled scene needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Requirements {
    /// Kinds of primitive that rays can meet, by [`PrimKind`] number less one.
    pub kinds: [bool; 4],
    /// Hits through instances.
    pub instances: bool,
    /// Interpolated vertex normals.
    pub shading_normals: bool,
    /// Texture coordinates and texture look-ups.
    pub textures: bool,
    /// Surfaces with radiance of their own, ambient light included.
    pub glow: bool,
    /// Any light: shadow rays and direct shading.
    pub lights: bool,
    /// Materials with a highlight.
    pub highlights: bool,
    /// Highlight exponents that are not whole.
    pub fractional_shininess: bool,
    /// Bits of the largest highlight exponent.
    pub shininess_bits: u32,
    /// What becomes of rays at surfaces, by [`Scatter`] number; `Absorb` is work for nobody.
    pub scatter: [bool; 4],
    /// Points on the lens.
    pub lens: bool,
    /// Samples with weights of their own.
    pub sample_weights: bool,
}

impl Requirements {
    /// What these parts need, at bounces up to `max_depth`.
    pub fn of(
        geometry: &Geometry,
        materials: &Materials,
        lights: &[Light],
        camera: &Camera,
        max_depth: u32,
        sample_weights: bool,
    ) -> Self {
        let highlights = materials.specular.iter().flatten().any(|&k| k > 0.0) && !lights.is_empty();
        let largest = materials.shininess.iter().copied().max().unwrap_or(0);
        let bounces = |kind| max_depth > 0 && materials.scatter.contains(&kind);
        Self {
            kinds: PrimKind::ALL.map(|kind| geometry.count(kind) > 0),
            instances: !geometry.instances.is_empty(),
            shading_normals: !geometry.triangles.normal[0].is_empty(),
            textures: materials.texture.iter().any(|&t| t != NO_TEXTURE),
            glow: materials.glow.iter().flatten().any(|&c| c != 0.0),
            lights: !lights.is_empty(),
            highlights,
            fractional_shininess: highlights && materials.shininess.iter().any(|s| s & 0xff != 0),
            shininess_bits: if highlights { u32::BITS - (largest >> 8).leading_zeros() } else { 0 },
            scatter: Scatter::ALL.map(|kind| kind != Scatter::Absorb && bounces(kind)),
            lens: matches!(camera.projection, Projection::ThinLens { .. }),
            sample_weights,
        }
    }

    /// Whether a kind of primitive is there.
    pub fn has(&self, kind: PrimKind) -> bool {
        self.kinds[kind as usize - 1]
    }
    /// Whether rays go on in this way.
    pub fn scatters(&self, kind: Scatter) -> bool {
        self.scatter[kind as usize]
    }
    /// Secondary rays a path can have at one hit.
    pub fn children(&self) -> usize {
        match () {
            () if self.scatters(Scatter::Dielectric) => 2,
            () if self.scatter.contains(&true) => 1,
            () => 0,
        }
    }
}
