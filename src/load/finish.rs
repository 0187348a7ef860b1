//! The last step of every format: what is wrong is refused, what has no area is left out and counted.

use super::normals::{cross_product, make_smooth, repair};
use super::{LoadError, LoadOptions, Mesh};
use std::path::Path;

/// The mesh as promised by [`Mesh`]: finite, no triangle without area, normals of length 1.
///
/// **Needs**: all indices lie inside their columns.
pub(super) fn finish(mut mesh: Mesh, path: &Path, options: LoadOptions) -> Result<Mesh, LoadError> {
    mesh.report.triangles_read = mesh.triangles.len();
    if mesh.triangles.is_empty() {
        return Err(LoadError::NoFaces { path: path.to_owned(), vertices: mesh.positions.len() });
    }
    refuse_infinite(&mesh, path)?;
    drop_degenerate(&mut mesh);
    if !options.materials {
        mesh.materials.clear();
        mesh.triangle_materials.clear();
    }
    if !options.normals {
        mesh.normals.clear();
    }
    match (mesh.normals.is_empty(), options.smooth) {
        (true, true) => make_smooth(&mut mesh),
        (true, false) => {}
        (false, _) => repair(&mut mesh),
    }
    Ok(mesh)
}

fn refuse_infinite(mesh: &Mesh, path: &Path) -> Result<(), LoadError> {
    let finite = |v: &u32| mesh.positions[*v as usize].iter().all(|x| x.is_finite());
    match mesh.triangles.as_flattened().iter().find(|v| !finite(v)) {
        None => Ok(()),
        Some(&v) => Err(LoadError::NotFinite {
            path: path.to_owned(),
            vertex: v as usize,
            position: mesh.positions[v as usize],
        }),
    }
}

/// Leaves out triangles without area, keeping the order of the others.
fn drop_degenerate(mesh: &mut Mesh) {
    let before = mesh.triangles.len();
    let has_materials = !mesh.triangle_materials.is_empty();
    let mut kept = 0;
    for i in 0..before {
        let triangle = mesh.triangles[i];
        if cross_product(triangle.map(|v| mesh.positions[v as usize])) == [0.0; 3] {
            continue;
        }
        mesh.triangles[kept] = triangle;
        if has_materials {
            mesh.triangle_materials[kept] = mesh.triangle_materials[i];
        }
        kept += 1;
    }
    mesh.triangles.truncate(kept);
    mesh.triangle_materials.truncate(kept);
    mesh.report.degenerate += before - kept;
}
