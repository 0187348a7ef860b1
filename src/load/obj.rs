//! OBJ through `tobj`, with polygons cut by us and every complaint with its line.

use super::normals::cross_product;
use super::obj_text::{ObjText, prepare};
use super::polygon::triangulate;
use super::{LoadError, LoadOptions, Mesh, mtl};
use crate::describe::{Material, MaterialKind};
use std::cell::Cell;
use std::io::{BufRead, Read};
use std::path::Path;

/// The mesh in an OBJ file, with the materials of its MTL files unless `options` leave them out.
pub(super) fn parse(path: &Path, bytes: &[u8], options: LoadOptions) -> Result<Mesh, LoadError> {
    let malformed = |line, message| LoadError::Malformed { path: path.to_owned(), line: Some(line), message };
    let source = String::from_utf8_lossy(bytes);
    let prepared = prepare(&source).map_err(|(line, message)| malformed(line, message))?;
    let libraries = if options.materials { mtl::load_all(path, &prepared)? } else { Vec::new() };
    let mut reader = LineCounter { rest: prepared.text.as_bytes(), line: 1 };
    let (models, _) = read(&mut reader, &libraries)
        .map_err(|error| malformed(reader.line.saturating_sub(1).max(1), error.to_string()))?;
    let mut mesh = Mesh::default();
    mesh.report.degenerate = prepared.thin_faces;
    mesh.report.notes.clone_from(&prepared.notes);
    for library in libraries {
        mesh.materials.extend(library.materials);
    }
    assemble(&mut mesh, &models, path)?;
    locate_infinite(&mesh, &prepared, path)?;
    Ok(mesh)
}

/// Runs the parser; the n-th `mtllib` gets the n-th library.
fn read(reader: &mut LineCounter<'_>, libraries: &[mtl::Library]) -> tobj::LoadResult {
    let options = tobj::LoadOptions {
        single_index: true,
        ignore_lines: true,
        ignore_points: true,
        ..Default::default()
    };
    let next = Cell::new(0);
    tobj::load_obj_buf(reader, &options, |_| {
        let library = libraries.get(next.replace(next.get() + 1));
        library.map_or_else(|| Ok(Default::default()), |library| library.parsed.clone())
    })
}

/// Puts all models into one mesh.
fn assemble(mesh: &mut Mesh, models: &[tobj::Model], path: &Path) -> Result<(), LoadError> {
    let total: usize = models.iter().map(|m| m.mesh.positions.len() / 3).sum();
    if u32::try_from(total).is_err() {
        let message = format!("has {total} different corners: at most 2^32 - 1 can be numbered");
        return Err(LoadError::Malformed { path: path.to_owned(), line: None, message });
    }
    let with_normals = models.iter().any(|m| has_normals(&m.mesh));
    let with_uvs = models.iter().any(|m| !m.mesh.texcoords.is_empty());
    for model in models {
        let first = mesh.triangles.len();
        add_triangles(mesh, &model.mesh);
        add_normals(mesh, &model.mesh, with_normals, first);
        add_uvs(mesh, &model.mesh, with_uvs);
        add_materials(mesh, model.mesh.material_id);
    }
    Ok(())
}

/// Whether every corner of a model names a normal: with some left out, the column could not be told apart.
fn has_normals(model: &tobj::Mesh) -> bool {
    !model.normals.is_empty() && model.normals.len() == model.positions.len()
}

fn add_triangles(mesh: &mut Mesh, model: &tobj::Mesh) {
    let base = mesh.positions.len() as u32;
    mesh.positions.extend_from_slice(model.positions.as_chunks().0);
    if model.face_arities.is_empty() {
        mesh.triangles.extend(model.indices.as_chunks().0.iter().map(|t: &[u32; 3]| t.map(|v| v + base)));
        return;
    }
    let mut rest = model.indices.as_slice();
    let mut polygon = Vec::new();
    for &arity in &model.face_arities {
        let (corners, behind) = rest.split_at(arity as usize);
        polygon.clear();
        polygon.extend(corners.iter().map(|v| v + base));
        triangulate(&mesh.positions, &polygon, &mut mesh.triangles);
        rest = behind;
    }
}

/// Adds the model's normals. In a mesh where only some models have them, the triangles of the others (from `first` on)
/// get corners of their own with the normal of the triangle: they stay flat.
fn add_normals(mesh: &mut Mesh, model: &tobj::Mesh, wanted: bool, first: usize) {
    if !wanted {
        return;
    }
    if has_normals(model) {
        mesh.normals.extend_from_slice(model.normals.as_chunks().0);
        return;
    }
    let base = mesh.normals.len();
    let corners: Vec<[[f32; 3]; 3]> =
        mesh.triangles[first..].iter().map(|t| t.map(|v| mesh.positions[v as usize])).collect();
    mesh.positions.truncate(base);
    for (triangle, corners) in mesh.triangles[first..].iter_mut().zip(corners) {
        let vertex = mesh.positions.len() as u32;
        *triangle = [vertex, vertex + 1, vertex + 2];
        mesh.positions.extend(corners);
        mesh.normals.extend([cross_product(corners).map(|x| x as f32); 3]);
    }
}

/// Adds the model's texture coordinates, zeros where it has none.
fn add_uvs(mesh: &mut Mesh, model: &tobj::Mesh, wanted: bool) {
    if !wanted {
        return;
    }
    // Corners of their own (flat models) or corners without coordinates: nothing to match by number.
    let added = mesh.positions.len() - mesh.uvs.len();
    if model.texcoords.len() == 2 * added {
        mesh.uvs.extend_from_slice(model.texcoords.as_chunks().0);
    } else {
        mesh.uvs.resize(mesh.positions.len(), [0.0; 2]);
    }
}

/// Gives all new triangles one material. Faces before any `usemtl` get a plain one in a file that has materials.
fn add_materials(mesh: &mut Mesh, material: Option<usize>) {
    if mesh.materials.is_empty() || mesh.triangles.len() == mesh.triangle_materials.len() {
        return;
    }
    let material = material.unwrap_or_else(|| {
        let plain = mesh.materials.iter().position(|m| m.name == UNNAMED);
        plain.unwrap_or_else(|| {
            mesh.materials.push(Material::new(UNNAMED, MaterialKind::Diffuse));
            mesh.materials.len() - 1
        })
    });
    mesh.triangle_materials.resize(mesh.triangles.len(), material as u32);
}

/// Name of the material of faces that use none.
const UNNAMED: &str = "without usemtl";

/// Corners were numbered anew, so a vertex that is not finite is looked up in the text for its own number.
fn locate_infinite(mesh: &Mesh, prepared: &ObjText, path: &Path) -> Result<(), LoadError> {
    let finite = |v: &u32| mesh.positions[*v as usize].iter().all(|x| x.is_finite());
    let Some(&used) = mesh.triangles.as_flattened().iter().find(|v| !finite(v)) else { return Ok(()) };
    let position = mesh.positions[used as usize];
    let vertices = prepared.text.lines().filter_map(|line| line.strip_prefix("v "));
    let same = |line: &str| {
        let numbers: Vec<f32> = line.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        numbers.iter().take(3).map(|x| x.to_bits()).eq(position.iter().map(|x| x.to_bits()))
    };
    let vertex = vertices.enumerate().find(|(_, line)| same(line)).map_or(0, |(number, _)| number + 1);
    Err(LoadError::NotFinite { path: path.to_owned(), vertex, position })
}

/// Counts the lines that the parser has taken: it stops at the line it does not understand.
struct LineCounter<'a> {
    rest: &'a [u8],
    line: usize,
}

impl Read for LineCounter<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = self.rest.read(buffer)?;
        self.line += buffer[..count].iter().filter(|&&b| b == b'\n').count();
        Ok(count)
    }
}

impl BufRead for LineCounter<'_> {
    fn fill_buf(&mut self) -> std::io::Result<&[u8]> {
        Ok(self.rest)
    }

    fn consume(&mut self, amount: usize) {
        let (taken, rest) = self.rest.split_at(amount);
        self.line += taken.iter().filter(|&&b| b == b'\n').count();
        self.rest = rest;
    }
}
