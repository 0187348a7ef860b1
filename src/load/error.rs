//! What can be wrong with a mesh or texture file.

use std::fmt;
use std::path::{Path, PathBuf};

/// Why there is no mesh or texture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The file cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The name ends like no format we read.
    #[error("{}: unknown mesh format: expected a name that ends in .obj, .ply or .stl", path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// The content makes no sense.
    #[error("{}{}: {message}", path.display(), Line(*line))]
    Malformed {
        /// The file.
        path: PathBuf,
        /// The line, from 1, where known.
        line: Option<usize>,
        /// What was expected and what was found.
        message: String,
    },
    /// The file has no triangle.
    #[error("{}: has {vertices} points but no faces: expected a mesh of triangles or polygons", path.display())]
    NoFaces {
        /// The file.
        path: PathBuf,
        /// How many points it has.
        vertices: usize,
    },
    /// A vertex that a face uses is infinite or not a number.
    #[error("{}: vertex {vertex} is not finite: {position:?}", path.display())]
    NotFinite {
        /// The file.
        path: PathBuf,
        /// Its number in the file, from 0 in PLY and STL, from 1 in OBJ.
        vertex: usize,
        /// Where it claims to be.
        position: [f32; 3],
    },
    /// A material file that an OBJ names cannot be read.
    #[error("{}:{line}: material file {} cannot be read: {source}", path.display(), mtl.display())]
    MissingMaterialFile {
        /// The OBJ file.
        path: PathBuf,
        /// The line that names it.
        line: usize,
        /// The material file.
        mtl: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A material that an OBJ uses is in none of its material files.
    #[error("{}:{line}: there is no material `{name}` in {mtl}", path.display())]
    MissingMaterial {
        /// The OBJ file.
        path: PathBuf,
        /// The line that uses it.
        line: usize,
        /// The material.
        name: String,
        /// The material files.
        mtl: String,
    },
    /// A texture that a material names does not exist.
    #[error("{}: texture {} of material `{material}` does not exist", mtl.display(), texture.display())]
    MissingTexture {
        /// The material file.
        mtl: PathBuf,
        /// The material.
        material: String,
        /// The texture file.
        texture: PathBuf,
    },
    /// A picture cannot be decoded.
    #[error("{}: is not a picture that can be read: {message}", path.display())]
    Picture {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        message: String,
    },
}

impl LoadError {
    /// The content of a file makes no sense, in a line where that is known.
    pub(super) fn malformed(path: &Path, line: Option<usize>, message: impl Into<String>) -> Self {
        Self::Malformed { path: path.to_owned(), line, message: message.into() }
    }
}

/// A line number after a colon, or nothing.
struct Line(Option<usize>);

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.map_or(Ok(()), |line| write!(f, ":{line}"))
    }
}
