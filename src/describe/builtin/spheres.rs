//! `spheres`: 10,000 spheres in a sunflower spiral, every tenth of them on a column.

use super::super::{Background, Camera, Material, Plane, SceneDescription};
use super::parts::{dielectric, diffuse, glossy, metal, sphere, suns, unit_hash, upright};
use crate::describe::transform::sin_cos_deg;

const COUNT: u32 = 10_000;
/// Each sphere stands a column's height up when its number divides by this.
const EVERY: u32 = 10;
/// Radius of the spiral at number 1; the disc has radius `SPACING x sqrt(COUNT)` = 50.
const SPACING: f64 = 0.5;
/// 180 (3 - sqrt 5): no two spheres of the spiral ever line up.
const GOLDEN_ANGLE_DEG: f64 = 137.507_764_050_037_85;

pub(super) fn scene() -> SceneDescription {
    let mut scene = SceneDescription::new(Camera::perspective([0.0, 11.5, 33.0], [0.0, 3.0, 6.0], 42.0));
    scene.background = Background::gradient([0.78, 0.74, 0.70], [0.22, 0.38, 0.66]);
    scene.light = suns(&[
        ([0.62, -0.66, -0.42], [1.0, 0.93, 0.82], 0.95),
        ([-0.70, -0.55, 0.15], [0.70, 0.82, 1.0], 0.28),
    ]);
    scene.material = materials();
    let normal = [0.0, 1.0, 0.0];
    scene.plane.push(Plane { point: [0.0; 3], normal, material: Some("ground".into()) });
    (0..COUNT).for_each(|number| add_sphere(&mut scene, number));
    scene
}

fn add_sphere(scene: &mut SceneDescription, number: u32) {
    let distance = SPACING * (f64::from(number) + 0.5).sqrt();
    let (sin, cos) = sin_cos_deg(f64::from(number) * GOLDEN_ANGLE_DEG);
    let (x, z) = (distance * cos, distance * sin);
    // Neighbours in the spiral are at least 1.6 SPACING apart, so spheres of 0.8 SPACING never touch.
    let radius = SPACING * (0.45 + 0.35 * unit_hash(number, 0));
    let mut base = 0.0;
    if number.is_multiple_of(EVERY) {
        // Columns grow towards the middle like a hill.
        base = (1.0 + 6.0 / (1.0 + (distance / 14.0).powi(2))) * (0.4 + 0.6 * unit_hash(number, 1));
        let column = upright("column", [x, 0.5 * base, z], 0.55 * radius, 0.5 * base);
        scene.cylinder.push(column);
    }
    scene.sphere.push(sphere(material_of(number, distance), [x, base + radius, z], radius));
}

/// Rings of colour, with metal and glass strewn in.
fn material_of(number: u32, distance: f64) -> &'static str {
    const RINGS: [&str; 6] = ["coral", "amber", "cream", "teal", "sky", "plum"];
    let chance = unit_hash(number, 2);
    if chance < 0.05 {
        "glass"
    } else if chance < 0.12 {
        "gold"
    } else if chance < 0.20 {
        "steel"
    } else {
        let ring = (distance / 4.0 + 0.9 * unit_hash(number, 3)) as usize;
        RINGS[ring % RINGS.len()]
    }
}

fn materials() -> Vec<Material> {
    vec![
        diffuse("ground", [0.46, 0.43, 0.41]),
        diffuse("column", [0.72, 0.69, 0.64]),
        glossy("coral", [0.86, 0.28, 0.20], 0.35),
        glossy("amber", [0.92, 0.58, 0.14], 0.35),
        glossy("cream", [0.90, 0.84, 0.70], 0.35),
        glossy("teal", [0.10, 0.52, 0.50], 0.35),
        glossy("sky", [0.22, 0.48, 0.82], 0.35),
        glossy("plum", [0.46, 0.18, 0.48], 0.35),
        metal("gold", [0.98, 0.78, 0.36]),
        metal("steel", [0.90, 0.92, 0.95]),
        dielectric("glass", 1.5),
    ]
}
