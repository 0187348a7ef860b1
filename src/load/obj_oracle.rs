//! The same triangles as by `tobj`, one statement a line, on all files at hand.

use super::normals::cross_product;
use super::polygon::triangulate;
use super::{LoadError, LoadOptions, Mesh, finish, load_mesh_with};
use std::path::{Path, PathBuf};

const OPTIONS: LoadOptions = LoadOptions { materials: false, normals: true, smooth: false };

/// Without polylines, colours and what else `tobj` takes otherwise.
fn prepared(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes).replace("\\\r\n", "").replace("\\\n", "");
    let line = |line: &str| {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["v", x, y, z, _, _, ..] => format!("v {x} {y} {z}"),
            ["vt", u] => format!("vt {u} 0"),
            ["f", _, _, _, ..] | ["v" | "vt" | "vn" | "o" | "g", ..] => words.join(" "),
            _ => String::new(),
        }
    };
    text.lines().map(|l| line(l) + "\n").collect()
}

/// The mesh with three vertices a triangle.
fn plain(path: &Path) -> Result<Mesh, LoadError> {
    let text = prepared(&std::fs::read(path).unwrap());
    let options = tobj::LoadOptions { single_index: true, ..Default::default() };
    let (models, _) = tobj::load_obj_buf(&mut text.as_bytes(), &options, |_| Ok(Default::default())).unwrap();
    let complete = |m: &tobj::Mesh| !m.normals.is_empty() && m.normals.len() == m.positions.len();
    let with_normals = models.iter().any(|m| complete(&m.mesh));
    let mut mesh = Mesh::default();
    for tobj::Model { mesh: model, .. } in &models {
        let positions: &[[f32; 3]] = model.positions.as_chunks().0;
        for triangle in triangles(model) {
            let corners = triangle.map(|v| positions[v as usize]);
            let flat = cross_product(corners).map(|x| x as f32);
            mesh.triangles.push([0, 1, 2].map(|corner| mesh.positions.len() as u32 + corner));
            for v in triangle {
                let v = v as usize;
                mesh.positions.push(positions[v]);
                mesh.uvs.push(model.texcoords.as_chunks().0.get(v).copied().unwrap_or_default());
                let normal = if complete(model) { model.normals.as_chunks().0[v] } else { flat };
                mesh.normals.extend(with_normals.then_some(normal));
            }
        }
    }
    finish::finish(mesh, path, OPTIONS)
}

fn triangles(model: &tobj::Mesh) -> Vec<[u32; 3]> {
    let positions = model.positions.as_chunks().0;
    let mut all = Vec::new();
    let mut rest = model.indices.as_slice();
    // Without arities, all faces are triangles.
    let arities =
        if model.face_arities.is_empty() { vec![3; rest.len() / 3] } else { model.face_arities.clone() };
    for arity in arities {
        let (polygon, behind) = rest.split_at(arity as usize);
        triangulate(positions, polygon, &mut all);
        rest = behind;
    }
    all
}

/// Bits of position, normal and texture coordinates of every corner.
fn corners(mesh: &Mesh) -> Vec<[u32; 8]> {
    let at = |v: &u32| {
        let v = *v as usize;
        let [x, y, z] = mesh.positions[v];
        let [nx, ny, nz] = mesh.normals.get(v).copied().unwrap_or_default();
        let [s, t] = mesh.uvs.get(v).copied().unwrap_or_default();
        [x, y, z, nx, ny, nz, s, t].map(f32::to_bits)
    };
    mesh.triangles.as_flattened().iter().map(at).collect()
}

/// All OBJ files below a folder.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "obj") {
            found.push(path);
        }
    }
}

#[test]
fn real_files_give_the_triangles_of_another_parser() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/scenes");
    let mut found = Vec::new();
    files(&folder, &mut found);
    if found.is_empty() {
        println!("skipped: no OBJ files are at hand");
    }
    for path in found {
        match (load_mesh_with(&path, OPTIONS), plain(&path)) {
            (Ok(mesh), Ok(plain)) => {
                assert!(corners(&mesh) == corners(&plain), "{}", path.display());
                assert_eq!(mesh.report.normals_replaced == 0, plain.report.normals_replaced == 0);
            }
            (mesh, plain) => {
                let error = |result: Result<Mesh, LoadError>| result.unwrap_err().to_string();
                assert_eq!(error(mesh), error(plain));
            }
        }
    }
}
