//! Meshes as triangle rows over vertex columns.

use super::CompileError;
use super::rows::{finite, room, rows};
use super::world::World;
use crate::describe;
use crate::geometry::{Triangles, push3, row3};
use crate::load;
use crate::math::Transform;
use glam::DVec3;

impl World<'_> {
    /// A mesh of the scene file, from wherever its triangles come.
    pub(super) fn described_mesh(&mut self, mesh: &describe::Mesh) -> Result<(), CompileError> {
        let loaded = self.meshes.load(mesh, &self.description.folder)?;
        self.mesh(&loaded, mesh.material.as_deref(), &rows(&mesh.transform, "mesh")?, "mesh")
    }

    /// A convex polygon as a fan of triangles.
    pub(super) fn polygon(
        &mut self,
        corners: &[[f64; 3]],
        material: Option<&str>,
        transform: &describe::Transform,
        what: &str,
    ) -> Result<(), CompileError> {
        let positions = corners.iter().map(|p| p.map(|x| x as f32)).collect();
        let triangles = (2..corners.len() as u32).map(|i| [0, i - 1, i]).collect();
        let mesh = load::Mesh { positions, triangles, ..Default::default() };
        self.mesh(&mesh, material, &rows(transform, what)?, what)
    }

    /// Appends a mesh, moved: vertices by the transform, normals by its transposed inverse.
    fn mesh(
        &mut self,
        mesh: &load::Mesh,
        material: Option<&str>,
        transform: &Transform,
        what: &str,
    ) -> Result<(), CompileError> {
        let rows = self.material_rows(mesh, material)?;
        let t = &mut self.geometry.triangles;
        let first = t.position[0].len();
        room("vertices", first + mesh.positions.len())?;
        room("triangles", t.len() + mesh.triangles.len())?;
        for p in &mesh.positions {
            // Vertices that no triangle uses may be anything.
            push3(&mut t.position, transform.point(p.map(f64::from)).map(|x| x as f32));
        }
        for &v in mesh.triangles.as_flattened() {
            if !row3(&t.position, first + v as usize).iter().all(|x| x.is_finite()) {
                finite(transform.point(mesh.positions[v as usize].map(f64::from)), what)?;
            }
        }
        let skipped = triangles(t, mesh, &rows, first as u32, transform.determinant() < 0.0);
        normals(t, mesh, transform, first);
        uvs(t, mesh, first);
        self.skipped_triangles += mesh.report.degenerate + skipped;
        Ok(())
    }

    /// Rows for the materials of a mesh: the one named in the scene, or those of the file.
    fn material_rows(&mut self, mesh: &load::Mesh, name: Option<&str>) -> Result<Vec<u32>, CompileError> {
        if name.is_some() || mesh.materials.is_empty() {
            let row = self.table.row(name)?;
            return Ok(vec![row; mesh.materials.len().max(1)]);
        }
        mesh.materials.iter().map(|m| self.table.add(m)).collect()
    }
}

/// Appends the triangles of a mesh whose vertices start at `first`; gives how many had no area and were left out. A
/// mirroring transform turns each around, so that its front stays outside.
fn triangles(t: &mut Triangles, mesh: &load::Mesh, rows: &[u32], first: u32, mirrored: bool) -> usize {
    let before = t.len();
    for (i, corners) in mesh.triangles.iter().enumerate() {
        let [a, b, c] = corners.map(|v| first + v);
        let turned = if mirrored { [a, c, b] } else { [a, b, c] };
        if has_no_area(turned.map(|v| row3(&t.position, v as usize))) {
            continue;
        }
        for (column, v) in t.vertex.iter_mut().zip(turned) {
            column.push(v);
        }
        t.material.push(rows[mesh.triangle_materials.get(i).map_or(0, |&m| m as usize)]);
    }
    mesh.triangles.len() - (t.len() - before)
}

/// Keeps the normal columns as long as the vertex columns from the first mesh on that has normals.
fn normals(t: &mut Triangles, mesh: &load::Mesh, transform: &Transform, first: usize) {
    if mesh.normals.is_empty() && t.normal[0].is_empty() {
        return;
    }
    for column in &mut t.normal {
        column.resize(first, 0.0);
    }
    for n in &mesh.normals {
        push3(&mut t.normal, transform.normal(n.map(f64::from)).map(|x| x as f32));
    }
    let vertices = t.position[0].len();
    for column in &mut t.normal {
        column.resize(vertices, 0.0);
    }
}

/// The same for texture coordinates.
fn uvs(t: &mut Triangles, mesh: &load::Mesh, first: usize) {
    if mesh.uvs.is_empty() && t.uv[0].is_empty() {
        return;
    }
    let vertices = t.position[0].len();
    for (k, column) in t.uv.iter_mut().enumerate() {
        column.resize(first, 0.0);
        column.extend(mesh.uvs.iter().map(|uv| uv[k]));
        column.resize(vertices, 0.0);
    }
}

/// True where the corners lie on a line, or on one point: no ray hits such a triangle, and it has no normal.
fn has_no_area([a, b, c]: [[f32; 3]; 3]) -> bool {
    let [a, b, c] = [a, b, c].map(|p| DVec3::from(p.map(f64::from)));
    (b - a).cross(c - a) == DVec3::ZERO
}
