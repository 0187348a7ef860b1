//! The mesh of a `[[mesh]]` table, whatever its source.

use super::polygon::triangulate;
use super::{LoadError, LoadOptions, Mesh, finish, load_mesh_with, terrain};
use crate::describe::{self, MeshSource, ProceduralKind};
use std::path::{Path, PathBuf};

/// The mesh that a description means; paths start at `folder`, the folder of the scene file.
///
/// A `material` in the description wins over those of the file, which are then not read at all.
/// The transform of the description is not applied.
///
/// # Errors
/// [`LoadError`], as [`load_mesh`](super::load_mesh); `Malformed` for a description that never passed a check.
pub fn load_described(mesh: &describe::Mesh, folder: &Path) -> Result<Mesh, LoadError> {
    let materials = mesh.material.is_none();
    let options = LoadOptions { materials, normals: mesh.normals, smooth: mesh.smooth };
    match mesh.source() {
        Some(MeshSource::File(path)) => load_mesh_with(&folder.join(path), options),
        Some(MeshSource::Inline { vertices, faces }) => inline(mesh, vertices, faces, options),
        Some(MeshSource::Procedural(p)) => match p.kind {
            ProceduralKind::Terrain => Ok(terrain(p.triangles, p.seed, mesh.smooth)),
        },
        None => Err(malformed(mesh, "has no source, or more than one")),
    }
}

fn inline(
    mesh: &describe::Mesh,
    vertices: &[[f64; 3]],
    faces: &[Vec<u32>],
    options: LoadOptions,
) -> Result<Mesh, LoadError> {
    let positions: Vec<[f32; 3]> = vertices.iter().map(|v| v.map(|x| x as f32)).collect();
    let mut made = Mesh { positions, ..Mesh::default() };
    for face in faces {
        if let Some(bad) = face.iter().find(|&&i| i as usize >= made.positions.len()) {
            return Err(malformed(mesh, &format!("has no vertex {bad}")));
        }
        triangulate(&made.positions, face, &mut made.triangles);
    }
    finish::finish(made, &name_of(mesh), options)
}

fn malformed(mesh: &describe::Mesh, message: &str) -> LoadError {
    LoadError::Malformed { path: name_of(mesh), line: None, message: message.to_owned() }
}

/// What errors call a mesh that is not in a file.
fn name_of(mesh: &describe::Mesh) -> PathBuf {
    mesh.name.as_ref().map_or_else(|| "mesh in the scene".into(), |name| format!("mesh `{name}`").into())
}
