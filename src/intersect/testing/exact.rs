//! The exact oracle for rays and primitives as the tests hold them.

use crate::intersect::RayLanes;
use crate::intersect::oracle::{self, Line, Shape};
use crate::math::{Real, Vec3};

fn numbers<R: Real>(p: Vec3<R>) -> [f64; 3] {
    p.get(0).map(Real::to_f64)
}

fn line<R: Real>(ray: &RayLanes<R>) -> Line {
    Line { origin: numbers(ray.origin), direction: numbers(ray.direction) }
}

/// `t` where the line meets the triangle, edges included; nothing for one seen edge-on.
pub(crate) fn triangle<R: Real>(ray: &RayLanes<R>, vertices: [Vec3<R>; 3]) -> Option<f64> {
    oracle::triangle(&line(ray), vertices.map(numbers))
}

/// Where the line enters and leaves the sphere.
pub(crate) fn sphere<R: Real>(ray: &RayLanes<R>, center: Vec3<R>, radius: f64) -> Option<[f64; 2]> {
    oracle::sphere(&line(ray), numbers(center), radius)
}

/// Whether the line meets the capped cylinder with the radius and both ends grown by `margin`, which may be negative.
pub(crate) fn cylinder<R: Real>(ray: &RayLanes<R>, ends: [Vec3<R>; 2], radius: f64, margin: f64) -> bool {
    let [from, to] = ends.map(numbers);
    let shape = Shape::Cylinder(oracle::Cylinder { from, to, radius, capped: true });
    let grown = if margin == 0.0 { Some(shape) } else { shape.grown(margin) };
    grown.is_some_and(|shape| oracle::surfaces(&line(ray), &shape)[0].is_some())
}
