//! What a picture can hold beside colour: the surface seen through the centre of each pixel, measured exactly.
//!
//! These values are not filtered: each is that of the one ray through the pixel's centre (and the centre of the lens), so
//! ids are never mixed and depth has no values between two surfaces. Seed and samples have no part in them.

mod sample;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Plane, PlaneValues};
pub use sample::AovSample;

/// One kind of value beside colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Aov {
    /// Distance along the view axis from the plane through the camera, in world units; infinite where nothing is hit.
    Depth,
    /// Point in the world.
    Position,
    /// Unit normal of the surface itself, on the side seen from the camera.
    GeometricNormal,
    /// Unit normal that shading uses, on the side seen from the camera.
    ShadingNormal,
    /// Texture coordinates.
    Uv,
    /// Number of the object, from 1 in the order spheres, cylinders, triangles, quads, planes, meshes, instances, and in
    /// each kind in the order of the scene file; all that an instance shows has the instance's number.
    ObjectId,
    /// Number of the primitive ([`crate::PrimId`]): unique in the scene but for repetitions through instances.
    PrimitiveId,
    /// Number of the material, from 1 in the order of the scene file, then those of mesh files; 0 without material.
    MaterialId,
    /// Diffuse coefficient, textures applied.
    Albedo,
    /// 1 where something is hit.
    Hit,
    /// How many samples the colour is made of.
    SampleCount,
}

impl Aov {
    /// Every kind.
    pub const ALL: [Self; 11] = [
        Self::Depth,
        Self::Position,
        Self::GeometricNormal,
        Self::ShadingNormal,
        Self::Uv,
        Self::ObjectId,
        Self::PrimitiveId,
        Self::MaterialId,
        Self::Albedo,
        Self::Hit,
        Self::SampleCount,
    ];
    /// The names in scene files and on the command line, in the order of [`Aov::ALL`].
    pub const NAMES: [&'static str; 11] = [
        "depth",
        "position",
        "geometric_normal",
        "shading_normal",
        "uv",
        "object_id",
        "primitive_id",
        "material_id",
        "albedo",
        "hit",
        "sample_count",
    ];

    /// The name in scene files and on the command line.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }

    /// Names of its channels in a file: a layer, a dot, a component.
    pub fn channels(self) -> &'static [&'static str] {
        match self {
            Self::Depth => &["depth.Z"],
            Self::Position => &["P.X", "P.Y", "P.Z"],
            Self::GeometricNormal => &["Ng.X", "Ng.Y", "Ng.Z"],
            Self::ShadingNormal => &["N.X", "N.Y", "N.Z"],
            Self::Uv => &["uv.U", "uv.V"],
            Self::ObjectId => &["id.object"],
            Self::PrimitiveId => &["id.primitive"],
            Self::MaterialId => &["id.material"],
            Self::Albedo => &["albedo.R", "albedo.G", "albedo.B"],
            Self::Hit => &["mask.hit"],
            Self::SampleCount => &["samples.count"],
        }
    }

    /// Whether its values are whole numbers.
    pub fn is_uint(self) -> bool {
        matches!(self, Self::ObjectId | Self::PrimitiveId | Self::MaterialId | Self::Hit | Self::SampleCount)
    }
}

impl std::str::FromStr for Aov {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let known = Self::NAMES.iter().position(|known| *known == name);
        known
            .map(|index| Self::ALL[index])
            .ok_or_else(|| format!("unknown AOV `{name}`; known are {}", Self::NAMES.join(", ")))
    }
}

/// Some kinds of value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AovSet(u16);

impl AovSet {
    /// Whether a kind is in it.
    pub fn has(self, aov: Aov) -> bool {
        self.0 >> aov as u32 & 1 != 0
    }
    /// Whether none is in it.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }
    /// The kinds in it, in the order of [`Aov::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Aov> {
        Aov::ALL.into_iter().filter(move |&aov| self.has(aov))
    }
    /// Whether any of it has to be looked for in the scene.
    pub fn needs_rays(self) -> bool {
        self.iter().any(|aov| aov != Aov::SampleCount)
    }
    /// One plane of zeros for each channel, in the order of [`AovSet::iter`].
    pub fn planes(self, pixels: usize) -> Vec<Plane> {
        let plane = |aov: Aov, name: &&str| Plane {
            name: (*name).to_owned(),
            values: match aov.is_uint() {
                true => PlaneValues::Uint(vec![0; pixels]),
                false => PlaneValues::Float(vec![0.0; pixels]),
            },
        };
        self.iter().flat_map(|aov| aov.channels().iter().map(move |name| plane(aov, name))).collect()
    }
}

impl FromIterator<Aov> for AovSet {
    fn from_iter<I: IntoIterator<Item = Aov>>(aovs: I) -> Self {
        Self(aovs.into_iter().fold(0, |set, aov| set | 1 << aov as u32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_has_its_name_in_files_and_on_the_command_line() {
        for aov in Aov::ALL {
            assert_eq!(aov.name().parse(), Ok(aov));
            assert_eq!(serde_json::to_value(aov).unwrap(), aov.name());
        }
        assert!("normal".parse::<Aov>().unwrap_err().contains("shading_normal"));
    }
}
