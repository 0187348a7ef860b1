//! What a picture can hold beside colour: the surface seen through the centre of each pixel, measured exactly.
//!
//! These values are not filtered: each is that of the one ray through the pixel's centre (and the centre of the lens), so
//! ids are never mixed and depth has no values between two surfaces. Seed and samples have no part in them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Plane, PlaneValues};

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

/// What the ray through the centre of one pixel found; the default is nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AovSample {
    /// See [`Aov::Depth`].
    pub depth: f32,
    /// See [`Aov::Position`].
    pub position: [f32; 3],
    /// See [`Aov::GeometricNormal`].
    pub geometric_normal: [f32; 3],
    /// See [`Aov::ShadingNormal`].
    pub shading_normal: [f32; 3],
    /// See [`Aov::Uv`].
    pub uv: [f32; 2],
    /// See [`Aov::Albedo`].
    pub albedo: [f32; 3],
    /// See [`Aov::ObjectId`].
    pub object: u32,
    /// See [`Aov::PrimitiveId`].
    pub primitive: u32,
    /// See [`Aov::MaterialId`].
    pub material: u32,
    /// See [`Aov::Hit`].
    pub hit: bool,
}

impl Default for AovSample {
    fn default() -> Self {
        Self {
            depth: f32::INFINITY,
            position: [0.0; 3],
            geometric_normal: [0.0; 3],
            shading_normal: [0.0; 3],
            uv: [0.0; 2],
            albedo: [0.0; 3],
            object: 0,
            primitive: 0,
            material: 0,
            hit: false,
        }
    }
}

impl AovSample {
    /// Writes the pixel `at` of the planes that [`AovSet::planes`] made; sample counts are not its matter.
    pub fn store(&self, set: AovSet, planes: &mut [Plane], at: usize) {
        let mut planes = planes.iter_mut();
        for aov in set.iter() {
            for channel in 0..aov.channels().len() {
                match &mut planes.next().expect("a plane for each channel").values {
                    PlaneValues::Float(values) => values[at] = self.float(aov, channel),
                    PlaneValues::Uint(values) if aov != Aov::SampleCount => values[at] = self.uint(aov),
                    PlaneValues::Uint(_) => {}
                }
            }
        }
    }

    fn float(&self, aov: Aov, channel: usize) -> f32 {
        match aov {
            Aov::Depth => self.depth,
            Aov::Position => self.position[channel],
            Aov::GeometricNormal => self.geometric_normal[channel],
            Aov::ShadingNormal => self.shading_normal[channel],
            Aov::Uv => self.uv[channel],
            Aov::Albedo => self.albedo[channel],
            _ => unreachable!("{} is a whole number", aov.name()),
        }
    }

    fn uint(&self, aov: Aov) -> u32 {
        match aov {
            Aov::ObjectId => self.object,
            Aov::PrimitiveId => self.primitive,
            Aov::MaterialId => self.material,
            _ => u32::from(self.hit),
        }
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

    #[test]
    fn values_go_to_the_planes_of_their_names() {
        let set: AovSet = [Aov::ObjectId, Aov::Depth, Aov::Uv].into_iter().collect();
        let mut planes = set.planes(2);
        AovSample { depth: 2.0, uv: [0.25, 0.75], object: 7, ..Default::default() }.store(
            set,
            &mut planes,
            0,
        );
        AovSample::default().store(set, &mut planes, 1);
        let found: Vec<_> = planes.iter().map(|plane| (plane.name.as_str(), &plane.values)).collect();
        let expected = [
            ("depth.Z", &PlaneValues::Float(vec![2.0, f32::INFINITY])),
            ("uv.U", &PlaneValues::Float(vec![0.25, 0.0])),
            ("uv.V", &PlaneValues::Float(vec![0.75, 0.0])),
            ("id.object", &PlaneValues::Uint(vec![7, 0])),
        ];
        assert_eq!(found, expected);
    }
}
