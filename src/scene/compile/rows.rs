//! Spheres, cylinders and planes as rows of their columns.

use super::CompileError;
use super::world::World;
use crate::describe;
use crate::intersect::{PrimId, PrimKind};
use crate::math::Transform;
use crate::scene::objects::FirstNumbers;

impl World<'_> {
    pub(super) fn sphere(&mut self, s: &describe::Sphere) -> Result<(), CompileError> {
        let (transform, scale) = similar(&s.transform, "sphere")?;
        let center = finite(transform.point(s.center), "center of a sphere")?;
        let radius = positive(s.radius * scale, "radius of a sphere")?;
        let material = self.table.row(s.material.as_deref())?;
        self.geometry.spheres.push(center, radius, material);
        room("spheres", self.geometry.spheres.len())
    }

    pub(super) fn cylinder(&mut self, c: &describe::Cylinder) -> Result<(), CompileError> {
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

    pub(super) fn planes(&mut self) -> Result<(), CompileError> {
        let first = FirstNumbers::of(&self.description.objects(), self.description.plane.len()).plane;
        for (p, number) in self.description.plane.iter().zip(first..) {
            self.begin(PrimKind::Plane, number);
            let point = finite(p.point, "point of a plane")?;
            let length = p.normal.iter().map(|n| n * n).sum::<f64>().sqrt();
            let normal = finite(p.normal.map(|n| n / length), "normal of a plane")?;
            let material = self.table.row(p.material.as_deref())?;
            self.geometry.planes.push(point, normal, material);
        }
        room("planes", self.geometry.planes.len())
    }
}

/// True for a transform under which a sphere is no sphere.
pub(super) fn is_bent(t: &describe::Transform) -> bool {
    !t.is_empty() && rows(t, "object").is_ok_and(|t| t.uniform_scale().is_none())
}

/// The matrix of a transform.
pub(super) fn rows(t: &describe::Transform, what: &str) -> Result<Transform, CompileError> {
    if t.is_empty() {
        return Ok(Transform::IDENTITY);
    }
    Transform::from_rows(t.matrix())
        .map_err(|source| CompileError::Transform { what: what.to_owned(), source })
}

/// A transform that scales all directions alike, and its factor.
fn similar(t: &describe::Transform, what: &str) -> Result<(Transform, f64), CompileError> {
    let transform = rows(t, what)?;
    let scale = transform.uniform_scale().expect("objects under other transforms are instances");
    Ok((transform, scale))
}

/// A point in `f32`.
pub(super) fn finite(p: [f64; 3], what: &str) -> Result<[f32; 3], CompileError> {
    let narrow = p.map(|x| x as f32);
    match (0..3).find(|&k| !narrow[k].is_finite()) {
        Some(k) => Err(CompileError::OutOfRange { what: what.to_owned(), value: p[k] }),
        None => Ok(narrow),
    }
}

/// A length in `f32`.
fn positive(x: f64, what: &str) -> Result<f32, CompileError> {
    let narrow = x as f32;
    let usable = narrow.is_finite() && narrow > 0.0;
    if usable { Ok(narrow) } else { Err(CompileError::OutOfRange { what: what.to_owned(), value: x }) }
}

/// Complains where a kind has more rows than ids can tell apart.
pub(super) fn room(what: &'static str, rows: usize) -> Result<(), CompileError> {
    let limit = PrimId::MAX_ROWS - 1;
    if rows <= limit { Ok(()) } else { Err(CompileError::TooMany { what, limit }) }
}
