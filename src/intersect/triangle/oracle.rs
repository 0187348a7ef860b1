//! The plain version: three signed volumes and the plane.
//!
//! Seen along the ray, it passes on the inner side of an edge where the tetrahedron of direction and edge has the sign
//! of the other two. `t` comes from the triangle's plane, `u` and `v` are shares of the volumes. No shear, no shared
//! products, all in `f64`.

use crate::intersect::RayLanes;
use crate::math::Vec3;

/// Where the line of a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// In units of the direction's length.
    pub t: f64,
    /// Weight of vertex 1.
    pub u: f64,
    /// Weight of vertex 2.
    pub v: f64,
}

/// Where the line of the ray meets the triangle, edges and vertices included; nothing for a triangle seen edge-on.
///
/// **Accuracy:** that of `f64` volumes: a line within some 10 roundoffs (of the distance to the farthest vertex) of an
/// edge may count for either side.
pub fn meet(ray: &RayLanes<f64>, vertices: [Vec3<f64>; 3]) -> Option<Meeting> {
    let [a, b, c] = vertices.map(|v| v - ray.origin);
    let d = ray.direction;
    let weights = [d.dot(b.cross(c)), d.dot(c.cross(a)), d.dot(a.cross(b))];
    let sum: f64 = weights.iter().sum();
    let inside = weights.iter().all(|w| *w >= 0.0) || weights.iter().all(|w| *w <= 0.0);
    if !inside || sum == 0.0 {
        return None;
    }
    let normal = (vertices[1] - vertices[0]).cross(vertices[2] - vertices[0]);
    let t = normal.dot(a) / normal.dot(d);
    t.is_finite().then_some(Meeting { t, u: weights[1] / sum, v: weights[2] / sum })
}
