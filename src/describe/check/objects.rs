//! Rules for everything that can be hit, and for transforms.

use super::super::transform::determinant;
use super::super::{
    Cylinder, Instance, Mesh, MeshSource, Objects, Plane, Procedural, Quad, SceneDescription, Sphere, Step,
    Transform, Triangle,
};
use super::faults::{Faults, largest};
use super::names::Names;

/// A mesh made by code may have this many triangles: its vertex numbers and columns still fit.
const MOST_TRIANGLES: u64 = 200_000_000;

pub(super) fn check(f: &mut Faults, scene: &SceneDescription, names: &Names<'_>) {
    objects(f, &scene.objects(), names);
    f.each("plane", &scene.plane, |f, plane| self::plane(f, plane, names));
    f.each("group", &scene.group, |f, group| objects(f, &group.objects(), names));
}

fn objects(f: &mut Faults, objects: &Objects<'_>, names: &Names<'_>) {
    f.each("sphere", objects.spheres, |f, item| sphere(f, item, names));
    f.each("cylinder", objects.cylinders, |f, item| cylinder(f, item, names));
    f.each("triangle", objects.triangles, |f, item| triangle(f, item, names));
    f.each("quad", objects.quads, |f, item| quad(f, item, names));
    f.each("mesh", objects.meshes, |f, item| mesh(f, item, names));
    f.each("instance", objects.instances, |f, item| instance(f, item, names));
}

fn sphere(f: &mut Faults, s: &Sphere, names: &Names<'_>) {
    f.point("center", &s.center);
    f.length("radius", s.radius);
    look(f, s.material.as_ref(), &s.transform, names);
}

fn cylinder(f: &mut Faults, c: &Cylinder, names: &Names<'_>) {
    match (c.from, c.to, c.center, c.half_height) {
        (Some(from), Some(to), None, None) => {
            let placed = f.point("from", &from) & f.point("to", &to);
            f.require("to", !placed || from != to, "is the same point as `from`: the axis has no length");
        }
        (None, None, Some(center), Some(half_height)) => {
            f.point("center", &center);
            f.length("half_height", half_height);
        }
        _ => f.add("a cylinder needs either `from` and `to`, or `center` and `half_height`"),
    }
    f.length("radius", c.radius);
    look(f, c.material.as_ref(), &c.transform, names);
}

fn triangle(f: &mut Faults, t: &Triangle, names: &Names<'_>) {
    f.point("vertices", t.vertices.as_flattened());
    look(f, t.material.as_ref(), &t.transform, names);
}

fn quad(f: &mut Faults, q: &Quad, names: &Names<'_>) {
    f.point("origin", &q.origin);
    f.direction("edge_u", &q.edge_u);
    f.direction("edge_v", &q.edge_v);
    let (u, v) = (largest(&q.edge_u), largest(&q.edge_v));
    let flat = (0..3).all(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        (q.edge_u[j] * q.edge_v[k] - q.edge_u[k] * q.edge_v[j]).abs() <= 1e-12 * u * v
    });
    f.require("edge_v", !(flat && u > 0.0 && v > 0.0), "runs along `edge_u`: the quad has no area");
    look(f, q.material.as_ref(), &q.transform, names);
}

fn plane(f: &mut Faults, p: &Plane, names: &Names<'_>) {
    f.point("point", &p.point);
    f.direction("normal", &p.normal);
    names.check_material(f, p.material.as_ref());
}

fn mesh(f: &mut Faults, m: &Mesh, names: &Names<'_>) {
    match m.source() {
        Some(MeshSource::File(path)) => {
            f.require("path", !path.as_os_str().is_empty(), "must not be empty");
        }
        Some(MeshSource::Inline { vertices, faces }) => inline_mesh(f, vertices, faces),
        Some(MeshSource::Procedural(procedural)) => f.at("procedural", |f| self::procedural(f, procedural)),
        None => f.add("a mesh needs exactly one of `path`, `vertices` with `faces`, or `procedural`"),
    }
    look(f, m.material.as_ref(), &m.transform, names);
}

fn inline_mesh(f: &mut Faults, vertices: &[[f64; 3]], faces: &[Vec<u32>]) {
    f.each("vertices", vertices, |f, vertex| {
        if !vertex.iter().all(|x| x.abs() <= 1e18) {
            f.add("not a point: coordinates must lie between -1e18 and 1e18");
        }
    });
    f.require("faces", !faces.is_empty(), "a mesh needs at least one face");
    f.each("faces", faces, |f, face| {
        if face.len() < 3 {
            f.add(format!("a face needs at least 3 vertices, has {}", face.len()));
        }
        if let Some(index) = face.iter().find(|&&i| i as usize >= vertices.len()) {
            f.add(format!("there is no vertex {index}: the mesh has {}", vertices.len()));
        }
    });
}

fn procedural(f: &mut Faults, p: Procedural) {
    let fits = (2..=MOST_TRIANGLES).contains(&p.triangles);
    f.require("triangles", fits, &format!("must be 2 to {MOST_TRIANGLES}, is {}", p.triangles));
}

fn instance(f: &mut Faults, i: &Instance, names: &Names<'_>) {
    names.check_target(f, &i.of);
    look(f, i.material.as_ref(), &i.transform, names);
}

fn look(f: &mut Faults, material: Option<&String>, transform: &Transform, names: &Names<'_>) {
    names.check_material(f, material);
    self::transform(f, transform);
}

/// Every step is finite and none flattens; neither do all of them together.
pub(super) fn transform(f: &mut Faults, transform: &Transform) {
    if transform.is_empty() {
        return;
    }
    f.each("transform", &transform.0, step);
    let m = transform.matrix();
    let size: f64 = m.iter().map(|row| largest(&[row[0], row[1], row[2]])).product();
    let determinant = determinant(&m);
    // Rows in one plane leave only rounding, 1e-16 of the size of the terms.
    let singular = !determinant.is_finite() || determinant.abs() <= 1e-12 * size;
    f.require(
        "transform",
        !singular,
        "is singular: it flattens everything (its determinant is 0 or not finite)",
    );
}

fn step(f: &mut Faults, step: &Step) {
    match step {
        Step::Translate(by) => _ = f.point("translate", by),
        Step::Scale(by) => {
            f.point("scale", &by.0);
            f.require("scale", by.0.iter().all(|s| *s != 0.0), "must not be 0 in any direction");
        }
        Step::RotateDeg(rotation) => f.at("rotate_deg", |f| {
            f.direction("axis", &rotation.axis);
            f.point("angle", &[rotation.angle]);
        }),
        Step::Matrix(rows) => matrix(f, rows),
    }
}

fn matrix(f: &mut Faults, rows: &[[f64; 4]]) {
    f.point("matrix", rows.as_flattened());
    f.require("matrix", matches!(rows.len(), 3 | 4), &format!("needs 3 or 4 rows, has {}", rows.len()));
    let affine = rows.get(3).is_none_or(|row| *row == [0.0, 0.0, 0.0, 1.0]);
    f.require("matrix", affine, "the fourth row must be [0, 0, 0, 1]");
}
