//! Meshes that several scenes show, loaded once.

use std::collections::HashMap;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use super::{LoadError, Mesh, load_described};
use crate::describe;

/// Meshes by what a scene says about them. Files are taken to stay what they are.
#[derive(Debug, Default)]
pub struct KeptMeshes {
    /// `None` keeps nothing.
    meshes: Option<Mutex<HashMap<String, Arc<Mesh>>>>,
}

impl KeptMeshes {
    /// Keeps every mesh until [`KeptMeshes::forget`]; the default keeps none.
    pub fn keeping() -> Self {
        Self { meshes: Some(Mutex::default()) }
    }

    /// The mesh, loaded unless it is kept.
    ///
    /// **Errors:** as [`load_described`].
    pub fn load(&self, mesh: &describe::Mesh, folder: &Path) -> Result<Arc<Mesh>, LoadError> {
        let Some(meshes) = &self.meshes else { return load_described(mesh, folder).map(Arc::new) };
        let key = key(mesh, folder);
        let kept = || meshes.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = kept().get(&key) {
            return Ok(Arc::clone(found));
        }
        // Unlocked meanwhile: two threads may load the same mesh, which is only a waste.
        let loaded = Arc::new(load_described(mesh, folder)?);
        kept().insert(key, Arc::clone(&loaded));
        Ok(loaded)
    }

    /// Bytes of positions, triangles and what goes with them.
    pub fn size_bytes(&self) -> u64 {
        let size = |mesh: &Arc<Mesh>| {
            (mesh.positions.len() + mesh.normals.len()) * 12 + mesh.uvs.len() * 8 + mesh.triangles.len() * 16
        };
        let kept = self.meshes.as_ref().map(|meshes| meshes.lock().unwrap_or_else(PoisonError::into_inner));
        kept.map_or(0, |meshes| meshes.values().map(size).sum::<usize>() as u64)
    }

    /// Keeps nothing of what was loaded so far.
    pub fn forget(&self) {
        if let Some(meshes) = &self.meshes {
            meshes.lock().unwrap_or_else(PoisonError::into_inner).clear();
        }
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
}
