//! Scenes that pictures share: compiled once, kept as long as they are asked for and there is room.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock};

use super::picture::Picture;
use super::source::Source;
use super::threads::workers;
use super::{BatchError, Plan};
use crate::describe::SceneDescription;
use crate::load::KeptMeshes;
use crate::scene::Scene;

/// A scene that is or will be compiled; a failure is kept too, so that it is met once.
type Slot = Arc<OnceLock<Result<Arc<Scene>, String>>>;

/// One scene, by the numbers that the plan gives it and its shape.
#[derive(Clone)]
struct Entry {
    scene: u32,
    shape: u32,
    slot: Slot,
    /// Whether its tree was built for it, not moved from another.
    is_built: bool,
}

/// The scenes of a batch: camera, lights and settings may differ from picture to picture.
pub(super) struct Scenes<'a> {
    source: &'a Source,
    common: &'a [String],
    workers: rayon::ThreadPool,
    max_bytes: u64,
    meshes: &'a KeptMeshes,
    kept: Mutex<Kept>,
}

/// What is kept, and for how often.
#[derive(Default)]
struct Kept {
    /// The one used last stands last.
    entries: Vec<Entry>,
    /// How many units will still ask for a scene.
    asks_scene: HashMap<u32, u64>,
    /// How many units will still ask for a scene of a shape.
    asks_shape: HashMap<u32, u64>,
}

impl<'a> Scenes<'a> {
    /// The scenes of these units of a plan, none of them compiled yet.
    pub(super) fn new(
        source: &'a Source,
        plan: &'a Plan,
        units: &[u64],
        (threads, max_bytes): (usize, u64),
        meshes: &'a KeptMeshes,
    ) -> Result<Self, BatchError> {
        let mut kept = Kept::default();
        for &unit in units {
            let Picture { scene, shape, .. } = plan.pictures[plan.unit(unit).picture];
            *kept.asks_scene.entry(scene).or_default() += 1;
            *kept.asks_shape.entry(shape).or_default() += 1;
        }
        let (kept, workers) = (Mutex::new(kept), workers(threads)?);
        Ok(Self { source, common: &plan.sets, workers, max_bytes, meshes, kept })
    }

    /// The scene of a picture for one of its units; `taken` bytes of the memory are other things'.
    pub(super) fn scene(&self, picture: &Picture, taken: u64) -> Result<Scene, BatchError> {
        let sets: Vec<String> = self.common.iter().chain(&picture.sets).cloned().collect();
        let description = self.source.with(&sets)?;
        let (entry, like) = self.kept().entry(picture);
        let compile = || self.compile(&description, like.as_deref());
        let shared = entry.slot.get_or_init(compile).clone();
        self.kept().asked(picture);
        self.make_room(self.max_bytes.saturating_sub(taken));
        Ok(shared.map_err(BatchError::Job)?.seen_by(&description)?)
    }

    fn compile(&self, description: &SceneDescription, like: Option<&Scene>) -> Result<Arc<Scene>, String> {
        tracing::info!(moved = like.is_some(), "scene compiled");
        let compiled = self.workers.install(|| Scene::compile_like(description, self.meshes, like));
        compiled.map(Arc::new).map_err(|error| error.to_string())
    }

    fn kept(&self) -> MutexGuard<'_, Kept> {
        self.kept.lock().expect("nobody panics while scenes are looked up")
    }

    /// Forgets what was not used for longest until the rest fits into so many bytes; the last scene stays.
    fn make_room(&self, max_bytes: u64) {
        let kept = &mut self.kept().entries;
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

impl Kept {
    /// The place of a picture's scene, and one of the same shape whose tree it may take.
    fn entry(&mut self, &Picture { scene, shape, .. }: &Picture) -> (Entry, Option<Arc<Scene>>) {
        // Always a tree that was built: boxes that were moved again and again would grow.
        let of_shape = |entry: &&Entry| entry.shape == shape && entry.is_built;
        let like = self.entries.iter().find(of_shape).and_then(|entry| entry.slot.get()?.clone().ok());
        let known = self.entries.iter().position(|entry| entry.scene == scene);
        let new = || Entry { scene, shape, slot: Slot::default(), is_built: like.is_none() };
        let entry = known.map_or_else(new, |at| self.entries.remove(at));
        self.entries.push(entry.clone());
        (entry, like)
    }

    /// A unit has its scene: forgets what no other one will ask for. A tree that was built may still be moved.
    fn asked(&mut self, picture: &Picture) {
        let last_of_scene = is_last(&mut self.asks_scene, picture.scene);
        let last_of_shape = is_last(&mut self.asks_shape, picture.shape);
        if last_of_scene {
            self.entries.retain(|entry| entry.scene != picture.scene || (entry.is_built && !last_of_shape));
        }
        if last_of_shape {
            self.entries.retain(|entry| entry.shape != picture.shape);
        }
    }
}

/// Counts one ask; whether it was the last.
fn is_last(asks: &mut HashMap<u32, u64>, number: u32) -> bool {
    let left = asks.get_mut(&number).map_or(0, |left| {
        *left = left.saturating_sub(1);
        *left
    });
    left == 0
}
