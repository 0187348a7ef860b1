//! Meshes that a scene names several times, or several scenes, loaded once.

use std::collections::HashMap;
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::{LoadError, Mesh, load_described};
use crate::describe::{self, SceneDescription};

/// Meshes by what a scene says about them. Files are taken to stay what they are. The default keeps none.
#[derive(Debug, Default)]
pub struct KeptMeshes(Mutex<Kept>);

#[derive(Debug, Default)]
struct Kept {
    meshes: HashMap<String, Arc<Mesh>>,
    uses: Uses,
}

/// How often meshes will still be asked for.
#[derive(Debug)]
enum Uses {
    /// Nobody knows: all are kept.
    Any,
    /// So often; those not listed never.
    Counted(HashMap<String, usize>),
}

impl Default for Uses {
    fn default() -> Self {
        Self::Counted(HashMap::new())
    }
}

impl KeptMeshes {
    /// Keeps every mesh until [`KeptMeshes::forget`] or [`KeptMeshes::expect`].
    pub fn keeping() -> Self {
        Self(Mutex::new(Kept { uses: Uses::Any, ..Kept::default() }))
    }

    /// From now on keeps a mesh as long as `scene` has a table for it that did not ask yet, and no other.
    pub fn expect(&self, scene: &SceneDescription) {
        let mut counts = HashMap::new();
        for mesh in scene.all_meshes() {
            *counts.entry(key(mesh, &scene.folder)).or_insert(0) += 1;
        }
        let mut kept = self.kept();
        kept.meshes.retain(|key, _| counts.contains_key(key));
        kept.uses = Uses::Counted(counts);
    }

    /// Keeps a mesh that was loaded elsewhere as the one that a description means.
    pub fn keep(&self, mesh: &describe::Mesh, folder: &Path, loaded: Mesh) {
        self.kept().meshes.insert(key(mesh, folder), Arc::new(loaded));
    }

    /// The mesh, loaded unless it is kept.
    ///
    /// **Errors:** as [`load_described`].
    pub fn load(&self, mesh: &describe::Mesh, folder: &Path) -> Result<Arc<Mesh>, LoadError> {
        let key = key(mesh, folder);
        let (found, is_used_again) = self.kept().take(&key);
        if let Some(found) = found {
            return Ok(found);
        }
        // Unlocked meanwhile: two threads may load the same mesh, which is only a waste.
        let loaded = Arc::new(load_described(mesh, folder)?);
        tracing::info!(triangles = loaded.triangles.len(), "mesh loaded");
        if is_used_again {
            self.kept().meshes.insert(key, Arc::clone(&loaded));
        }
        Ok(loaded)
    }

    /// Bytes of positions, triangles and what goes with them.
    pub fn size_bytes(&self) -> u64 {
        let size = |mesh: &Arc<Mesh>| {
            (mesh.positions.len() + mesh.normals.len()) * 12 + mesh.uvs.len() * 8 + mesh.triangles.len() * 16
        };
        self.kept().meshes.values().map(size).sum::<usize>() as u64
    }

    /// Keeps nothing of what was loaded so far.
    pub fn forget(&self) {
        self.kept().meshes.clear();
    }

    fn kept(&self) -> MutexGuard<'_, Kept> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Kept {
    /// The mesh if it is here, and whether it will be asked for again; else it is here no longer.
    fn take(&mut self, key: &str) -> (Option<Arc<Mesh>>, bool) {
        let is_used_again = match &mut self.uses {
            Uses::Any => true,
            Uses::Counted(counts) => counts.get_mut(key).is_some_and(|left| {
                *left = left.saturating_sub(1);
                *left > 0
            }),
        };
        let found = if is_used_again { self.meshes.get(key).cloned() } else { self.meshes.remove(key) };
        (found, is_used_again)
    }
}

/// What a mesh is loaded from and how, wherever it stands.
fn key(mesh: &describe::Mesh, folder: &Path) -> String {
    let plain = describe::Mesh {
        name: None,
        transform: Default::default(),
        // Only whether it has one of its own matters: then those of the file are not read.
        material: mesh.material.as_ref().map(|_| String::new()),
        ..mesh.clone()
    };
    let text = serde_json::to_string(&plain).expect("a mesh has only text and numbers");
    // However the folder is spelled.
    let folder = std::path::absolute(folder.join(".")).unwrap_or_else(|_| folder.to_owned());
    format!("{} {text}", folder.display())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::describe::{Procedural, ProceduralKind};

    fn terrain(triangles: u64) -> describe::Mesh {
        describe::Mesh::procedural(Procedural { kind: ProceduralKind::Terrain, triangles, seed: 0 })
    }

    #[test]
    fn a_mesh_is_loaded_once_wherever_it_stands() {
        let kept = KeptMeshes::keeping();
        let load = |mesh: &describe::Mesh| kept.load(mesh, Path::new("")).unwrap();
        let first = load(&terrain(20));
        let moved = describe::Mesh { name: Some("a".into()), ..terrain(20) };
        assert!(Arc::ptr_eq(&first, &load(&moved)));
        assert!(!Arc::ptr_eq(&first, &load(&terrain(40))));
        assert!(kept.size_bytes() > 0);
        kept.forget();
        assert_eq!(kept.size_bytes(), 0);
        assert!(!Arc::ptr_eq(&first, &load(&terrain(20))));
        let none = KeptMeshes::default();
        none.load(&terrain(20), Path::new("")).unwrap();
        assert_eq!(none.size_bytes(), 0);
    }

    #[test]
    fn a_mesh_is_kept_as_long_as_a_scene_asks_for_it() {
        let mut scene = describe::builtin("seed").unwrap().unwrap();
        scene.mesh = vec![terrain(20), terrain(40), terrain(20)];
        let kept = KeptMeshes::keeping();
        let load = |triangles| kept.load(&terrain(triangles), Path::new("")).unwrap();
        let framed = load(20);
        load(60);
        kept.expect(&scene);
        let size = kept.size_bytes();
        assert!(Arc::ptr_eq(&framed, &load(20)));
        load(40);
        assert_eq!(kept.size_bytes(), size, "a mesh that is named once is not kept");
        assert!(Arc::ptr_eq(&framed, &load(20)));
        assert_eq!(kept.size_bytes(), 0, "nor one that was named for the last time");
    }
}
