//! Objects as rows of columns, groups as ranges of rows and what they show of others.

use std::collections::HashMap;

use super::CompileError;
use super::flatten::flattened;
use super::materials::MaterialTable;
use super::rows::{is_bent, rows};
use crate::describe::{self, Objects, SceneDescription, Target};
use crate::geometry::{Geometry, Group, Instance, NO_MATERIAL};
use crate::intersect::PrimKind;
use crate::load::KeptMeshes;
use crate::scene::objects::{FirstNumbers, ObjectRows};

const NOTHING: Objects<'static> =
    Objects { spheres: &[], cylinders: &[], triangles: &[], quads: &[], meshes: &[], instances: &[] };

/// A group while it is compiled: its rows, and what it shows of other groups.
#[derive(Default)]
pub(super) struct Part {
    pub(super) rows: Group,
    pub(super) shows: Vec<Instance>,
}

impl Part {
    pub(super) fn is_empty(&self) -> bool {
        let Group { triangles, spheres, cylinders } = &self.rows;
        triangles.is_empty() && spheres.is_empty() && cylinders.is_empty()
    }
}

/// What identifies a part: a group by its number, a named mesh by its name.
#[derive(Clone, PartialEq, Eq, Hash)]
enum Key {
    Group(usize),
    Mesh(String),
}

/// The geometry so far.
pub(super) struct World<'a> {
    pub(super) description: &'a SceneDescription,
    pub(super) table: &'a mut MaterialTable,
    pub(super) meshes: &'a KeptMeshes,
    pub(super) geometry: Geometry,
    parts: Vec<Part>,
    part_of: HashMap<Key, usize>,
    pub(super) objects: ObjectRows,
    pub(super) skipped_triangles: usize,
}

/// What a description's objects became.
pub(super) struct Filled {
    pub(super) geometry: Geometry,
    pub(super) objects: ObjectRows,
    /// Triangles left out because they have no area.
    pub(super) skipped_triangles: usize,
}

impl<'a> World<'a> {
    /// All objects of a description as columns.
    pub(super) fn compile(
        description: &'a SceneDescription,
        table: &'a mut MaterialTable,
        meshes: &'a KeptMeshes,
        objects: ObjectRows,
    ) -> Result<Filled, CompileError> {
        let mut world = World {
            description,
            table,
            meshes,
            geometry: Geometry::default(),
            // Part 0 is the world; its rows are filled last but its number is first.
            parts: vec![Part::default()],
            part_of: HashMap::new(),
            objects,
            skipped_triangles: 0,
        };
        let top = world.part(description.objects())?;
        world.parts[0] = top;
        world.planes()?;
        let World { mut geometry, parts, objects, skipped_triangles, .. } = world;
        geometry.instances = flattened(&parts)?;
        geometry.groups = parts.into_iter().map(|part| part.rows).collect();
        Ok(Filled { geometry, objects, skipped_triangles })
    }

    /// Compiles objects to a part. Parts that it shows are compiled first, so that its own rows are contiguous.
    fn part(&mut self, objects: Objects<'_>) -> Result<Part, CompileError> {
        let first = FirstNumbers::of(&objects, self.description.plane.len());
        let mut shows = self.instances(objects.instances, first.instance)?;
        self.bent(objects, first, &mut shows)?;
        let mut own_meshes = Vec::new();
        for (mesh, number) in objects.meshes.iter().zip(first.mesh..) {
            match mesh.name.as_deref().filter(|name| self.is_shown(name)) {
                Some(name) => shows.push(self.shown_mesh(name, mesh, number)?),
                None => own_meshes.push((mesh, number)),
            }
        }
        let start = self.row_counts();
        self.own_rows(objects, first)?;
        for (mesh, number) in own_meshes {
            self.begin(PrimKind::Triangle, number);
            self.described_mesh(mesh)?;
        }
        let end = self.row_counts();
        let [triangles, spheres, cylinders] = std::array::from_fn(|k| start[k]..end[k]);
        Ok(Part { rows: Group { triangles, spheres, cylinders }, shows })
    }

    /// Objects under transforms that their columns cannot hold (ellipsoids, elliptic cylinders) become instances of parts
    /// of their own.
    fn bent(
        &mut self,
        objects: Objects<'_>,
        first: FirstNumbers,
        shows: &mut Vec<Instance>,
    ) -> Result<(), CompileError> {
        for (s, number) in objects.spheres.iter().zip(first.sphere..).filter(|(s, _)| is_bent(&s.transform)) {
            let straight = [describe::Sphere { transform: Default::default(), ..s.clone() }];
            let group = self.alone(Objects { spheres: &straight, ..NOTHING })?;
            shows.push(placed(group, &s.transform, number, "sphere")?);
        }
        for (c, number) in
            objects.cylinders.iter().zip(first.cylinder..).filter(|(c, _)| is_bent(&c.transform))
        {
            let straight = [describe::Cylinder { transform: Default::default(), ..c.clone() }];
            let group = self.alone(Objects { cylinders: &straight, ..NOTHING })?;
            shows.push(placed(group, &c.transform, number, "cylinder")?);
        }
        Ok(())
    }

    /// Everything but meshes and what is bent, as rows of the columns.
    fn own_rows(&mut self, objects: Objects<'_>, first: FirstNumbers) -> Result<(), CompileError> {
        for (s, number) in objects.spheres.iter().zip(first.sphere..).filter(|(s, _)| !is_bent(&s.transform))
        {
            self.begin(PrimKind::Sphere, number);
            self.sphere(s)?;
        }
        let cylinders = objects.cylinders.iter().zip(first.cylinder..);
        for (c, number) in cylinders.filter(|(c, _)| !is_bent(&c.transform)) {
            self.begin(PrimKind::Cylinder, number);
            self.cylinder(c)?;
        }
        for (t, number) in objects.triangles.iter().zip(first.triangle..) {
            self.begin(PrimKind::Triangle, number);
            self.polygon(&t.vertices, t.material.as_deref(), &t.transform, "triangle")?;
        }
        for (q, number) in objects.quads.iter().zip(first.quad..) {
            self.begin(PrimKind::Triangle, number);
            self.polygon(&q.corners(), q.material.as_deref(), &q.transform, "quad")?;
        }
        Ok(())
    }

    /// Says that the rows that follow are those of an object.
    pub(super) fn begin(&mut self, kind: PrimKind, number: u32) {
        self.objects.begin(kind, self.geometry.count(kind), number);
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

    fn instances(
        &mut self,
        instances: &[describe::Instance],
        first: u32,
    ) -> Result<Vec<Instance>, CompileError> {
        let mut shows = Vec::with_capacity(instances.len());
        for (i, object) in instances.iter().zip(first..) {
            let group = self.target(&i.of)?;
            let material = match &i.material {
                Some(name) => self.table.row(Some(name))?,
                None => NO_MATERIAL,
            };
            let to_world = rows(&i.transform, &format!("instance of `{}`", i.of))?;
            shows.push(Instance { group, to_world, material, object });
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
    fn shown_mesh(
        &mut self,
        name: &str,
        mesh: &describe::Mesh,
        number: u32,
    ) -> Result<Instance, CompileError> {
        placed(self.mesh_part(name, mesh)?, &mesh.transform, number, name)
    }

    /// Objects in a part of their own.
    fn alone(&mut self, objects: Objects<'_>) -> Result<usize, CompileError> {
        let part = self.part(objects)?;
        Ok(self.add(part))
    }
}

/// A part under a transform, seen as one object.
fn placed(
    group: usize,
    transform: &describe::Transform,
    object: u32,
    what: &str,
) -> Result<Instance, CompileError> {
    Ok(Instance { group, to_world: rows(transform, what)?, material: NO_MATERIAL, object })
}
