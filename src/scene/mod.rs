//! The scene as compiled: columns, and what they require.

mod camera;
mod compile;
mod light;
mod material;
mod memory;
mod objects;
mod requirements;
mod texture;

pub use camera::{Camera, CameraRays, Projection};
pub use compile::{CompileError, CompileTimes};
pub use light::Light;
pub use material::{MaterialRow, Materials, NO_TEXTURE, Scatter};
pub use objects::ObjectRows;
pub use requirements::Requirements;
pub(crate) use texture::sample_eight;
pub use texture::sample_texture;

use std::sync::Arc;

use crate::accel::{Accel, Quality};
use crate::film::{AovSet, Tone};
use crate::geometry::Geometry;
use crate::intersect::TierName;
use crate::load::Texture;
use crate::math::{Lane, Vec3};
use crate::sampling::{PixelFilter, SamplerKind};

/// What rays see that hit nothing: a gradient from straight down to straight up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Background {
    /// Radiance from below.
    pub bottom: [f64; 3],
    /// Radiance from above.
    pub top: [f64; 3],
    /// Which way is up, of length one: the camera's `up` as written.
    pub up: [f64; 3],
}

impl Background {
    /// Radiance along unit directions, linear in their height above the horizon.
    #[inline(always)]
    pub fn radiance<L: Lane>(&self, direction: Vec3<L>) -> Vec3<L> {
        let splat = |c: [f64; 3]| Vec3::<L>::new(L::constant(c[0]), L::constant(c[1]), L::constant(c[2]));
        let bottom = splat(self.bottom);
        if self.bottom == self.top {
            return bottom;
        }
        let half = L::constant(0.5);
        bottom + (splat(self.top) - bottom) * (direction.dot(splat(self.up)) * half + half)
    }
}

/// How the picture is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderSettings {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples a pixel.
    pub spp: u32,
    /// Most bounces of a path: 0 shows what the camera sees directly.
    pub max_depth: u32,
    /// Shadow rays: without, all light reaches what faces it.
    pub shadows: bool,
    /// Chooses other random numbers.
    pub seed: u64,
    /// Precision.
    pub tier: TierName,
    /// Work that went into the trees.
    pub build_quality: Quality,
    /// How samples are placed.
    pub sampler: SamplerKind,
    /// How samples count by their place in the pixel.
    pub filter: PixelFilter,
    /// Paths that would bring less than this share of their radiance end.
    pub min_throughput: f64,
    /// Exposure and curve for the 8-bit formats.
    pub tone: Tone,
    /// Values beside colour.
    pub aovs: AovSet,
}

/// A scene ready to render. What is costly to make is shared with the same scene [seen otherwise](Scene::seen_by).
#[derive(Debug)]
pub struct Scene {
    /// Primitives.
    pub geometry: Arc<Geometry>,
    /// Trees over them.
    pub accel: Arc<Accel>,
    /// Materials.
    pub materials: Arc<Materials>,
    /// Textures.
    pub textures: Arc<Vec<Texture>>,
    /// Lights.
    pub lights: Vec<Light>,
    /// The camera.
    pub camera: Camera,
    /// What rays see that hit nothing.
    pub background: Background,
    /// How the picture is computed.
    pub settings: RenderSettings,
    /// What of the renderer this needs.
    pub requirements: Requirements,
    /// Which object each primitive belongs to; empty unless the settings ask for it.
    pub objects: Arc<ObjectRows>,
    /// Triangles left out because they have no area.
    pub skipped_triangles: usize,
    /// How long compiling took.
    pub times: CompileTimes,
}
