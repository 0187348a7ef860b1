//! `glass`: dielectrics inside dielectrics.
//!
//! Bodies nest up to three deep (a drop in a bubble in a ball), air inside glass being a body of its own. Surfaces of
//! two bodies never coincide: a film of the outer one parts them.

use super::super::{Background, Camera, Mesh, SceneDescription, Transform};
use super::parts::{cylinder, dielectric, diffuse, glossy, point_lights, sphere, upright};

/// Thickness of the film between two bodies.
const FILM: f64 = 0.004;

pub(super) fn scene() -> SceneDescription {
    let camera = Camera::perspective([1.2, 3.1, 8.2], [0.0, 1.0, 0.0], 36.0);
    let mut scene = SceneDescription::new(camera);
    scene.render.max_depth = 12;
    scene.background = Background::gradient([0.80, 0.80, 0.78], [0.36, 0.50, 0.72]);
    scene.light = point_lights(&[
        ([-5.0, 8.0, 5.0], [1.0, 0.96, 0.90], 75.0),
        ([6.0, 6.0, 3.0], [0.80, 0.88, 1.0], 35.0),
    ]);
    scene.material = vec![
        diffuse("light square", [0.82, 0.80, 0.76]),
        diffuse("dark square", [0.16, 0.17, 0.20]),
        glossy("red", [0.80, 0.12, 0.10], 0.4),
        glossy("yellow", [0.90, 0.68, 0.10], 0.4),
        dielectric("glass", 1.5),
        dielectric("water", 1.33),
        dielectric("air", 1.0),
    ];
    add_floor(&mut scene);
    add_tumbler(&mut scene, [-1.35, 0.0, 0.3]);
    add_balls(&mut scene);
    scene
}

/// A sealed tumbler, half full: a glass block with water, above it air, in both a bubble or a ball.
fn add_tumbler(scene: &mut SceneDescription, foot: [f64; 3]) {
    let at = |y: f64| [foot[0], foot[1] + y, foot[2]];
    scene.cylinder.push(cylinder("glass", at(0.01), at(2.4), 1.0));
    scene.cylinder.push(cylinder("water", at(0.2), at(1.4), 0.9));
    scene.cylinder.push(cylinder("air", at(1.4 + FILM), at(2.3), 0.9));
    scene.sphere.push(sphere("air", [foot[0] - 0.3, foot[1] + 0.9, foot[2] + 0.3], 0.16));
    scene.sphere.push(sphere("air", [foot[0] + 0.25, foot[1] + 1.15, foot[2] + 0.4], 0.09));
    scene.sphere.push(sphere("red", [foot[0] + 0.2, foot[1] + 0.52, foot[2] - 0.1], 0.3));
}

fn add_balls(scene: &mut SceneDescription) {
    let bubble_ball = [1.25, 0.95, -0.3];
    scene.sphere.push(sphere("glass", bubble_ball, 0.94));
    scene.sphere.push(sphere("air", bubble_ball, 0.5));
    // A drop of water that floats in the bubble.
    scene.sphere.push(sphere("water", bubble_ball, 0.22));
    scene.sphere.push(sphere("glass", [0.15, 0.42, 1.9], 0.41));
    scene.sphere.push(sphere("yellow", [2.6, 0.4, -2.2], 0.4));
    scene.sphere.push(sphere("red", [0.2, 0.45, -2.4], 0.45));
    // A lens: a sphere flattened along its axis.
    let lens = Transform::default()
        .scale([0.62, 0.62, 0.2])
        .rotate_deg([0.0, 1.0, 0.0], 20.0)
        .translate([1.95, 0.64, 1.7]);
    scene.sphere.push(super::super::Sphere { transform: lens, ..sphere("glass", [0.0; 3], 1.0) });
    scene.cylinder.push(cylinder("glass", [-2.6, 0.16, 2.2], [-0.7, 0.16, 2.7], 0.15));
    scene.cylinder.push(upright("yellow", [-3.1, 0.5, -1.8], 0.35, 0.5));
}

/// Two meshes of squares: the light and the dark ones.
fn add_floor(scene: &mut SceneDescription) {
    for (parity, material) in ["light square", "dark square"].into_iter().enumerate() {
        let mut mesh = squares(parity);
        mesh.material = Some(material.into());
        scene.mesh.push(mesh);
    }
}

fn squares(parity: usize) -> Mesh {
    const SIDE: usize = 24;
    let corner = |i: usize| i as f64 - SIDE as f64 / 2.0;
    let vertices =
        (0..(SIDE + 1) * (SIDE + 1)).map(|v| [corner(v % (SIDE + 1)), 0.0, corner(v / (SIDE + 1))]).collect();
    let square = |i: usize| {
        let low = (i / SIDE) * (SIDE + 1) + i % SIDE;
        [low, low + SIDE + 1, low + SIDE + 2, low + 1].map(|v| v as u32).to_vec()
    };
    let own = |i: &usize| (i % SIDE + i / SIDE) % 2 == parity;
    Mesh::inline(vertices, (0..SIDE * SIDE).filter(own).map(square).collect())
}
