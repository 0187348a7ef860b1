//! octray against the naive tracer in `naive/`: pixel for pixel, in all but a tiny share of pixels.
//!
//! The share is for edges (of things, of shadows, of total reflection): there `f32` columns and `f64` may lie on different
//! sides, and behind glass a ray that is off by one rounding may see something else.

mod common;
mod naive;

use common::{at_centres, builtin, film, in_tier};
use octray::describe::{
    Background, Camera, CameraKind, Cylinder, DirectionalLight, Material, MaterialKind, Mesh, Plane,
    PointLight, Quad, Rgb, SceneDescription, Sphere, SpotLight, Tier, Transform, Triangle,
};

/// Most that a channel may be off, of a radiance of about 1.
const TOLERANCE: f64 = 1e-3;

/// The share of pixels that are off by more.
fn share_off(scene: &SceneDescription, naive: &[[f64; 3]]) -> f64 {
    let film = film(scene);
    let differs = |(a, b): (&[f32; 3], &[f64; 3])| {
        (0..3).any(|c| (f64::from(a[c]) - b[c]).abs() > TOLERANCE * b[c].abs().max(1.0))
    };
    let off = film.pixels.iter().zip(naive).filter(|&pair| differs(pair)).count();
    off as f64 / naive.len() as f64
}

fn check(name: &str, scene: SceneDescription, most: f64) {
    let scene = at_centres(scene);
    let expected = naive::render(&scene);
    for tier in [Tier::Watertight, Tier::Exact] {
        let share = share_off(&in_tier(scene.clone(), tier), &expected);
        println!("{name}, {tier:?}: {:.3} % of pixels differ", 100.0 * share);
        assert!(share <= most, "{name}, {tier:?}: {share} of pixels differ, at most {most} may");
    }
}

#[test]
fn seed() {
    check("seed", builtin("seed", [160, 120], 1), 0.001);
}

#[test]
fn cornell() {
    // The edges between its walls lie on the diagonals of the picture, which run through pixel centres.
    check("cornell", builtin("cornell", [120, 120], 1), 0.003);
}

#[test]
fn glass() {
    let mut scene = builtin("glass", [48, 36], 1);
    scene.render.max_depth = 5;
    check("glass", scene, 0.005);
}

#[test]
fn the_comparison_sees_a_light_that_is_moved_a_little() {
    let mut scene = at_centres(builtin("seed", [40, 30], 1));
    let expected = naive::render(&scene);
    scene.light.point[0].position[0] += 0.05;
    let share = share_off(&scene, &expected);
    assert!(share > 0.2, "{share}");
}

#[test]
fn random_scenes() {
    for seed in 0..12 {
        check(&format!("random scene {seed}"), random_scene(seed), 0.003);
    }
}

/// A plain linear congruential generator (Knuth's MMIX), the upper bits of it.
struct Dice(u64);

impl Dice {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / f64::from(1u32 << 31)
    }
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
    fn vector(&mut self, half: f64) -> [f64; 3] {
        std::array::from_fn(|_| self.between(-half, half))
    }
    fn color(&mut self) -> Rgb {
        Rgb(std::array::from_fn(|_| self.between(0.1, 0.9)))
    }
    fn material(&mut self) -> Option<String> {
        let pick = (self.unit() * 6.0) as usize;
        ["red", "shiny", "metal", "glass", "water"].get(pick).map(|&name| name.to_owned())
    }
    fn transform(&mut self) -> Transform {
        if self.unit() < 0.5 {
            return Transform::default();
        }
        let factors = std::array::from_fn(|_| self.between(0.5, 1.5));
        let (axis, angle) = (self.vector(1.0), self.between(0.0, 360.0));
        Transform::default().scale(factors).rotate_deg(axis, angle).translate(self.vector(0.5))
    }
}

fn random_scene(seed: u64) -> SceneDescription {
    let dice = &mut Dice(seed * 7919 + 1);
    let mut position = dice.vector(2.0);
    position[2] = 7.0;
    let mut camera = Camera::perspective(position, dice.vector(0.5), 45.0);
    if seed % 3 == 2 {
        camera = Camera { kind: CameraKind::Orthographic, height: Some(6.0), ..camera };
    }
    camera.up = [dice.between(-0.3, 0.3), 1.0, 0.2];
    let mut scene = SceneDescription::new(camera);
    scene.render.size = [64, 48];
    scene.render.max_depth = 4;
    scene.background = Background::gradient(dice.color().0, dice.color().0);
    scene.material = materials(dice);
    add_lights(&mut scene, dice);
    add_shapes(&mut scene, dice);
    scene
}

fn materials(dice: &mut Dice) -> Vec<Material> {
    let named = |name: &str, kind| Material::new(name, kind);
    let ks = Some(Rgb::grey(0.4));
    vec![
        Material { kd: Some(dice.color()), ka: Some(dice.color()), ..named("red", MaterialKind::Diffuse) },
        Material { ks, shininess: dice.between(5.0, 60.0), ..named("shiny", MaterialKind::Diffuse) },
        Material { tint: Some(dice.color()), attenuation: 0.8, ..named("metal", MaterialKind::Metal) },
        Material { kd: Some(Rgb::grey(0.05)), ..named("glass", MaterialKind::Dielectric) },
        Material { ior: 1.33, tint: Some(dice.color()), ..named("water", MaterialKind::Dielectric) },
    ]
}

fn add_lights(scene: &mut SceneDescription, dice: &mut Dice) {
    let mut above = |height: f64| {
        let [x, _, z] = dice.vector(4.0);
        [x, height, z]
    };
    let (a, b) = (above(5.0), above(6.0));
    scene.light.point.push(PointLight { position: a, color: dice.color(), intensity: 25.0 });
    let look_at = dice.vector(1.0);
    let (color, intensity) = (dice.color(), 40.0);
    scene.light.spot.push(SpotLight {
        position: b,
        look_at,
        cone_deg: 25.0,
        penumbra_deg: 10.0,
        color,
        intensity,
    });
    let direction = [dice.between(-1.0, 1.0), -1.0, -0.5];
    scene.light.directional.push(DirectionalLight { direction, color: dice.color(), intensity: 0.4 });
}

fn add_shapes(scene: &mut SceneDescription, dice: &mut Dice) {
    let normal = [0.1, 1.0, 0.1];
    scene.plane.push(Plane { point: [0.0, -2.5, 0.0], normal, material: Some("red".into()) });
    for _ in 0..6 {
        let (center, radius) = (dice.vector(2.0), dice.between(0.3, 0.8));
        scene.sphere.push(Sphere { center, radius, material: dice.material(), transform: dice.transform() });
        let (material, transform) = (dice.material(), dice.transform());
        let (from, to) = (Some(dice.vector(2.0)), Some(dice.vector(2.0)));
        let (radius, caps) = (dice.between(0.1, 0.3), dice.unit() < 0.7);
        let (center, half_height) = (None, None);
        scene.cylinder.push(Cylinder { from, to, center, half_height, radius, caps, material, transform });
        let vertices = std::array::from_fn(|_| dice.vector(2.0));
        scene.triangle.push(Triangle { vertices, material: dice.material(), transform: dice.transform() });
    }
    let (origin, edge_u, edge_v) = (dice.vector(2.0), dice.vector(1.5), dice.vector(1.5));
    scene.quad.push(Quad {
        origin,
        edge_u,
        edge_v,
        material: Some("metal".into()),
        transform: dice.transform(),
    });
    let tetrahedron = vec![[0.0, 1.0, 0.0], [0.9, -0.5, 0.3], [-0.6, -0.5, 0.7], [-0.2, -0.5, -0.9]];
    let faces = vec![vec![0, 2, 1], vec![0, 3, 2], vec![0, 1, 3], vec![1, 2, 3]];
    let mesh = Mesh { material: Some("glass".into()), ..Mesh::inline(tetrahedron, faces) };
    scene.mesh.push(Mesh { transform: dice.transform(), ..mesh });
}
