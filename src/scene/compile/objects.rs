//! Objects as rows of columns, groups as ranges of rows, nested instances flattened to two levels.

use std::collections::HashMap;

use super::CompileError;
use super::materials::MaterialTable;
use crate::describe::{self, Objects, SceneDescription, Target};
use crate::geometry::{Geometry, Group, Instance, NO_MATERIAL, push3, row3};
use crate::intersect::PrimId;
use crate::load::{self, load_described};
use crate::math::Transform;
use glam::DVec3;

/// A group while it is compiled: its rows, and what it shows of other groups.
#[derive(Default)]
struct Part {
    rows: Group,
    shows: Vec<Instance>,
}

/// What identifies a part: a group by its number, a named mesh by its name.
#[derive(Clone, PartialEq, Eq, Hash)]
enum Key {
    Group(usize),
    Mesh(String),
}

/// The geometry so far.
pub(super) struct World<'a> {
    description: &'a SceneDescription,
    table: &'a mut MaterialTable,
    geometry: Geometry,
    parts: Vec<Part>,
    part_of: HashMap<Key, usize>,
    skipped_triangles: usize,
}

impl<'a> World<'a> {
    /// All objects of a description as columns, and how many triangles were left out because they have no area.
    pub(super) fn compile(
        description: &'a SceneDescription,
        table: &'a mut MaterialTable,
    ) -> Result<(Geometry, usize), CompileError> {
        let mut world = World {
            description,
            table,
            geometry: Geometry::default(),
            // Part 0 is the world; its rows are filled last but its number is first.
            parts: vec![Part::default()],
            part_of: HashMap::new(),
            skipped_triangles: 0,
        };
        let top = world.part(description.objects())?;
        world.parts[0] = top;
        world.planes()?;
        let skipped = world.skipped_triangles;
        Ok((world.flatten(), skipped))
    }

    /// Compiles objects to a part. Parts that it shows are compiled first, so that its own rows are contiguous.
    fn part(&mut self, objects: Objects<'_>) -> Result<Part, CompileError> {
        let mut shows = self.instances(objects.instances)?;
        let bent = |t: &describe::Transform| rows(t, "object").is_ok_and(|t| t.uniform_scale().is_none());
        for s in objects.spheres.iter().filter(|s| bent(&s.transform)) {
            let straight = describe::Sphere { transform: Default::default(), ..s.clone() };
            shows.push(self.alone(Objects { spheres: &[straight], ..NOTHING }, &s.transform, "sphere")?);
        }
        for c in objects.cylinders.iter().filter(|c| bent(&c.transform)) {
            let straight = describe::Cylinder { transform: Default::default(), ..c.clone() };
            shows.push(self.alone(
                Objects { cylinders: &[straight], ..NOTHING },
                &c.transform,
                "cylinder",
            )?);
        }
        let mut own_meshes = Vec::new();
        for mesh in objects.meshes {
            match mesh.name.as_deref().filter(|name| self.is_shown(name)) {
                Some(name) => shows.push(self.shown_mesh(name, mesh)?),
                None => own_meshes.push(mesh),
            }
        }
        let start = self.row_counts();
        for s in objects.spheres.iter().filter(|s| !bent(&s.transform)) {
            self.sphere(s)?;
        }
        for c in objects.cylinders.iter().filter(|c| !bent(&c.transform)) {
            self.cylinder(c)?;
        }
        for t in objects.triangles {
            let mesh = load::Mesh {
                positions: to_f32(&t.vertices),
                triangles: vec![[0, 1, 2]],
                ..Default::default()
            };
            self.mesh(&mesh, t.material.as_deref(), &rows(&t.transform, "triangle")?, "triangle")?;
        }
        for q in objects.quads {
            let triangles = vec![[0, 1, 2], [0, 2, 3]];
            let mesh = load::Mesh { positions: to_f32(&q.corners()), triangles, ..Default::default() };
            self.mesh(&mesh, q.material.as_deref(), &rows(&q.transform, "quad")?, "quad")?;
        }
        for m in own_meshes {
            let mesh = load_described(m, &self.description.folder)?;
            self.mesh(&mesh, m.material.as_deref(), &rows(&m.transform, "mesh")?, "mesh")?;
        }
        let end = self.row_counts();
        let [triangles, spheres, cylinders] = std::array::from_fn(|k| start[k]..end[k]);
        Ok(Part { rows: Group { triangles, spheres, cylinders }, shows })
    }

    fn row_counts(&self) -> [usize; 3] {
        let g = &self.geometry;
        [g.triangles.len(), g.spheres.len(), g.cylinders.len()]
    }

    /// True if any instance shows the mesh of this name.
    fn is_shown(&self, name: &str) -> bool {
        let d = self.description;
        let mut all = d.instance.iter().chain(d.group.iter().flat_map(|g| &g.instance));
        all.any(|i| i.of == name)
    }

    fn instances(&mut self, instances: &[describe::Instance]) -> Result<Vec<Instance>, CompileError> {
        let mut shows = Vec::with_capacity(instances.len());
        for i in instances {
            let group = self.target(&i.of)?;
            let material = match &i.material {
                Some(name) => self.table.row(Some(name))?,
                None => NO_MATERIAL,
            };
            let to_world = rows(&i.transform, &format!("instance of `{}`", i.of))?;
            shows.push(Instance { group, to_world, material });
        }
        Ok(shows)
    }

    /// The part that an instance names, compiled on first use. The description has no cycles: it was checked.
    fn target(&mut self, name: &str) -> Result<usize, CompileError> {
        match self.description.target(name) {
            Some(Target::Group(number, group)) => {
                self.cached(Key::Group(number), |world| world.part(group.objects()))
            }
            Some(Target::Mesh(mesh)) => self.mesh_part(name, mesh),
            None => unreachable!("the description was checked: `{name}` is a group or a mesh"),
        }
    }

    fn mesh_part(&mut self, name: &str, mesh: &describe::Mesh) -> Result<usize, CompileError> {
        let plain = describe::Mesh { name: None, transform: Default::default(), ..mesh.clone() };
        let key = Key::Mesh(name.to_owned());
        self.cached(key, |world| world.part(Objects { meshes: &[plain], ..NOTHING }))
    }

    fn cached(
        &mut self,
        key: Key,
        make: impl FnOnce(&mut Self) -> Result<Part, CompileError>,
    ) -> Result<usize, CompileError> {
        if let Some(&part) = self.part_of.get(&key) {
            return Ok(part);
        }
        let part = make(self)?;
        let number = self.add(part);
        self.part_of.insert(key, number);
        Ok(number)
    }

    fn add(&mut self, part: Part) -> usize {
        self.parts.push(part);
        self.parts.len() - 1
    }

    /// A mesh that instances show, in its own place: one more instance.
    fn shown_mesh(&mut self, name: &str, mesh: &describe::Mesh) -> Result<Instance, CompileError> {
        let group = self.mesh_part(name, mesh)?;
        Ok(Instance { group, to_world: rows(&mesh.transform, name)?, material: NO_MATERIAL })
    }

    /// Objects in a part of their own under a transform that their columns cannot hold: ellipsoids, elliptic cylinders.
    fn alone(
        &mut self,
        objects: Objects<'_>,
        transform: &describe::Transform,
        what: &str,
    ) -> Result<Instance, CompileError> {
        let part = self.part(objects)?;
        Ok(Instance { group: self.add(part), to_world: rows(transform, what)?, material: NO_MATERIAL })
    }

    fn sphere(&mut self, s: &describe::Sphere) -> Result<(), CompileError> {
        let (transform, scale) = similar(&s.transform, "sphere")?;
        let center = finite(transform.point(s.center), "center of a sphere")?;
        let radius = positive(s.radius * scale, "radius of a sphere")?;
        let material = self.table.row(s.material.as_deref())?;
        self.geometry.spheres.push(center, radius, material);
        room("spheres", self.geometry.spheres.len())
    }

    fn cylinder(&mut self, c: &describe::Cylinder) -> Result<(), CompileError> {
        let (transform, scale) = similar(&c.transform, "cylinder")?;
        let [from, to] = c.ends().map(|p| finite(transform.point(p), "end of a cylinder"));
        let ends = [from?, to?];
        if ends[0] == ends[1] {
            let value = c.ends()[0][0];
            return Err(CompileError::OutOfRange {
                what: "cylinder whose ends coincide once rounded".into(),
                value,
            });
        }
        let radius = positive(c.radius * scale, "radius of a cylinder")?;
        let material = self.table.row(c.material.as_deref())?;
        self.geometry.cylinders.push(ends, radius, c.caps, material);
        room("cylinders", self.geometry.cylinders.len())
    }

    fn planes(&mut self) -> Result<(), CompileError> {
        for p in &self.description.plane {
            let point = finite(p.point, "point of a plane")?;
            let length = p.normal.iter().map(|n| n * n).sum::<f64>().sqrt();
            let normal = finite(p.normal.map(|n| n / length), "normal of a plane")?;
            let material = self.table.row(p.material.as_deref())?;
            self.geometry.planes.push(point, normal, material);
        }
        room("planes", self.geometry.planes.len())
    }

    /// Appends a mesh, moved: vertices by the transform, normals by its transposed inverse. A mirroring transform turns
    /// each triangle around, so that its front stays outside.
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
        for p in &mesh.positions {
            let moved = transform.point(p.map(f64::from));
            // Vertices that no triangle uses may be anything.
            push3(&mut t.position, moved.map(|x| x as f32));
        }
        self.skipped_triangles += mesh.report.degenerate;
        let mirrored = transform.determinant() < 0.0;
        for (i, corners) in mesh.triangles.iter().enumerate() {
            let [a, b, c] = corners.map(|v| first as u32 + v);
            let turned = if mirrored { [a, c, b] } else { [a, b, c] };
            if has_no_area(turned.map(|v| row3(&t.position, v as usize))) {
                self.skipped_triangles += 1;
                continue;
            }
            for (column, v) in t.vertex.iter_mut().zip(turned) {
                column.push(v);
            }
            t.material.push(rows[mesh.triangle_materials.get(i).map_or(0, |&m| m as usize)]);
        }
        normals(t, mesh, transform, first);
        uvs(t, mesh, first);
        room("triangles", t.len())?;
        room("vertices", t.position[0].len())?;
        let used = mesh.triangles.as_flattened();
        let lost =
            used.iter().find(|&&v| !t.position.iter().all(|axis| axis[first + v as usize].is_finite()));
        match lost {
            Some(&v) => finite(transform.point(mesh.positions[v as usize].map(f64::from)), what).map(|_| ()),
            None => Ok(()),
        }
    }

    /// Rows for the materials of a mesh: the one named in the scene, or those of the file.
    fn material_rows(&mut self, mesh: &load::Mesh, name: Option<&str>) -> Result<Vec<u32>, CompileError> {
        if name.is_some() || mesh.materials.is_empty() {
            let row = self.table.row(name)?;
            return Ok(vec![row; mesh.materials.len().max(1)]);
        }
        mesh.materials.iter().map(|m| self.table.add(m)).collect()
    }

    /// Two levels: every instance, however deep, becomes one of the world, its transforms composed.
    fn flatten(mut self) -> Geometry {
        let parts = std::mem::take(&mut self.parts);
        self.geometry.groups = parts.iter().map(|p| p.rows.clone()).collect();
        let mut waiting: Vec<Instance> = parts[0].shows.iter().rev().cloned().collect();
        while let Some(instance) = waiting.pop() {
            for inner in parts[instance.group].shows.iter().rev() {
                let material =
                    if instance.material == NO_MATERIAL { inner.material } else { instance.material };
                let to_world = inner.to_world.then(&instance.to_world);
                waiting.push(Instance { group: inner.group, to_world, material });
            }
            let own = &parts[instance.group].rows;
            if !(own.triangles.is_empty() && own.spheres.is_empty() && own.cylinders.is_empty()) {
                self.geometry.instances.push(instance);
            }
        }
        self.geometry
    }
}

const NOTHING: Objects<'static> =
    Objects { spheres: &[], cylinders: &[], triangles: &[], quads: &[], meshes: &[], instances: &[] };

/// Keeps the normal columns as long as the vertex columns from the first mesh on that has normals.
fn normals(t: &mut crate::geometry::Triangles, mesh: &load::Mesh, transform: &Transform, first: usize) {
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
fn uvs(t: &mut crate::geometry::Triangles, mesh: &load::Mesh, first: usize) {
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

fn to_f32<const N: usize>(points: &[[f64; 3]; N]) -> Vec<[f32; 3]> {
    points.map(|p| p.map(|x| x as f32)).to_vec()
}

fn rows(t: &describe::Transform, what: &str) -> Result<Transform, CompileError> {
    Transform::from_rows(t.matrix())
        .map_err(|source| CompileError::Transform { what: what.to_owned(), source })
}

fn similar(t: &describe::Transform, what: &str) -> Result<(Transform, f64), CompileError> {
    let transform = rows(t, what)?;
    let scale = transform.uniform_scale().expect("objects under other transforms are instances");
    Ok((transform, scale))
}

fn finite(p: [f64; 3], what: &str) -> Result<[f32; 3], CompileError> {
    let narrow = p.map(|x| x as f32);
    match (0..3).find(|&k| !narrow[k].is_finite()) {
        Some(k) => Err(CompileError::OutOfRange { what: what.to_owned(), value: p[k] }),
        None => Ok(narrow),
    }
}

fn positive(x: f64, what: &str) -> Result<f32, CompileError> {
    let narrow = x as f32;
    let usable = narrow.is_finite() && narrow > 0.0;
    if usable { Ok(narrow) } else { Err(CompileError::OutOfRange { what: what.to_owned(), value: x }) }
}

fn room(what: &'static str, rows: usize) -> Result<(), CompileError> {
    let limit = PrimId::MAX_ROWS - 1;
    if rows <= limit { Ok(()) } else { Err(CompileError::TooMany { what, limit }) }
}
