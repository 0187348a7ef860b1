//! Short ways to write the parts of a built-in scene.

use super::super::{
    Cylinder, DirectionalLight, Lights, Material, MaterialKind, PointLight, Quad, Rgb, Sphere, Transform,
    Triangle,
};

pub(super) fn diffuse(name: &str, kd: [f64; 3]) -> Material {
    let ka = kd.map(|k| 0.25 * k);
    Material { ka: Some(Rgb(ka)), kd: Some(Rgb(kd)), ..Material::new(name, MaterialKind::Diffuse) }
}

/// A diffuse material with a highlight.
pub(super) fn glossy(name: &str, kd: [f64; 3], ks: f64) -> Material {
    Material { ks: Some(Rgb::grey(ks)), ..diffuse(name, kd) }
}

pub(super) fn metal(name: &str, tint: [f64; 3]) -> Material {
    Material { tint: Some(Rgb(tint)), attenuation: 0.9, ..Material::new(name, MaterialKind::Metal) }
}

pub(super) fn dielectric(name: &str, ior: f64) -> Material {
    Material { ior, ..Material::new(name, MaterialKind::Dielectric) }
}

pub(super) fn sphere(material: &str, center: [f64; 3], radius: f64) -> Sphere {
    Sphere { center, radius, material: Some(material.into()), transform: Transform::default() }
}

/// A closed cylinder between two points.
pub(super) fn cylinder(material: &str, from: [f64; 3], to: [f64; 3], radius: f64) -> Cylinder {
    let ends = Cylinder { from: Some(from), to: Some(to), ..upright(material, [0.0; 3], radius, 0.0) };
    Cylinder { center: None, half_height: None, ..ends }
}

/// A closed cylinder along y.
pub(super) fn upright(material: &str, center: [f64; 3], radius: f64, half_height: f64) -> Cylinder {
    Cylinder {
        from: None,
        to: None,
        center: Some(center),
        half_height: Some(half_height),
        radius,
        caps: true,
        material: Some(material.into()),
        transform: Transform::default(),
    }
}

pub(super) fn triangle(material: &str, vertices: [[f64; 3]; 3]) -> Triangle {
    Triangle { vertices, material: Some(material.into()), transform: Transform::default() }
}

pub(super) fn quad(material: &str, origin: [f64; 3], edge_u: [f64; 3], edge_v: [f64; 3]) -> Quad {
    Quad { origin, edge_u, edge_v, material: Some(material.into()), transform: Transform::default() }
}

/// Point lights, each by position, colour and intensity.
pub(super) fn point_lights(lights: &[([f64; 3], [f64; 3], f64)]) -> Lights {
    let point = |&(position, color, intensity)| PointLight { position, color: Rgb(color), intensity };
    Lights { point: lights.iter().map(point).collect(), ..Lights::default() }
}

/// Directional lights, each by direction, colour and intensity.
pub(super) fn suns(lights: &[([f64; 3], [f64; 3], f64)]) -> Lights {
    let sun = |&(direction, color, intensity)| DirectionalLight { direction, color: Rgb(color), intensity };
    Lights { directional: lights.iter().map(sun).collect(), ..Lights::default() }
}

/// A number from 0 to below 1 that depends only on its two arguments: the same on every machine.
///
/// **Source**: the output permutation of PCG (O'Neill 2014, RXS-M-XS with 32 bits), applied twice.
pub(super) fn unit_hash(index: u32, dimension: u32) -> f64 {
    f64::from(pcg(index ^ pcg(dimension))) / 4_294_967_296.0
}

fn pcg(input: u32) -> u32 {
    let state = input.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}
