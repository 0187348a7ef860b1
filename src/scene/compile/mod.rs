//! From what the user wrote to columns: the guarded border, past which nothing needs checking.

mod flatten;
mod materials;
mod mesh;
mod rows;
mod view;
mod world;

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::{Background, Materials, ObjectRows, RenderSettings, Requirements, Scene};
use crate::accel::Accel;
use crate::describe::{Fault, SceneDescription};
use crate::film::Aov;
use crate::geometry::Geometry;
use crate::intersect::TierName;
use crate::load::{KeptMeshes, LoadError, Texture};
use crate::math::TransformError;
use materials::MaterialTable;
use world::{Filled, World};

/// Why a description cannot become a scene.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CompileError {
    /// The description breaks a rule of its own.
    #[error("{}", .0.iter().map(Fault::to_string).collect::<Vec<_>>().join("\n"))]
    Description(Vec<Fault>),
    /// A mesh or texture file.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// A transform, alone or composed with those around it.
    #[error("{what}: {source}")]
    Transform {
        /// Which object.
        what: String,
        /// What is wrong with it.
        source: TransformError,
    },
    /// A number that is fine as written but not in `f32`, the number type of primitives.
    #[error(
        "{what}: {value} is out of range: sizes and positions are stored with 24 bits and exponents to 1e38"
    )]
    OutOfRange {
        /// Which number of which object.
        what: String,
        /// As written, with transforms applied.
        value: f64,
    },
    /// More than the columns can count.
    #[error("more than {limit} {what}")]
    TooMany {
        /// Of what.
        what: &'static str,
        /// The most there can be.
        limit: usize,
    },
}

/// How long compiling took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CompileTimes {
    /// Reading meshes and textures, and filling columns.
    pub load: Duration,
    /// Building trees.
    pub build: Duration,
}

impl Scene {
    /// Compiles a description: loads its meshes and textures, fills columns, builds trees.
    ///
    /// **Errors:** [`CompileError`], naming the object.
    pub fn compile(description: &SceneDescription) -> Result<Self, CompileError> {
        Self::compile_with(description, &KeptMeshes::default())
    }

    /// As [`Scene::compile`], with meshes that may have been loaded to make the description. Those that it names more than
    /// once are loaded once, and kept no longer than needed.
    ///
    /// **Errors:** [`CompileError`], naming the object.
    pub fn compile_with(description: &SceneDescription, meshes: &KeptMeshes) -> Result<Self, CompileError> {
        meshes.expect(description);
        Self::compile_like(description, meshes, None)
    }

    /// As [`Scene::compile`], with meshes that may be kept from before, and a tree that may be that of `like`, moved.
    ///
    /// Hits are those of a new tree in all tiers but `fast`, which therefore has a new one.
    ///
    /// **Errors:** [`CompileError`], naming the object.
    pub fn compile_like(
        description: &SceneDescription,
        meshes: &KeptMeshes,
        like: Option<&Self>,
    ) -> Result<Self, CompileError> {
        let start = Instant::now();
        description.check().map_err(CompileError::Description)?;
        let mut table = MaterialTable::new(description);
        let settings = RenderSettings::of(description);
        let objects = ObjectRows::wanted(settings.aovs.has(Aov::ObjectId));
        let Filled { geometry, objects, skipped_triangles } =
            World::compile(description, &mut table, meshes, objects)?;
        let (materials, textures) = table.finish();
        let load = start.elapsed();
        let like = like.filter(|_| settings.tier != TierName::Fast);
        let accel = like.and_then(|like| refitted(&like.accel, &geometry));
        let accel = accel.unwrap_or_else(|| Accel::build_with(&geometry, settings.build_quality));
        let times = CompileTimes { load, build: start.elapsed() - load };
        let columns = Columns {
            geometry: Arc::new(geometry),
            accel: Arc::new(accel),
            materials: Arc::new(materials),
            textures: Arc::new(textures),
            objects: Arc::new(objects),
            skipped_triangles,
        };
        Ok(Self { times, ..columns.seen_by(description)? })
    }

    /// The same objects by the camera, lights and settings of another description, which must be checked and describe the
    /// same objects, materials and background. Nothing is loaded or built.
    ///
    /// **Errors:** [`CompileError`], for a camera that cannot be.
    pub fn seen_by(&self, description: &SceneDescription) -> Result<Self, CompileError> {
        let columns = Columns {
            geometry: Arc::clone(&self.geometry),
            accel: Arc::clone(&self.accel),
            materials: Arc::clone(&self.materials),
            textures: Arc::clone(&self.textures),
            objects: Arc::clone(&self.objects),
            skipped_triangles: self.skipped_triangles,
        };
        columns.seen_by(description)
    }
}

/// A tree over primitives that moved, if it is one over these.
fn refitted(accel: &Accel, geometry: &Geometry) -> Option<Accel> {
    let mut moved = accel.clone();
    moved.refit(geometry).is_ok().then_some(moved)
}

/// What of a scene does not depend on who looks at it.
struct Columns {
    geometry: Arc<Geometry>,
    accel: Arc<Accel>,
    materials: Arc<Materials>,
    textures: Arc<Vec<Texture>>,
    objects: Arc<ObjectRows>,
    skipped_triangles: usize,
}

impl Columns {
    fn seen_by(self, description: &SceneDescription) -> Result<Scene, CompileError> {
        let Self { geometry, accel, materials, textures, objects, skipped_triangles } = self;
        let settings = RenderSettings::of(description);
        let camera = view::camera(description)?;
        let lights = view::lights(description);
        let weights = settings.filter.has_negative_lobes();
        let requirements =
            Requirements::of(&geometry, &materials, &lights, &camera, settings.max_depth, weights);
        let background = Background::of(description);
        Ok(Scene {
            geometry,
            accel,
            materials,
            textures,
            lights,
            camera,
            background,
            settings,
            requirements,
            objects,
            skipped_triangles,
            times: CompileTimes::default(),
        })
    }
}
