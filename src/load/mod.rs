//! Mesh files to triangle meshes.
//!
//! [`load_mesh`] reads OBJ (with MTL), PLY and STL; [`load_described`] gives the mesh of a `[[mesh]]` table, whatever
//! it comes from. What comes out has passed all checks: every index lies inside its column, every used vertex is
//! finite, every triangle has an area, every normal a length.
//!
//! ```no_run
//! let mesh = octray::load::load_mesh("bunny.obj".as_ref())?;
//! println!("{} triangles, {} without area left out", mesh.triangles.len(), mesh.report.degenerate);
//! # Ok::<(), octray::load::LoadError>(())
//! ```

mod bare;
mod described;
mod error;
mod finish;
mod kept;
mod mtl;
mod mtl_text;
mod normals;
mod obj;
mod obj_piece;
mod obj_text;
mod obj_vertices;
mod obj_words;
mod ply;
#[cfg(test)]
mod ply_oracle;
mod ply_strides;
mod polygon;
mod stl;
mod terrain;
mod texture;

use crate::describe::Material;
use std::path::Path;

pub(crate) use bare::{framed, is_mesh};
pub use described::load_described;
pub use error::LoadError;
pub use kept::KeptMeshes;
pub use mtl::material_files;
pub use terrain::terrain;
pub(crate) use texture::linear_from_srgb;
pub use texture::{Texture, load_texture, srgb_to_linear};

/// A triangle mesh.
///
/// **Shape**: one column an attribute; `normals` and `uvs` are empty or as long as `positions`,
/// `triangle_materials` is empty or as long as `triangles`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Vertex positions.
    pub positions: Vec<[f32; 3]>,
    /// Vertex normals of length 1.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates of vertices; `v` runs upwards, as in OBJ. May lie outside 0..1: textures repeat.
    pub uvs: Vec<[f32; 2]>,
    /// Three vertex numbers a triangle.
    pub triangles: Vec<[u32; 3]>,
    /// The material of each triangle, a place in `materials`.
    pub triangle_materials: Vec<u32>,
    /// Materials of the file. Texture paths are complete, not relative to a scene file.
    pub materials: Vec<Material>,
    /// What was changed while loading.
    pub report: LoadReport,
}

/// What loading changed about a mesh.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct LoadReport {
    /// Triangles in the file, polygons counted as corners minus two.
    pub triangles_read: usize,
    /// Triangles left out because they have no area, and faces with fewer than three corners.
    pub degenerate: usize,
    /// Normals without a direction that were replaced by the mean of the triangles around.
    pub normals_replaced: usize,
    /// Anything else worth telling, one line each.
    pub notes: Vec<String>,
}

/// What to read besides triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LoadOptions {
    /// Materials, with the files that hold them. Without, missing MTL files are no error.
    pub materials: bool,
    /// Vertex normals of the file.
    pub normals: bool,
    /// Make vertex normals when there are none.
    pub smooth: bool,
}

impl Default for LoadOptions {
    fn default() -> LoadOptions {
        LoadOptions { materials: true, normals: true, smooth: false }
    }
}

/// The mesh in a file, with its materials and normals. The format follows from the name's ending.
///
/// # Errors
/// [`LoadError`]: an unknown ending, a file that cannot be read or makes no sense, a missing MTL or texture file.
pub fn load_mesh(path: &Path) -> Result<Mesh, LoadError> {
    load_mesh_with(path, LoadOptions::default())
}

/// The mesh in a file, with no more than was asked for.
///
/// # Errors
/// [`LoadError`], as [`load_mesh`].
pub fn load_mesh_with(path: &Path, options: LoadOptions) -> Result<Mesh, LoadError> {
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    let read = || std::fs::read(path).map_err(|source| LoadError::Read { path: path.to_owned(), source });
    let mesh = match ending.as_str() {
        "obj" => obj::parse(path, &read()?, options)?,
        "ply" => ply::parse(path, &read()?)?,
        "stl" => stl::parse(path, read()?)?,
        _ => return Err(LoadError::UnknownFormat { path: path.to_owned() }),
    };
    finish::finish(mesh, path, options)
}

impl Mesh {
    /// Lowest and highest corner around all triangles; `None` without triangles.
    #[must_use]
    pub fn bounds(&self) -> Option<[[f32; 3]; 2]> {
        let mut used = self.triangles.as_flattened().iter().map(|&v| self.positions[v as usize]);
        let first = used.next()?;
        Some(used.fold([first, first], |[low, high], p| {
            [std::array::from_fn(|i| low[i].min(p[i])), std::array::from_fn(|i| high[i].max(p[i]))]
        }))
    }
}

#[cfg(test)]
mod garbage;
#[cfg(test)]
mod obj_oracle;
#[cfg(test)]
mod tests;
