//! Bare meshes as scenes: loaded, and framed by a camera, lights and a floor.

use std::path::Path;

use super::{KeptMeshes, LoadError};
use crate::describe::{self, SceneDescription};

/// Endings of meshes.
const MESHES: [&str; 3] = ["obj", "ply", "stl"];

/// Whether a file is a mesh by its name, and no scene.
pub(crate) fn is_mesh(path: &Path) -> bool {
    path.extension().is_some_and(|e| MESHES.contains(&e.to_string_lossy().to_lowercase().as_str()))
}

/// The scene around a bare mesh, which is kept for compiling it.
///
/// # Errors
/// [`LoadError`], also for a mesh whose triangles have no area.
pub(crate) fn framed(path: &Path, meshes: &KeptMeshes) -> Result<SceneDescription, LoadError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let name = Path::new(path.file_name().unwrap_or_default());
    let bounds = meshes.load(&describe::Mesh::from_path(name), folder)?.bounds();
    let bounds = bounds.ok_or_else(|| LoadError::malformed(path, None, "has no triangle with an area"))?;
    let mut scene = describe::framed_mesh(name, bounds.map(|corner| corner.map(f64::from)));
    scene.folder = folder.to_owned();
    Ok(scene)
}
