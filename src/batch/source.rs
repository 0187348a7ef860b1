//! The scene that a job is about, read once.

use std::path::Path;

use super::BatchError;
use crate::describe::{self, Amendable, SceneDescription, is_file_name, unknown_builtin};
use crate::load::{KeptMeshes, framed, is_mesh};
use crate::scene::Scene;

/// A scene before the changes that pictures make to it.
pub(super) struct Source {
    name: String,
    scene: Amendable,
    /// The scene file, mesh, or the built-in scene written out.
    pub(super) bytes: Vec<u8>,
}

impl Source {
    /// Reads a scene file or mesh relative to `folder`, or a built-in scene. A bare mesh is framed, and kept in `meshes`.
    pub(super) fn read(name: &str, folder: &Path, meshes: &KeptMeshes) -> Result<Self, BatchError> {
        let bytes = bytes(name, folder)?;
        let path = folder.join(name);
        let scene = match name {
            _ if !is_file_name(name) => builtin(name)?,
            _ if is_mesh(&path) => framed(&path, meshes)?,
            _ => describe::read(&path)?,
        };
        Ok(Self { name: name.to_owned(), scene: Amendable::new(scene), bytes })
    }

    /// The scene of one picture.
    pub(super) fn with(&self, sets: &[String]) -> Result<SceneDescription, describe::DescribeError> {
        self.scene.amended(&self.name, sets)
    }

    /// Camera and settings of one picture, without its objects: nothing is loaded or built.
    pub(super) fn view(&self, sets: &[String]) -> Result<Scene, BatchError> {
        let described = self.with(sets)?;
        let mut view = SceneDescription::new(described.camera);
        view.render = described.render;
        Ok(Scene::compile(&view)?)
    }

    /// The scene as written.
    pub(super) fn scene(&self) -> &SceneDescription {
        self.scene.scene()
    }
}

/// The bytes of a scene file or mesh relative to `folder`, or of a built-in scene written out.
pub(super) fn bytes(name: &str, folder: &Path) -> Result<Vec<u8>, BatchError> {
    if !is_file_name(name) {
        return Ok(builtin(name)?.to_toml().into_bytes());
    }
    let path = folder.join(name);
    std::fs::read(&path).map_err(|cause| BatchError::read(&path, cause))
}

fn builtin(name: &str) -> Result<SceneDescription, BatchError> {
    describe::builtin(name)?.ok_or_else(|| BatchError::Job(unknown_builtin(name)))
}
