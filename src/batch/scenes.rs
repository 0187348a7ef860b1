//! Scenes that pictures share: compiled once, kept as long as there is room.

use std::sync::{Arc, Mutex, MutexGuard, OnceLock};

use super::BatchError;
use super::assets::hash;
use super::source::Source;
use super::threads::workers;
use crate::describe::{Camera, Lights, Render, SceneDescription};
use crate::load::KeptMeshes;
use crate::scene::Scene;

/// A scene that is or will be compiled; a failure is kept too, so that it is met once.
type Slot = Arc<OnceLock<Result<Arc<Scene>, String>>>;

/// One scene.
#[derive(Clone)]
struct Entry {
    /// What it is made of.
    key: String,
    /// The same without transforms.
    shape: String,
    slot: Slot,
    /// Whether its tree was built for it, not moved from another.
    is_built: bool,
}

/// The scenes of a batch by what they are made of: camera, lights and settings may differ from picture to picture.
pub(super) struct Scenes<'a> {
    source: &'a Source,
    common: &'a [String],
    workers: rayon::ThreadPool,
    max_bytes: u64,
    meshes: &'a KeptMeshes,
    /// The one used last stands last.
    kept: Mutex<Vec<Entry>>,
}

impl<'a> Scenes<'a> {
    pub(super) fn new(
        source: &'a Source,
        common: &'a [String],
        threads: usize,
        max_bytes: u64,
        meshes: &'a KeptMeshes,
    ) -> Result<Self, BatchError> {
        Ok(Self { source, common, workers: workers(threads)?, max_bytes, meshes, kept: Mutex::default() })
    }

    /// The scene of a picture with these changes; `taken` bytes of the memory are other things'.
    pub(super) fn scene(&self, sets: &[String], taken: u64) -> Result<Scene, BatchError> {
        let sets: Vec<String> = self.common.iter().chain(sets).cloned().collect();
        let description = self.source.with(&sets)?;
        let (entry, like) = self.entry(&description);
        let compile = || self.compile(&description, like.as_deref());
        let shared = entry.slot.get_or_init(compile).clone().map_err(BatchError::Job)?;
        self.make_room(self.max_bytes.saturating_sub(taken));
        Ok(shared.seen_by(&description)?)
    }

    fn compile(&self, description: &SceneDescription, like: Option<&Scene>) -> Result<Arc<Scene>, String> {
        tracing::info!(moved = like.is_some(), "scene compiled");
        let compiled = self.workers.install(|| Scene::compile_like(description, self.meshes, like));
        compiled.map(Arc::new).map_err(|error| error.to_string())
    }

    /// The place of a scene, and one of the same shape whose tree it may take.
    fn entry(&self, description: &SceneDescription) -> (Entry, Option<Arc<Scene>>) {
        let mut costly = costly(description);
        let key = key(&costly);
        costly.forget_transforms();
        let shape = self::key(&costly);
        let mut kept = self.kept();
        // Always a tree that was built: boxes that were moved again and again would grow.
        let of_shape = |entry: &&Entry| entry.shape == shape && entry.is_built;
        let like = kept.iter().find(of_shape).and_then(|entry| entry.slot.get()?.clone().ok());
        let known = kept.iter().position(|entry| entry.key == key);
        let new = || Entry { key, shape, slot: Slot::default(), is_built: like.is_none() };
        let entry = known.map_or_else(new, |at| kept.remove(at));
        kept.push(entry.clone());
        (entry, like)
    }

    fn kept(&self) -> MutexGuard<'_, Vec<Entry>> {
        self.kept.lock().expect("nobody panics while scenes are looked up")
    }

    /// Forgets what was not used for longest until the rest fits into so many bytes; the last scene stays.
    fn make_room(&self, max_bytes: u64) {
        let mut kept = self.kept();
        let size = |entry: &Entry| match entry.slot.get() {
            Some(Ok(scene)) => scene.size_bytes(),
            _ => 0,
        };
        let mut total: u64 = kept.iter().map(size).sum();
        if total + self.meshes.size_bytes() > max_bytes {
            self.meshes.forget();
        }
        while total > max_bytes && kept.len() > 1 {
            // Trees that others are moved from go last.
            let at = kept[..kept.len() - 1].iter().position(|entry| !entry.is_built).unwrap_or(0);
            total -= size(&kept.remove(at));
        }
    }
}

/// What of a scene is costly to compile.
fn costly(description: &SceneDescription) -> SceneDescription {
    let (render, aovs) = (&description.render, &description.render.aovs);
    let mut costly = SceneDescription {
        camera: Camera::perspective([0.0; 3], [0.0, 0.0, 1.0], 40.0),
        light: Lights::default(),
        ..description.clone()
    };
    costly.render = Render {
        build_quality: render.build_quality,
        tier: render.tier,
        aovs: aovs.clone(),
        ..Render::default()
    };
    costly
}

fn key(costly: &SceneDescription) -> String {
    hash(&serde_json::to_vec(costly).expect("a description has only text and numbers"))
}
