//! Shapes and where rays meet them.

use octray::describe::{SceneDescription, Transform};

use super::Hit;
use super::vector::{V, add, cross, dot, normalize, scale, sub};

/// Rays start this far off their surface.
const NEAR: f64 = 1e-6;

/// A shape in a space of its own, and the way there.
pub(super) struct Shape {
    form: Form,
    material: Option<usize>,
    /// Columns of the inverse matrix's linear part, and the move: world to own space. None where they are one.
    to_own: Option<([V; 3], V)>,
}

enum Form {
    Sphere(V, f64),
    Cylinder { from: V, to: V, radius: f64, caps: bool },
    Triangle([V; 3]),
    Plane(V, V),
}

/// All shapes of a scene; transformed polygons are moved, other shapes keep the way to their space.
pub(super) fn shapes(scene: &SceneDescription) -> Vec<Shape> {
    assert!(scene.group.is_empty() && scene.instance.is_empty(), "the naive tracer knows no instances");
    let material = |name: &Option<String>| name.as_deref().map(|n| scene.material_index(n).unwrap());
    let mut all = Vec::new();
    for s in &scene.sphere {
        let form = Form::Sphere(s.center, s.radius);
        all.push(Shape { form, material: material(&s.material), to_own: inverse(&s.transform) });
    }
    for c in &scene.cylinder {
        let [from, to] = c.ends();
        let form = Form::Cylinder { from, to, radius: c.radius, caps: c.caps };
        all.push(Shape { form, material: material(&c.material), to_own: inverse(&c.transform) });
    }
    for p in &scene.plane {
        let form = Form::Plane(p.point, normalize(p.normal));
        all.push(Shape { form, material: material(&p.material), to_own: None });
    }
    let mut polygon = |corners: &[V], name: &Option<String>, transform: &Transform| {
        let m = transform.matrix();
        let moved: Vec<V> = corners
            .iter()
            .map(|&p| std::array::from_fn(|r| dot([m[r][0], m[r][1], m[r][2]], p) + m[r][3]))
            .collect();
        for k in 2..moved.len() {
            let form = Form::Triangle([moved[0], moved[k - 1], moved[k]]);
            all.push(Shape { form, material: material(name), to_own: None });
        }
    };
    for t in &scene.triangle {
        polygon(&t.vertices, &t.material, &t.transform);
    }
    for q in &scene.quad {
        polygon(&q.corners(), &q.material, &q.transform);
    }
    for m in &scene.mesh {
        let vertices = m.vertices.as_ref().expect("the naive tracer knows no mesh files");
        for face in m.faces.as_ref().unwrap() {
            let corners: Vec<V> = face.iter().map(|&i| vertices[i as usize]).collect();
            polygon(&corners, &m.material, &m.transform);
        }
    }
    all
}

/// By cofactors.
fn inverse(transform: &Transform) -> Option<([V; 3], V)> {
    if transform.is_empty() {
        return None;
    }
    let m = transform.matrix();
    let column = |c: usize| [m[0][c], m[1][c], m[2][c]];
    let [a, b, c] = [column(0), column(1), column(2)];
    let volume = dot(a, cross(b, c));
    let rows = [cross(b, c), cross(c, a), cross(a, b)].map(|r| scale(r, 1.0 / volume));
    Some((rows, column(3)))
}

impl Shape {
    pub(super) fn intersect(&self, origin: V, direction: V) -> Option<Hit> {
        let Some((rows, moved)) = self.to_own else {
            let (t, outward) = self.form.intersect(origin, direction)?;
            return Some(Hit { t, outward, material: self.material });
        };
        let apply = |v: V| rows.map(|row| dot(row, v));
        // The direction keeps its stretched length, so that t is that of the world.
        let (t, own) = self.form.intersect(apply(sub(origin, moved)), apply(direction))?;
        let outward = (0..3).fold(V::default(), |sum, k| add(sum, scale(rows[k], own[k])));
        Some(Hit { t, outward: normalize(outward), material: self.material })
    }
}

impl Form {
    fn intersect(&self, o: V, d: V) -> Option<(f64, V)> {
        match self {
            Self::Sphere(center, radius) => {
                let roots = around(sub(o, *center), d, *radius)?;
                let t = roots.into_iter().find(|&t| t > NEAR)?;
                Some((t, normalize(sub(add(o, scale(d, t)), *center))))
            }
            Self::Cylinder { from, to, radius, caps } => cylinder([*from, *to], *radius, *caps, o, d),
            Self::Triangle(corners) => triangle(corners, o, d),
            Self::Plane(point, normal) => {
                let t = dot(sub(*point, o), *normal) / dot(d, *normal);
                (t > NEAR && t.is_finite()).then_some((t, *normal))
            }
        }
    }
}

/// Where a line is at a distance from the origin: by the foot of the perpendicular.
fn around(o: V, d: V, radius: f64) -> Option<[f64; 2]> {
    let speed_squared = dot(d, d);
    let foot = -dot(o, d) / speed_squared;
    let nearest = add(o, scale(d, foot));
    let rest = radius * radius - dot(nearest, nearest);
    let half = (rest / speed_squared).sqrt();
    (rest > 0.0).then_some([foot - half, foot + half])
}

fn cylinder([from, to]: [V; 2], radius: f64, caps: bool, o: V, d: V) -> Option<(f64, V)> {
    let axis = sub(to, from);
    let (length, axis) = (dot(axis, axis).sqrt(), normalize(axis));
    let flat = |v: V| sub(v, scale(axis, dot(v, axis)));
    let at = |t: f64| sub(add(o, scale(d, t)), from);
    let mut found = Vec::new();
    for t in around(flat(sub(o, from)), flat(d), radius).into_iter().flatten() {
        if (0.0..=length).contains(&dot(at(t), axis)) {
            found.push((t, normalize(flat(at(t)))));
        }
    }
    for (height, outward) in [(0.0, scale(axis, -1.0)), (length, axis)] {
        let t = (height - dot(sub(o, from), axis)) / dot(d, axis);
        let off = flat(at(t));
        if caps && t.is_finite() && dot(off, off) <= radius * radius {
            found.push((t, outward));
        }
    }
    found.into_iter().filter(|(t, _)| *t > NEAR).min_by(|a, b| a.0.total_cmp(&b.0))
}

/// The plane first, then the side of each edge.
fn triangle(corners: &[V; 3], o: V, d: V) -> Option<(f64, V)> {
    let [a, b, c] = *corners;
    let normal = normalize(cross(sub(b, a), sub(c, a)));
    let t = dot(sub(a, o), normal) / dot(d, normal);
    if !(t > NEAR && t.is_finite()) {
        return None;
    }
    let p = add(o, scale(d, t));
    let left_of = |from: V, to: V| dot(cross(sub(to, from), sub(p, from)), normal) >= 0.0;
    (left_of(a, b) && left_of(b, c) && left_of(c, a)).then_some((t, normal))
}
