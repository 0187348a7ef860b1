//! Random worlds that make traversals err: touching, coplanar, coincident, flat, thin, mirrored.

use proptest::prelude::*;

use crate::geometry::{Geometry, Group, Instance, NO_MATERIAL, push3};
use crate::intersect::testing::dice::Dice;
use crate::math::Transform;

#[derive(Clone, Debug)]
pub(super) enum Shape {
    Triangle([[f32; 3]; 3]),
    Sphere([f32; 3], f32),
    Cylinder([[f32; 3]; 2], f32, bool),
    Plane([f32; 3], [f32; 3]),
}

/// What stands in the scene, what instances show, and where they show it.
#[derive(Clone, Debug, Default)]
pub(super) struct World {
    shapes: Vec<Shape>,
    shown: Vec<Shape>,
    instances: Vec<Transform>,
}

/// A grid as often as not, so that things touch; sometimes one roundoff beside it.
fn number() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => (-8..=8i8).prop_map(|i| f32::from(i) * 0.5),
        1 => (-4..=4i8).prop_map(|i| f32::from(i).next_up()),
        4 => -4.0..4.0f32,
    ]
}

fn point() -> impl Strategy<Value = [f32; 3]> {
    prop::array::uniform3(number())
}

fn size() -> impl Strategy<Value = f32> {
    prop_oneof![Just(0.5f32), Just(1.0), 0.01..2.0f32, Just(1e-4)]
}

/// Two corners and a third close to the line between them.
fn sliver() -> impl Strategy<Value = Vec<Shape>> {
    (point(), point(), -0.5..1.5f32, point(), prop::sample::select(vec![1e-2f32, 1e-4, 1e-6])).prop_map(
        |(a, b, along, aside, width)| {
            let c = std::array::from_fn(|k| a[k] + along * (b[k] - a[k]) + width * aside[k]);
            vec![Shape::Triangle([a, b, c])]
        },
    )
}

/// Two triangles in a plane across an axis.
fn flat_quad() -> impl Strategy<Value = Vec<Shape>> {
    (point(), 0..3usize, size(), size()).prop_map(|(corner, axis, width, height)| {
        let moved = |x: f32, y: f32| {
            let mut p = corner;
            p[(axis + 1) % 3] += x;
            p[(axis + 2) % 3] += y;
            p
        };
        let [a, b, c, d] = [moved(0.0, 0.0), moved(width, 0.0), moved(width, height), moved(0.0, height)];
        vec![Shape::Triangle([a, b, c]), Shape::Triangle([a, c, d])]
    })
}

fn shapes() -> impl Strategy<Value = Vec<Shape>> {
    let small = (point(), point(), point(), size()).prop_map(|(at, a, b, size)| {
        let beside = |p: [f32; 3]| std::array::from_fn(|k| at[k] + 0.25 * size * p[k]);
        vec![Shape::Triangle([at, beside(a), beside(b)])]
    });
    let large = prop::array::uniform3(point()).prop_map(|corners| vec![Shape::Triangle(corners)]);
    let sphere = (point(), size()).prop_map(|(center, radius)| vec![Shape::Sphere(center, radius)]);
    let cylinder = (point(), point(), size(), any::<bool>()).prop_map(|(from, to, radius, capped)| {
        let to = if from == to { [from[0], from[1], from[2] + 1.0] } else { to };
        vec![Shape::Cylinder([from, to], 0.5 * radius, capped)]
    });
    let shape =
        prop_oneof![4 => small, 2 => large, 2 => sliver(), 3 => flat_quad(), 3 => sphere, 3 => cylinder];
    // The same once more, now and then: coincident primitives.
    (shape, prop::bool::weighted(0.1)).prop_map(|(mut shapes, twice)| {
        if twice {
            shapes.extend(shapes.clone());
        }
        shapes
    })
}

fn plane() -> impl Strategy<Value = Shape> {
    let normal = prop_oneof![
        Just([0.0, 1.0, 0.0]),
        Just([-1.0, 0.0, 0.0]),
        point().prop_filter("a normal has a length", |n| n.iter().any(|&x| x != 0.0)),
    ];
    (point(), normal).prop_map(|(point, normal)| Shape::Plane(point, normal))
}

/// Turned, sheared and mirrored as it comes, but not flattened.
fn general() -> impl Strategy<Value = Transform> {
    let rows =
        prop::array::uniform3((point(), number()).prop_map(|(a, t)| [a[0], a[1], a[2], t].map(f64::from)));
    rows.prop_filter_map("a transform has an inverse", |rows| {
        Transform::from_rows(rows).ok().filter(|t| t.determinant().abs() > 1e-2)
    })
}

/// As it comes, along axes, or nearly flat.
fn transform() -> impl Strategy<Value = Transform> {
    // What is a roundoff in there is many out here.
    let pressed = (general(), 0..3usize, prop::sample::select(vec![1e-3, 1e-4])).prop_map(|(t, k, by)| {
        let mut rows = t.rows();
        rows[k] = rows[k].map(|x| x * by);
        Transform::from_rows(rows.map(|row| row.map(|x| 10.0 * x))).expect("not flattened all the way")
    });
    let stretch =
        (prop::array::uniform3(prop::sample::select(vec![-2.0, -1.0, -0.1, 0.25, 1.0, 3.0])), point());
    let stretched = stretch.prop_map(|([x, y, z], t)| {
        let [a, b, c] = t.map(f64::from);
        Transform::from_rows([[x, 0.0, 0.0, a], [0.0, y, 0.0, b], [0.0, 0.0, z, c]])
            .expect("no scale is zero")
    });
    prop_oneof![2 => general(), 1 => pressed, 2 => stretched]
}

/// Worlds of up to about `most` primitives.
pub(super) fn world(most: usize) -> impl Strategy<Value = World> {
    let many = |most| prop::collection::vec(shapes(), 0..most).prop_map(|s| s.concat());
    let shown = prop_oneof![2 => Just(Vec::new()), 1 => many(most / 8 + 2)];
    let planes = prop_oneof![3 => Just(Vec::new()), 1 => prop::collection::vec(plane(), 1..3)];
    (many(most), planes, shown, prop::collection::vec(transform(), 0..12)).prop_map(
        |(mut shapes, planes, shown, instances)| {
            shapes.extend(planes);
            let instances = if shown.is_empty() { Vec::new() } else { instances };
            World { shapes, shown, instances }
        },
    )
}

impl World {
    /// A triangle, seen through an instance.
    pub(super) fn one_instance(corners: [[f32; 3]; 3], place: Transform) -> Self {
        Self { shown: vec![Shape::Triangle(corners)], instances: vec![place], ..Self::default() }
    }

    pub(super) fn push_mesh(&mut self, points: &[[f32; 3]], triangles: &[[u32; 3]]) {
        let corners = triangles.iter().map(|t| Shape::Triangle(t.map(|v| points[v as usize])));
        self.shapes.extend(corners);
    }

    /// The same world, primitives in another order.
    pub(super) fn shuffled(&self, seed: u64) -> Self {
        let mut dice = Dice(seed);
        let mut world = self.clone();
        for shapes in [&mut world.shapes, &mut world.shown] {
            for i in (1..shapes.len()).rev() {
                shapes.swap(i, dice.below(i + 1));
            }
        }
        world
    }

    /// Points that matter, in world space: corners, centres, ends, rims.
    pub(super) fn landmarks(&self) -> Vec<[f32; 3]> {
        let here = self.shapes.iter().flat_map(Shape::landmarks);
        let through = self.instances.iter().flat_map(|place| {
            let shown = self.shown.iter().flat_map(Shape::landmarks);
            shown.map(|p| place.point(p.map(f64::from)).map(|x| x as f32))
        });
        here.chain(through).collect()
    }

    pub(super) fn geometry(&self) -> Geometry {
        let mut g = Geometry::default();
        let groups = [&self.shapes, &self.shown].map(|shapes| {
            let start = [g.triangles.len(), g.spheres.len(), g.cylinders.len()];
            shapes.iter().for_each(|shape| shape.push(&mut g));
            Group {
                triangles: start[0]..g.triangles.len(),
                spheres: start[1]..g.spheres.len(),
                cylinders: start[2]..g.cylinders.len(),
            }
        });
        g.groups = groups.to_vec();
        let shown = |&to_world: &Transform| Instance { group: 1, to_world, material: NO_MATERIAL, object: 1 };
        g.instances = self.instances.iter().map(shown).collect();
        g
    }
}

impl Shape {
    fn push(&self, g: &mut Geometry) {
        match *self {
            Shape::Triangle(corners) => {
                for (column, corner) in g.triangles.vertex.iter_mut().zip(corners) {
                    column.push(g.triangles.position[0].len() as u32);
                    push3(&mut g.triangles.position, corner);
                }
                g.triangles.material.push(NO_MATERIAL);
            }
            Shape::Sphere(center, radius) => g.spheres.push(center, radius, NO_MATERIAL),
            Shape::Cylinder(ends, radius, capped) => g.cylinders.push(ends, radius, capped, NO_MATERIAL),
            Shape::Plane(point, normal) => g.planes.push(point, normal, NO_MATERIAL),
        }
    }

    fn landmarks(&self) -> Vec<[f32; 3]> {
        let beside = |p: [f32; 3], by: f32| {
            [[p[0] + by, p[1], p[2]], [p[0], p[1] - by, p[2]], [p[0], p[1], p[2] + by]]
        };
        match *self {
            Shape::Triangle(corners) => corners.to_vec(),
            Shape::Sphere(center, radius) => [vec![center], beside(center, radius).to_vec()].concat(),
            Shape::Cylinder([from, to], radius, _) => {
                [vec![from, to], beside(from, radius).to_vec(), beside(to, radius).to_vec()].concat()
            }
            Shape::Plane(point, _) => vec![point],
        }
    }
}

/// Small spheres all over a cube.
pub(in crate::accel) fn scattered_spheres(count: usize, dice: &mut Dice) -> Geometry {
    let mut g = Geometry::default();
    for _ in 0..count {
        let center = dice.point();
        (0..3).for_each(|k| g.spheres.center[k].push(center[k] as f32));
        g.spheres.radius.push(0.01);
        g.spheres.material.push(0);
    }
    g.groups = vec![Group { triangles: 0..0, spheres: 0..count, cylinders: 0..0 }];
    g
}
