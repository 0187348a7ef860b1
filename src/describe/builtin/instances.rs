//! `instances`: three groups and a mesh, seen hundreds of times: turned, stretched, mirrored.

use super::super::{Background, Camera, Group, Instance, Mesh, Plane, SceneDescription, Transform};
use super::parts::{cylinder, dielectric, diffuse, glossy, metal, quad, sphere, suns, unit_hash, upright};
use crate::describe::transform::sin_cos_deg;

const ROWS: u32 = 20;
const COLUMNS: u32 = 20;
const SPACING: f64 = 1.5;

pub(super) fn scene() -> SceneDescription {
    let camera = Camera::perspective([2.5, 6.2, 19.0], [0.0, 2.0, 4.0], 38.0);
    let mut scene = SceneDescription::new(camera);
    scene.background = Background::gradient([0.82, 0.80, 0.76], [0.30, 0.46, 0.70]);
    scene.light = suns(&[
        ([0.58, -0.70, -0.45], [1.0, 0.94, 0.84], 0.95),
        ([-0.75, -0.50, 0.10], [0.70, 0.82, 1.0], 0.25),
    ]);
    scene.material = vec![
        diffuse("ground", [0.50, 0.52, 0.44]),
        diffuse("bark", [0.36, 0.24, 0.15]),
        glossy("leaf", [0.20, 0.50, 0.18], 0.15),
        glossy("blossom", [0.88, 0.45, 0.55], 0.15),
        glossy("tread", [0.80, 0.36, 0.18], 0.2),
        metal("steel", [0.90, 0.92, 0.95]),
        metal("gold", [0.98, 0.78, 0.36]),
        dielectric("glass", 1.5),
        glossy("crystal", [0.30, 0.42, 0.85], 0.6),
    ];
    let normal = [0.0, 1.0, 0.0];
    scene.plane.push(Plane { point: [0.0; 3], normal, material: Some("ground".into()) });
    scene.group = vec![tree(), stair(), lantern(), quarry()];
    scene.instance = (0..ROWS * COLUMNS).map(placed).collect();
    scene
}

/// One cell of the grid: which thing, how it is turned, stretched and mirrored.
fn placed(number: u32) -> Instance {
    let chance = |dimension| unit_hash(number, dimension);
    let of = ["tree", "stair", "lantern", "crystal"][(chance(0) * 4.0) as usize];
    let size = 0.7 + 0.5 * chance(1);
    // Every second one is mirrored: left-handed stairs, triangles seen from their other side.
    let mirror = if number.is_multiple_of(2) { 1.0 } else { -1.0 };
    let cell = |i: u32, count: u32| (f64::from(i) - 0.5 * f64::from(count - 1)) * SPACING;
    let place = [
        cell(number % COLUMNS, COLUMNS) + 0.3 * (chance(2) - 0.5),
        0.0,
        cell(number / COLUMNS, ROWS) + 0.3 * (chance(3) - 0.5),
    ];
    let transform = Transform::default()
        .scale([mirror * size, size * (0.8 + 0.7 * chance(4)), size * (0.8 + 0.4 * chance(5))])
        .rotate_deg([0.0, 1.0, 0.0], 360.0 * chance(6))
        .rotate_deg([1.0, 0.0, 0.3], 8.0 * (chance(7) - 0.5))
        .translate(place);
    let material = match (of, number % 3) {
        ("crystal", 0) => Some("glass".to_owned()),
        ("crystal", 1) => Some("gold".to_owned()),
        _ => None,
    };
    Instance { of: of.into(), material, transform }
}

fn tree() -> Group {
    let mut group = Group { name: "tree".into(), ..Group::default() };
    group.cylinder.push(cylinder("bark", [0.0, -0.1, 0.0], [0.05, 0.7, 0.0], 0.07));
    group.cylinder.push(cylinder("bark", [0.03, 0.45, 0.0], [0.28, 0.75, 0.05], 0.04));
    group.sphere.push(sphere("leaf", [0.0, 0.95, 0.0], 0.36));
    group.sphere.push(sphere("leaf", [0.30, 0.85, 0.06], 0.22));
    group.sphere.push(sphere("leaf", [-0.22, 0.80, 0.10], 0.24));
    group.sphere.push(sphere("blossom", [0.12, 1.12, 0.26], 0.09));
    group
}

/// A spiral stair: mirrored, it winds the other way.
fn stair() -> Group {
    let mut group = Group { name: "stair".into(), ..Group::default() };
    group.cylinder.push(upright("steel", [0.0, 0.55, 0.0], 0.06, 0.65));
    for step in 0..14 {
        let (height, angle) = (0.08 * f64::from(step), 27.0 * f64::from(step));
        let ([sin_a, cos_a], [sin_b, cos_b]) = (pair(angle), pair(angle + 24.0));
        let near = [0.5 * cos_a, 0.0, 0.5 * sin_a];
        let across = [0.5 * (cos_b - cos_a), 0.0, 0.5 * (sin_b - sin_a)];
        group.quad.push(quad("tread", [0.0, height, 0.0], near, across));
    }
    group
}

fn pair(angle: f64) -> [f64; 2] {
    let (sin, cos) = sin_cos_deg(angle);
    [sin, cos]
}

fn lantern() -> Group {
    let mut group = Group { name: "lantern".into(), ..Group::default() };
    group.cylinder.push(upright("steel", [0.0, 0.3, 0.0], 0.05, 0.4));
    group.sphere.push(sphere("glass", [0.0, 0.92, 0.0], 0.24));
    group.sphere.push(sphere("gold", [0.0, 0.92, 0.0], 0.1));
    group
}

/// A group that no instance shows: it only holds the mesh `crystal`, so that the mesh is not seen by itself.
fn quarry() -> Group {
    let mut group = Group { name: "quarry".into(), ..Group::default() };
    let mut crystal = octahedron([0.34, 0.62, 0.28], 0.5);
    crystal.name = Some("crystal".into());
    crystal.material = Some("crystal".into());
    group.mesh.push(crystal);
    group
}

/// A stretched octahedron around `(0, height, 0)`, its faces outwards.
fn octahedron(half: [f64; 3], height: f64) -> Mesh {
    let [x, y, z] = half;
    let vertices =
        [[x, 0.0, 0.0], [0.0, 0.0, z], [-x, 0.0, 0.0], [0.0, 0.0, -z], [0.0, y, 0.0], [0.0, -y, 0.0]]
            .map(|[x, y, z]| [x, y + height, z]);
    let faces = (0..4u32).flat_map(|i| [vec![(i + 1) % 4, i, 4], vec![i, (i + 1) % 4, 5]]).collect();
    Mesh::inline(vertices.to_vec(), faces)
}
