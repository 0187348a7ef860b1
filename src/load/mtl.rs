//! The MTL files of an OBJ text: which there are, and whether they have what it uses.

use super::obj_text::ObjText;
use super::{LoadError, mtl_text};
use crate::describe::Material;
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// The materials of each `mtllib` line, after checking that every `usemtl` can be resolved.
pub(super) fn load_all(obj: &Path, text: &ObjText) -> Result<Vec<Vec<Material>>, LoadError> {
    let folder = obj.parent().unwrap_or(Path::new(""));
    let mut libraries = Vec::new();
    for (line, names) in text.libraries() {
        libraries.push(load(obj, line, &files(folder, names))?);
    }
    check_used(obj, text, &libraries)?;
    Ok(libraries)
}

/// The MTL files that an OBJ file names, and the textures that those name.
///
/// **Errors:** as loading the mesh.
pub fn material_files(obj: &Path) -> Result<Vec<PathBuf>, LoadError> {
    let bytes = std::fs::read(obj).map_err(|source| LoadError::Read { path: obj.to_owned(), source })?;
    let text = super::obj_text::read(&bytes)
        .map_err(|(line, message)| LoadError::malformed(obj, Some(line), message))?;
    let folder = obj.parent().unwrap_or(Path::new(""));
    let named = text.libraries().flat_map(|(_, names)| files(folder, names));
    let textures = load_all(obj, &text)?.into_iter().flatten();
    Ok(named.chain(textures.filter_map(|material| material.texture)).collect())
}

/// A line may name one file with spaces or several files.
fn files(folder: &Path, names: &str) -> Vec<PathBuf> {
    let whole = folder.join(mtl_text::unified(names));
    if whole.exists() || !names.contains(char::is_whitespace) {
        return vec![whole];
    }
    names.split_whitespace().map(|name| folder.join(mtl_text::unified(name))).collect()
}

/// A material used must exist, once the file names any library at all.
fn check_used(obj: &Path, text: &ObjText, libraries: &[Vec<Material>]) -> Result<(), LoadError> {
    if libraries.is_empty() {
        return Ok(());
    }
    let known: HashSet<&str> = libraries.iter().flatten().map(|m| m.name.as_str()).collect();
    match text.materials().find(|(_, name)| !known.contains(name)) {
        None => Ok(()),
        Some((line, name)) => {
            let mtl: Vec<&str> = text.libraries().map(|(_, names)| names).collect();
            Err(LoadError::MissingMaterial {
                path: obj.to_owned(),
                line,
                name: name.to_owned(),
                mtl: mtl.join(", "),
            })
        }
    }
}

fn load(obj: &Path, line: usize, files: &[PathBuf]) -> Result<Vec<Material>, LoadError> {
    let mut materials = Vec::new();
    for mtl in files {
        let bytes = std::fs::read(mtl).map_err(|source| LoadError::MissingMaterialFile {
            path: obj.to_owned(),
            line,
            mtl: mtl.clone(),
            source,
        })?;
        materials.extend(mtl_text::read(&String::from_utf8_lossy(&bytes), mtl)?);
    }
    Ok(materials)
}
