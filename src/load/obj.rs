//! OBJ: groups and materials as runs of faces, the corners of each run as vertices.

use super::normals::cross_product;
use super::obj_text::{MarkKind, NONE, ObjText, read};
use super::obj_vertices::Vertices;
use super::polygon::triangulate;
use super::{LoadError, LoadOptions, Mesh, mtl};
use crate::describe::{Material, MaterialKind};
use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Range;
use std::path::Path;

/// The mesh in an OBJ file, with the materials of its MTL files unless `options` leave them out.
pub(super) fn parse(path: &Path, bytes: &[u8], options: LoadOptions) -> Result<Mesh, LoadError> {
    let text = read(bytes).map_err(|(line, message)| LoadError::malformed(path, Some(line), message))?;
    let libraries = if options.materials { mtl::load_all(path, &text)? } else { Vec::new() };
    let mut mesh = Mesh::default();
    mesh.report.degenerate = text.thin_faces;
    mesh.report.notes = text.notes();
    let runs = runs(&text, &libraries);
    mesh.materials = libraries.into_iter().flatten().collect();
    assemble(&mut mesh, &text, &runs, path)?;
    Ok(mesh)
}

/// Faces of one group with one material; vertices are not shared with other runs.
struct Run {
    arities: Range<usize>,
    corners: Range<usize>,
    /// A place among the materials of all libraries.
    material: Option<u32>,
}

/// The runs of a text, none of them empty; the n-th `mtllib` brings the n-th library.
fn runs(text: &ObjText, libraries: &[Vec<Material>]) -> Vec<Run> {
    let mut runs = Runs { text, all: Vec::new(), end: [0; 2], material: None };
    let mut libraries = libraries.iter();
    let mut known: HashMap<&str, u32> = HashMap::new();
    let mut count = 0;
    for mark in &text.marks {
        match &mark.kind {
            MarkKind::Group => runs.end_at(mark.face),
            MarkKind::Library(_) => {
                for material in libraries.next().into_iter().flatten() {
                    known.insert(&material.name, count);
                    count += 1;
                }
            }
            MarkKind::Material(name) => {
                let material = known.get(name.as_str()).copied();
                if material != runs.material {
                    runs.end_at(mark.face);
                }
                runs.material = material;
            }
        }
    }
    runs.end_at(text.arities.len());
    runs.all
}

/// Runs so far.
struct Runs<'a> {
    text: &'a ObjText,
    all: Vec<Run>,
    /// Faces and corners of all runs.
    end: [usize; 2],
    material: Option<u32>,
}

impl Runs<'_> {
    fn end_at(&mut self, face: usize) {
        let [start, corner] = self.end;
        let corners: usize = self.text.arities[start..face].iter().map(|&n| n as usize).sum();
        if face > start {
            self.end = [face, corner + corners];
            let (arities, corners) = (start..face, corner..corner + corners);
            self.all.push(Run { arities, corners, material: self.material });
        }
    }
}

/// Puts all runs into one mesh.
fn assemble(mesh: &mut Mesh, text: &ObjText, runs: &[Run], path: &Path) -> Result<(), LoadError> {
    let with_normals = runs.iter().any(|run| has_normals(&text.corners[run.corners.clone()]));
    let with_uvs = text.corners.iter().any(|corner| corner[1] != NONE);
    let mut vertices = Vertices::new(text.positions.len());
    for run in runs {
        let mut triangles = Vec::with_capacity(run.corners.len());
        cut(text, run, &mut vertices, &mut triangles, path)?;
        let mut vertices = Cow::Borrowed(&vertices.all);
        let is_flat = with_normals && !has_normals(&vertices);
        if is_flat {
            vertices = Cow::Owned(unshare(&vertices, &mut triangles));
        }
        let first = first_of(mesh, &vertices, path)?;
        mesh.triangles.extend(triangles.iter().map(|t| t.map(|v| v + first)));
        mesh.positions.extend(column(&vertices, 0, &text.positions));
        if is_flat {
            let triangles = mesh.positions[first as usize..].as_chunks().0;
            mesh.normals.extend(triangles.iter().flat_map(|t| [cross_product(*t).map(|x| x as f32); 3]));
        } else if with_normals {
            mesh.normals.extend(column(&vertices, 2, &text.normals));
        }
        if with_uvs {
            mesh.uvs.extend(column(&vertices, 1, &text.uvs));
        }
        add_materials(mesh, run.material);
    }
    Ok(())
}

/// Whether every corner names a normal: with some left out, the run is flat.
fn has_normals(corners: &[[u32; 3]]) -> bool {
    corners.iter().all(|corner| corner[2] != NONE)
}

/// The vertices of a run, and its triangles over these.
fn cut(
    text: &ObjText,
    run: &Run,
    vertices: &mut Vertices,
    triangles: &mut Vec<[u32; 3]>,
    path: &Path,
) -> Result<(), LoadError> {
    let numbers = vertices.number(&text.corners[run.corners.clone()]);
    let positions: Vec<[f32; 3]> = column(&vertices.all, 0, &text.positions).collect();
    if let Some(at) = positions.iter().position(|p| p.iter().any(|x| !x.is_finite())) {
        let vertex = vertices.all[at][0] as usize + 1;
        return Err(LoadError::NotFinite { path: path.to_owned(), vertex, position: positions[at] });
    }
    let mut rest = numbers.as_slice();
    for &arity in &text.arities[run.arities.clone()] {
        let (polygon, behind) = rest.split_at(arity as usize);
        triangulate(&positions, polygon, triangles);
        rest = behind;
    }
    Ok(())
}

/// Corners of its own for every triangle: what is flat shares no vertices, as these have one normal each.
fn unshare(vertices: &[[u32; 3]], triangles: &mut [[u32; 3]]) -> Vec<[u32; 3]> {
    let corners = triangles.as_flattened().iter().map(|&v| vertices[v as usize]).collect();
    for (number, corner) in triangles.as_flattened_mut().iter_mut().enumerate() {
        *corner = number as u32;
    }
    corners
}

/// The number of the first of the vertices that are added.
fn first_of(mesh: &Mesh, added: &[[u32; 3]], path: &Path) -> Result<u32, LoadError> {
    let (first, total) = (mesh.positions.len(), mesh.positions.len() + added.len());
    let message = || format!("has {total} different corners: at most 2^32 - 1 can be numbered");
    match u32::try_from(total) {
        Ok(_) => Ok(first as u32),
        Err(_) => Err(LoadError::malformed(path, None, message())),
    }
}

/// An attribute of each vertex, zeros where a vertex has none.
fn column<'a, T: Copy + Default>(
    vertices: &'a [[u32; 3]],
    kind: usize,
    values: &'a [T],
) -> impl Iterator<Item = T> + 'a {
    vertices.iter().map(move |vertex| values.get(vertex[kind] as usize).copied().unwrap_or_default())
}

/// Gives all new triangles one material. Faces before any `usemtl` get a plain one in a file that has materials.
fn add_materials(mesh: &mut Mesh, material: Option<u32>) {
    if mesh.materials.is_empty() {
        return;
    }
    let material = material.unwrap_or_else(|| {
        let plain = mesh.materials.iter().position(|m| m.name == UNNAMED);
        plain.unwrap_or_else(|| {
            mesh.materials.push(Material::new(UNNAMED, MaterialKind::Diffuse));
            mesh.materials.len() - 1
        }) as u32
    });
    mesh.triangle_materials.resize(mesh.triangles.len(), material);
}

/// Name of the material of faces that use none.
const UNNAMED: &str = "without usemtl";
