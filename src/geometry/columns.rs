//! Primitives as columns, by kind, and the groups that instances show.

use std::ops::Range;

use crate::intersect::{PrimKind, cylinder, sphere, triangle};
use crate::math::{Aabb, Transform, three};

/// No material of its own: keeps the primitive's.
pub const NO_MATERIAL: u32 = u32::MAX;

/// Triangles: three index columns into shared vertex columns.
///
/// **Shape:** `vertex[k][row]` is the k-th corner of a row; `position[axis][vertex]`. `normal` and `uv` are empty, or as
/// long as the vertex columns where any mesh needs them; a vertex without a normal of its own has the zero vector.
#[derive(Clone, Debug, Default)]
pub struct Triangles {
    /// Vertex coordinates by axis.
    pub position: [Vec<f32>; 3],
    /// Vertex normals by axis, or empty.
    pub normal: [Vec<f32>; 3],
    /// Texture coordinates, or empty.
    pub uv: [Vec<f32>; 2],
    /// Corner indices.
    pub vertex: [Vec<u32>; 3],
    /// Material rows.
    pub material: Vec<u32>,
}

/// Spheres.
#[derive(Clone, Debug, Default)]
pub struct Spheres {
    /// Centres by axis.
    pub center: [Vec<f32>; 3],
    /// Radii.
    pub radius: Vec<f32>,
    /// Material rows.
    pub material: Vec<u32>,
}

/// Cylinders.
#[derive(Clone, Debug, Default)]
pub struct Cylinders {
    /// Centres of the first caps by axis.
    pub from: [Vec<f32>; 3],
    /// Centres of the second caps by axis.
    pub to: [Vec<f32>; 3],
    /// Radii.
    pub radius: Vec<f32>,
    /// Closed by caps.
    pub capped: Vec<bool>,
    /// Material rows.
    pub material: Vec<u32>,
}

/// Infinite planes.
#[derive(Clone, Debug, Default)]
pub struct Planes {
    /// Points on the planes by axis.
    pub point: [Vec<f32>; 3],
    /// Normals by axis, length one within rounding.
    pub normal: [Vec<f32>; 3],
    /// Material rows.
    pub material: Vec<u32>,
}

/// The rows of each kind that belong together: the world, or what an instance shows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Group {
    /// Triangle rows.
    pub triangles: Range<usize>,
    /// Sphere rows.
    pub spheres: Range<usize>,
    /// Cylinder rows.
    pub cylinders: Range<usize>,
}

/// A group shown once more, elsewhere.
#[derive(Clone, Debug)]
pub struct Instance {
    /// Which group.
    pub group: usize,
    /// From the group's space to the world's.
    pub to_world: Transform,
    /// Material in place of the primitives' own, or [`NO_MATERIAL`].
    pub material: u32,
    /// Number of the object in the scene file that puts it here.
    pub object: u32,
}

/// All primitives of a scene. Group 0 is the world: the primitives that stand in the scene itself.
#[derive(Clone, Debug, Default)]
pub struct Geometry {
    /// Triangles of all groups.
    pub triangles: Triangles,
    /// Spheres of all groups.
    pub spheres: Spheres,
    /// Cylinders of all groups.
    pub cylinders: Cylinders,
    /// Planes; they belong to the world.
    pub planes: Planes,
    /// Rows of each group; the first is the world.
    pub groups: Vec<Group>,
    /// Instances, all in the world.
    pub instances: Vec<Instance>,
}

/// Row `i` of three columns.
#[inline(always)]
pub(crate) fn row3(columns: &[Vec<f32>; 3], i: usize) -> [f32; 3] {
    [columns[0][i], columns[1][i], columns[2][i]]
}

/// Appends a row to three columns.
pub(crate) fn push3(columns: &mut [Vec<f32>; 3], row: [f32; 3]) {
    for (column, value) in columns.iter_mut().zip(row) {
        column.push(value);
    }
}

impl Triangles {
    /// Number of rows.
    pub fn len(&self) -> usize {
        self.material.len()
    }
    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.material.is_empty()
    }
    /// The corners of a row.
    #[inline(always)]
    pub fn corners(&self, row: usize) -> [[f32; 3]; 3] {
        three(|k| row3(&self.position, self.vertex[k][row] as usize))
    }
    /// The box of a row.
    pub fn bounds(&self, row: usize) -> Aabb {
        triangle::bounds(self.corners(row))
    }
}

impl Spheres {
    /// Number of rows.
    pub fn len(&self) -> usize {
        self.material.len()
    }
    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.material.is_empty()
    }
    /// Appends a row.
    pub fn push(&mut self, center: [f32; 3], radius: f32, material: u32) {
        push3(&mut self.center, center);
        self.radius.push(radius);
        self.material.push(material);
    }
    /// The box of a row.
    pub fn bounds(&self, row: usize) -> Aabb {
        sphere::bounds(row3(&self.center, row), self.radius[row])
    }
}

impl Cylinders {
    /// Number of rows.
    pub fn len(&self) -> usize {
        self.material.len()
    }
    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.material.is_empty()
    }
    /// Appends a row.
    pub fn push(&mut self, [from, to]: [[f32; 3]; 2], radius: f32, capped: bool, material: u32) {
        push3(&mut self.from, from);
        push3(&mut self.to, to);
        self.radius.push(radius);
        self.capped.push(capped);
        self.material.push(material);
    }
    /// The box of a row.
    pub fn bounds(&self, row: usize) -> Aabb {
        cylinder::bounds(row3(&self.from, row), row3(&self.to, row), self.radius[row])
    }
}

impl Planes {
    /// Number of rows.
    pub fn len(&self) -> usize {
        self.material.len()
    }
    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.material.is_empty()
    }
    /// Appends a row.
    pub fn push(&mut self, point: [f32; 3], normal: [f32; 3], material: u32) {
        push3(&mut self.point, point);
        push3(&mut self.normal, normal);
        self.material.push(material);
    }
}

impl Geometry {
    /// Number of rows of a kind.
    pub fn count(&self, kind: PrimKind) -> usize {
        match kind {
            PrimKind::Triangle => self.triangles.len(),
            PrimKind::Sphere => self.spheres.len(),
            PrimKind::Cylinder => self.cylinders.len(),
            PrimKind::Plane => self.planes.len(),
        }
    }
    /// The material row of a primitive.
    pub fn material(&self, kind: PrimKind, row: usize) -> u32 {
        self.materials(kind)[row]
    }
    /// Material rows of the primitives of a kind.
    pub(crate) fn materials(&self, kind: PrimKind) -> &[u32] {
        match kind {
            PrimKind::Triangle => &self.triangles.material,
            PrimKind::Sphere => &self.spheres.material,
            PrimKind::Cylinder => &self.cylinders.material,
            PrimKind::Plane => &self.planes.material,
        }
    }
}
