//! What surfaces are made of.

use super::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A material, as written: `None` is "not said", and the accessor of the same name gives the default of the kind.
///
/// | key | diffuse | metal | dielectric |
/// |---|---|---|---|
/// | `ka` | 0.1 | 0 | 0 |
/// | `kd` | 0.8 | 0 | 0 |
/// | `ks` | 0 | 0.5 | 0.5 |
/// | `tint` | `kd` | 1 | 1 |
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// The name that objects use.
    pub name: String,
    /// `diffuse` (default), `metal` or `dielectric`.
    #[serde(default)]
    pub kind: MaterialKind,
    /// Ambient coefficient: multiplies the background's `ambient`.
    #[serde(default)]
    pub ka: Option<Rgb>,
    /// Diffuse coefficient: multiplies each light's irradiance and the cosine.
    #[serde(default)]
    pub kd: Option<Rgb>,
    /// Specular coefficient: height of the Blinn-Phong highlight of each light.
    #[serde(default)]
    pub ks: Option<Rgb>,
    /// Colour of secondary rays: `tint x attenuation` multiplies reflected, refracted and scattered light.
    #[serde(default)]
    pub tint: Option<Rgb>,
    /// Blinn-Phong exponent, 0 to 65536. Default 100.
    #[serde(default = "default_shininess")]
    pub shininess: f64,
    /// Strength of secondary rays. Default 1.
    #[serde(default = "default_one")]
    pub attenuation: f64,
    /// Index of refraction of the body, dielectric only. Default 1.5 (glass); outside of all bodies it is 1.
    /// In nested bodies the innermost counts: a bubble in glass is a body of its own with 1.
    #[serde(default = "default_ior")]
    pub ior: f64,
    /// Diffuse only: also scatter one ray with the cosine law. Default false.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub bounce: bool,
    /// Light the surface gives off by itself. Default 0.
    #[serde(default)]
    pub emission: Option<Rgb>,
    /// Picture (PNG or JPEG, sRGB) that multiplies `kd`, relative to the scene file. Needs texture coordinates.
    #[serde(default)]
    pub texture: Option<PathBuf>,
}

/// Which secondary rays a material sends.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MaterialKind {
    /// None, or one scattered with the cosine law when `bounce` is set.
    #[default]
    Diffuse,
    /// One mirrored.
    Metal,
    /// One mirrored and one refracted, weighted by Fresnel's law.
    Dielectric,
}

impl Material {
    /// A material of a kind with every other key left out.
    #[must_use]
    pub fn new(name: impl Into<String>, kind: MaterialKind) -> Material {
        Material {
            name: name.into(),
            kind,
            ka: None,
            kd: None,
            ks: None,
            tint: None,
            shininess: default_shininess(),
            attenuation: default_one(),
            ior: default_ior(),
            bounce: false,
            emission: None,
            texture: None,
        }
    }

    /// Ambient coefficient, with its default resolved.
    #[must_use]
    pub fn ka(&self) -> [f64; 3] {
        self.by_kind(self.ka, [0.1, 0.0, 0.0])
    }

    /// Diffuse coefficient, with its default resolved.
    #[must_use]
    pub fn kd(&self) -> [f64; 3] {
        self.by_kind(self.kd, [0.8, 0.0, 0.0])
    }

    /// Specular coefficient, with its default resolved.
    #[must_use]
    pub fn ks(&self) -> [f64; 3] {
        self.by_kind(self.ks, [0.0, 0.5, 0.5])
    }

    /// Colour of secondary rays, with its default resolved.
    #[must_use]
    pub fn tint(&self) -> [f64; 3] {
        match (self.tint, self.kind) {
            (Some(tint), _) => tint.0,
            (None, MaterialKind::Diffuse) => self.kd(),
            (None, _) => [1.0; 3],
        }
    }

    /// Light given off, with its default resolved.
    #[must_use]
    pub fn emission(&self) -> [f64; 3] {
        self.emission.unwrap_or(Rgb::BLACK).0
    }

    fn by_kind(&self, written: Option<Rgb>, [diffuse, metal, dielectric]: [f64; 3]) -> [f64; 3] {
        let default = match self.kind {
            MaterialKind::Diffuse => diffuse,
            MaterialKind::Metal => metal,
            MaterialKind::Dielectric => dielectric,
        };
        written.unwrap_or(Rgb::grey(default)).0
    }
}

fn default_shininess() -> f64 {
    100.0
}

fn default_one() -> f64 {
    1.0
}

fn default_ior() -> f64 {
    1.5
}
