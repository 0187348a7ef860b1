//! Meshes and instances.

use super::shape::{is_true, yes};
use super::{Transform, exact};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// A triangle mesh: from a file (`path`), written out (`vertices` and `faces`), or made by code (`procedural`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mesh {
    /// Name for `[[instance]]`.
    #[serde(default)]
    pub name: Option<String>,
    /// OBJ, PLY or STL file, relative to the scene file.
    #[serde(default)]
    pub path: Option<PathBuf>,
    /// Vertex positions; needs `faces`.
    #[serde(default, deserialize_with = "exact::read")]
    pub vertices: Option<Vec<[f64; 3]>>,
    /// Polygons of three or more vertex numbers, counted from 0.
    #[serde(default)]
    pub faces: Option<Vec<Vec<u32>>>,
    /// A mesh made by code.
    #[serde(default)]
    pub procedural: Option<Procedural>,
    /// Name of its material; wins over the materials of the file.
    #[serde(default)]
    pub material: Option<String>,
    /// Moves it.
    #[serde(default, skip_serializing_if = "Transform::is_empty")]
    pub transform: Transform,
    /// Make vertex normals when the file has none. Default false: flat triangles.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub smooth: bool,
    /// Use the vertex normals of the file. Default true.
    #[serde(default = "yes", skip_serializing_if = "is_true")]
    pub normals: bool,
}

/// Where the triangles of a [`Mesh`] come from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MeshSource<'a> {
    /// A file, as written.
    File(&'a Path),
    /// Written in the scene.
    Inline {
        /// Vertex positions.
        vertices: &'a [[f64; 3]],
        /// Polygons by vertex number.
        faces: &'a [Vec<u32>],
    },
    /// Made by code.
    Procedural(Procedural),
}

/// A mesh made by code.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Procedural {
    /// Which mesh: `terrain`.
    pub kind: ProceduralKind,
    /// About how many triangles, 2 to 200 million.
    pub triangles: u64,
    /// Chooses another mesh of the same kind. Default 0.
    #[serde(default)]
    pub seed: u64,
}

/// The meshes that code can make.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ProceduralKind {
    /// Hills over the square -1..1 in x and z, with heights in y between about 0 and 0.4.
    Terrain,
}

/// A group or named mesh seen once more, somewhere else. No triangle is copied.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Instance {
    /// Name of a `[[group]]` or of a named `[[mesh]]`.
    pub of: String,
    /// Name of a material that replaces all of its materials.
    #[serde(default)]
    pub material: Option<String>,
    /// Where it goes.
    #[serde(default, skip_serializing_if = "Transform::is_empty")]
    pub transform: Transform,
}

impl Mesh {
    /// A mesh from a file with every other key left out.
    #[must_use]
    pub fn from_path(path: impl Into<PathBuf>) -> Mesh {
        Mesh { path: Some(path.into()), ..Mesh::nothing() }
    }

    /// A mesh with its triangles written out.
    #[must_use]
    pub fn inline(vertices: Vec<[f64; 3]>, faces: Vec<Vec<u32>>) -> Mesh {
        Mesh { vertices: Some(vertices), faces: Some(faces), ..Mesh::nothing() }
    }

    /// A mesh made by code.
    #[must_use]
    pub fn procedural(procedural: Procedural) -> Mesh {
        Mesh { procedural: Some(procedural), ..Mesh::nothing() }
    }

    /// Where the triangles come from; `None` for a mesh that says nothing or two things, which a check refuses.
    #[must_use]
    pub fn source(&self) -> Option<MeshSource<'_>> {
        match (&self.path, &self.vertices, &self.faces, self.procedural) {
            (Some(path), None, None, None) => Some(MeshSource::File(path)),
            (None, Some(vertices), Some(faces), None) => Some(MeshSource::Inline { vertices, faces }),
            (None, None, None, Some(procedural)) => Some(MeshSource::Procedural(procedural)),
            _ => None,
        }
    }

    fn nothing() -> Mesh {
        Mesh {
            name: None,
            path: None,
            vertices: None,
            faces: None,
            procedural: None,
            material: None,
            transform: Transform::default(),
            smooth: false,
            normals: true,
        }
    }
}
