//! Vertex and index buffers, spheres and cylinders to a [`RayScene`].

use super::RayScene;
use crate::accel::node::ChildRef;
use crate::accel::{Accel, Quality};
use crate::geometry::{Geometry, Group, NO_MATERIAL, push3};

/// Collects the primitives of a [`RayScene`].
///
/// Meshes, spheres and cylinders are each numbered from 0 in the order of adding, triangles within their mesh as in its
/// index buffer; [`RayScene::primitive`] leads from a hit back to these numbers.
#[derive(Clone, Debug, Default)]
pub struct RaySceneBuilder {
    pub(super) geometry: Geometry,
    mesh_start: Vec<usize>,
}

/// Why a primitive cannot be added.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RaySceneError {
    /// A triangle names a vertex that the mesh does not have.
    #[error("triangle {triangle} uses vertex {index}: the mesh has {vertices}, counted from 0")]
    Index {
        /// Place in the index buffer.
        triangle: usize,
        /// The vertex it names.
        index: u32,
        /// Vertices of the mesh.
        vertices: usize,
    },
    /// A vertex coordinate is NaN or infinite.
    #[error("vertex {vertex} is {position:?}: coordinates must be finite")]
    Vertex {
        /// Place in the vertex buffer.
        vertex: usize,
        /// Its coordinates.
        position: [f32; 3],
    },
    /// A centre or end point is NaN or infinite.
    #[error("{point:?} is no point: coordinates must be finite")]
    Point {
        /// Its coordinates.
        point: [f32; 3],
    },
    /// A radius is not a positive finite number.
    #[error("the radius is {radius}: it must be positive and finite")]
    Radius {
        /// As given.
        radius: f32,
    },
    /// Both ends of a cylinder are one point.
    #[error("both ends of the cylinder are {point:?}: its axis has no direction")]
    Axis {
        /// Both ends.
        point: [f32; 3],
    },
    /// More than the tree can number.
    #[error("more than {limit} {what} in one scene")]
    TooMany {
        /// Of what.
        what: &'static str,
        /// The most there can be.
        limit: usize,
    },
}

impl RaySceneBuilder {
    /// Most primitives of a scene, all kinds together.
    pub const MAX_PRIMITIVES: usize = ChildRef::CAPACITY - 1;

    /// A scene without primitives, which no ray hits.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a triangle mesh: three vertex numbers a triangle. Triangles without area keep their number and are never
    /// hit.
    ///
    /// **Errors:** an index out of range, a vertex that is not finite (used or not), too many primitives or vertices.
    pub fn mesh(mut self, vertices: &[[f32; 3]], indices: &[[u32; 3]]) -> Result<Self, RaySceneError> {
        self.check_room(indices.len())?;
        let first = self.geometry.triangles.position[0].len();
        let limit = u32::MAX as usize;
        if vertices.len() > limit - first {
            return Err(RaySceneError::TooMany { what: "vertices", limit });
        }
        check_vertices(vertices)?;
        check_indices(vertices.len(), indices)?;
        let triangles = &mut self.geometry.triangles;
        self.mesh_start.push(triangles.len());
        for &vertex in vertices {
            push3(&mut triangles.position, vertex);
        }
        for &triangle in indices {
            let [a, b, c] = triangle.map(|index| vertices[index as usize]);
            // Rounding can give a sliver without area a sign of its own; a point has none for any ray.
            let triangle = if has_area(a, b, c) { triangle } else { [triangle[0]; 3] };
            for (column, index) in triangles.vertex.iter_mut().zip(triangle) {
                column.push(first as u32 + index);
            }
            triangles.material.push(NO_MATERIAL);
        }
        Ok(self)
    }

    /// Adds a sphere.
    ///
    /// **Errors:** a centre that is not finite, a radius that is not positive and finite, too many primitives.
    pub fn sphere(mut self, center: [f32; 3], radius: f32) -> Result<Self, RaySceneError> {
        self.check_room(1)?;
        check_point(center)?;
        check_radius(radius)?;
        self.geometry.spheres.push(center, radius, NO_MATERIAL);
        Ok(self)
    }

    /// Adds a cylinder around the line between two points, closed by caps or open at both ends.
    ///
    /// **Errors:** an end that is not finite, equal ends, a radius that is not positive and finite, too many
    /// primitives.
    pub fn cylinder(
        mut self,
        from: [f32; 3],
        to: [f32; 3],
        radius: f32,
        capped: bool,
    ) -> Result<Self, RaySceneError> {
        self.check_room(1)?;
        check_point(from)?;
        check_point(to)?;
        check_radius(radius)?;
        if from == to {
            return Err(RaySceneError::Axis { point: from });
        }
        self.geometry.cylinders.push([from, to], radius, capped, NO_MATERIAL);
        Ok(self)
    }

    /// Builds the tree, in parallel on the current rayon pool. The result is the same for any number of threads.
    pub fn build(self) -> RayScene {
        self.build_with(Quality::default())
    }

    /// [`RaySceneBuilder::build`] with more or less work. Hits are the same, but in tier `Fast`.
    pub fn build_with(self, quality: Quality) -> RayScene {
        let Self { mut geometry, mesh_start } = self;
        let counts = [geometry.triangles.len(), geometry.spheres.len(), geometry.cylinders.len()];
        let [triangles, spheres, cylinders] = counts.map(|count| 0..count);
        geometry.groups = vec![Group { triangles, spheres, cylinders }];
        RayScene { accel: Accel::build_with(&geometry, quality), mesh_start, counts }
    }

    fn check_room(&self, more: usize) -> Result<(), RaySceneError> {
        let g = &self.geometry;
        let taken = g.triangles.len() + g.spheres.len() + g.cylinders.len();
        let limit = Self::MAX_PRIMITIVES;
        let fits = more <= limit - taken;
        if fits { Ok(()) } else { Err(RaySceneError::TooMany { what: "primitives", limit }) }
    }
}

fn is_finite(point: &[f32; 3]) -> bool {
    point.iter().all(|x| x.is_finite())
}

fn check_point(point: [f32; 3]) -> Result<(), RaySceneError> {
    if is_finite(&point) { Ok(()) } else { Err(RaySceneError::Point { point }) }
}

fn check_radius(radius: f32) -> Result<(), RaySceneError> {
    let positive = radius > 0.0 && radius.is_finite();
    if positive { Ok(()) } else { Err(RaySceneError::Radius { radius }) }
}

fn check_vertices(vertices: &[[f32; 3]]) -> Result<(), RaySceneError> {
    let bad = vertices.iter().position(|vertex| !is_finite(vertex));
    bad.map_or(Ok(()), |vertex| Err(RaySceneError::Vertex { vertex, position: vertices[vertex] }))
}

fn check_indices(vertices: usize, indices: &[[u32; 3]]) -> Result<(), RaySceneError> {
    let bad = indices.as_flattened().iter().position(|&index| index as usize >= vertices);
    bad.map_or(Ok(()), |at| {
        Err(RaySceneError::Index { triangle: at / 3, index: indices.as_flattened()[at], vertices })
    })
}

/// Whether the cross product of two edges is not zero, in `f64`.
fn has_area(a: [f32; 3], b: [f32; 3], c: [f32; 3]) -> bool {
    let edge = |to: [f32; 3]| -> [f64; 3] { std::array::from_fn(|k| f64::from(to[k]) - f64::from(a[k])) };
    let ([ux, uy, uz], [vx, vy, vz]) = (edge(b), edge(c));
    [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx] != [0.0; 3]
}
