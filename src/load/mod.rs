//! Mesh files to triangle meshes.
