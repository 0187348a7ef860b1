//! Scenes that pictures share: compiled once, kept as long as there is room.

use std::sync::{Arc, Mutex, OnceLock};

use super::BatchError;
use super::assets::hash;
use super::source::Source;
use crate::describe::{Camera, Lights, Render, SceneDescription};
use crate::scene::Scene;
use crate::wavefront::RenderError;

/// A scene that is or will be compiled; a failure is kept too, so that it is met once.
type Slot = Arc<OnceLock<Result<Arc<Scene>, String>>>;

/// The scenes of a batch by what they are made of: camera, lights and settings may differ from picture to picture.
pub(super) struct Scenes<'a> {
    source: &'a Source,
    common: &'a [String],
    workers: rayon::ThreadPool,
    max_bytes: u64,
    /// The one used last stands last.
    kept: Mutex<Vec<(String, Slot)>>,
}

impl<'a> Scenes<'a> {
    pub(super) fn new(
        source: &'a Source,
        common: &'a [String],
        threads: usize,
        max_bytes: u64,
    ) -> Result<Self, BatchError> {
        let workers =
            rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(RenderError::from)?;
        Ok(Self { source, common, workers, max_bytes, kept: Mutex::default() })
    }

    /// The scene of a picture with these changes.
    pub(super) fn scene(&self, sets: &[String]) -> Result<Scene, BatchError> {
        let sets: Vec<String> = self.common.iter().chain(sets).cloned().collect();
        let description = self.source.with(&sets)?;
        let slot = self.slot(key(&description));
        let compile =
            || self.workers.install(|| Scene::compile(&description)).map(Arc::new).map_err(|e| e.to_string());
        let shared = slot.get_or_init(compile).clone().map_err(BatchError::Job)?;
        self.make_room();
        Ok(shared.seen_by(&description)?)
    }

    fn slot(&self, key: String) -> Slot {
        let mut kept = self.kept.lock().expect("nobody panics while scenes are looked up");
        let known = kept.iter().position(|(other, _)| *other == key);
        let entry = known.map_or_else(|| (key, Slot::default()), |at| kept.remove(at));
        kept.push(entry.clone());
        entry.1
    }

    /// Forgets those that were not used for longest until the rest fits; the last one stays.
    fn make_room(&self) {
        let mut kept = self.kept.lock().expect("nobody panics while scenes are looked up");
        let size = |slot: &Slot| match slot.get() {
            Some(Ok(scene)) => scene.size_bytes(),
            _ => 0,
        };
        let mut total: u64 = kept.iter().map(|(_, slot)| size(slot)).sum();
        while total > self.max_bytes && kept.len() > 1 {
            total -= size(&kept.remove(0).1);
        }
    }
}

/// What identifies everything of a scene that is costly to compile.
fn key(description: &SceneDescription) -> String {
    let (render, aovs) = (&description.render, &description.render.aovs);
    let mut costly = SceneDescription {
        camera: Camera::perspective([0.0; 3], [0.0, 0.0, 1.0], 40.0),
        light: Lights::default(),
        ..description.clone()
    };
    costly.render = Render { build_quality: render.build_quality, aovs: aovs.clone(), ..Render::default() };
    hash(&serde_json::to_vec(&costly).expect("a description has only text and numbers"))
}
