//! Bytes through a mesh loader: an error or a sound mesh, never a panic.

use std::path::PathBuf;

use octray::load::{Mesh, load_mesh};

thread_local! {
    static FOLDER: tempfile::TempDir = tempfile::tempdir().expect("a temporary folder can be made");
}

/// Puts a file where the loaded mesh can refer to it.
pub fn write(name: &str, bytes: &[u8]) -> PathBuf {
    let path = FOLDER.with(|folder| folder.path().join(name));
    std::fs::write(&path, bytes).expect("the temporary folder can be written");
    path
}

/// Loads `bytes` as a file called `name`, and checks what comes out.
pub fn load(name: &str, bytes: &[u8]) {
    match load_mesh(&write(name, bytes)) {
        Ok(mesh) => assert!(is_sound(&mesh), "a mesh that breaks its promises"),
        Err(error) => assert!(!error.to_string().is_empty(), "an error without a message"),
    }
}

fn is_sound(mesh: &Mesh) -> bool {
    let vertices = mesh.positions.len();
    let fits = |column: usize, rows: usize| column == 0 || column == rows;
    let finite = |&v: &u32| mesh.positions.get(v as usize).is_some_and(|p| p.iter().all(|x| x.is_finite()));
    let unit = |n: &[f32; 3]| (n.iter().map(|x| x * x).sum::<f32>() - 1.0).abs() < 1e-3;
    mesh.triangles.as_flattened().iter().all(finite)
        && fits(mesh.normals.len(), vertices)
        && fits(mesh.uvs.len(), vertices)
        && fits(mesh.triangle_materials.len(), mesh.triangles.len())
        && mesh.normals.iter().all(unit)
        && mesh.triangle_materials.iter().all(|&m| (m as usize) < mesh.materials.len())
}
