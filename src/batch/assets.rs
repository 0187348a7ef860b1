//! The files that a scene is made of, and their hashes.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::BatchError;
use super::faults::{MOST_NAMED, first_lines};
use crate::describe::{MeshSource, SceneDescription};
use crate::load::material_files;

/// A file with its content's hash.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Asset {
    /// Path relative to the job's folder, or absolute.
    pub path: PathBuf,
    /// BLAKE3 of its bytes, in hexadecimal.
    pub blake3: String,
}

/// The hash of bytes, in hexadecimal.
pub(super) fn hash(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex().to_string()
}

/// The files that scenes name: meshes, their material files, textures.
#[derive(Default)]
pub(super) struct Files {
    plain: BTreeSet<PathBuf>,
    /// Meshes whose own materials are used.
    with_materials: BTreeSet<PathBuf>,
}

impl Files {
    /// Takes note of what a scene names.
    pub(super) fn see(&mut self, scene: &SceneDescription) {
        for texture in scene.material.iter().filter_map(|material| material.texture.as_ref()) {
            self.plain.insert(scene.resolve(texture));
        }
        for mesh in scene.all_meshes() {
            let Some(MeshSource::File(path)) = mesh.source() else { continue };
            self.plain.insert(scene.resolve(path));
            if mesh.material.is_none() {
                self.with_materials.insert(scene.resolve(path));
            }
        }
    }

    /// Takes note of what others have noted.
    pub(super) fn join(&mut self, others: Self) {
        self.plain.extend(others.plain);
        self.with_materials.extend(others.with_materials);
    }

    /// All of them with their hashes, sorted, relative to `folder`.
    pub(super) fn hashed(mut self, folder: &Path) -> Result<Vec<Asset>, BatchError> {
        for mesh in self.with_materials.iter().filter(|mesh| is_obj(mesh)) {
            self.plain.extend(material_files(mesh)?);
        }
        let asset = |path: PathBuf| {
            let blake3 = hash(&read(&path)?);
            Ok(Asset { path: path.strip_prefix(folder).unwrap_or(&path).to_owned(), blake3 })
        };
        self.plain.into_iter().map(asset).collect()
    }
}

/// Which assets are not what they were, in words: the first ones of many.
pub(super) fn changes(assets: &[Asset], folder: &Path) -> Vec<String> {
    let changed = |asset: &Asset| match read(&folder.join(&asset.path)) {
        Ok(bytes) if hash(&bytes) == asset.blake3 => None,
        Ok(_) => Some(format!("{} has changed since the plan was made", asset.path.display())),
        Err(error) => Some(error.told()),
    };
    first_lines(MOST_NAMED, assets.iter().filter_map(changed))
}

fn is_obj(mesh: &Path) -> bool {
    mesh.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("obj"))
}

fn read(path: &Path) -> Result<Vec<u8>, BatchError> {
    std::fs::read(path).map_err(|cause| BatchError::read(path, cause))
}
