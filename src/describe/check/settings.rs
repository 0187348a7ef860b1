//! Rules for camera, render settings, background, materials and lights.

use super::super::{
    Background, Camera, CameraKind, Filter, FilterKind, Lights, Material, MaterialKind, Render, Rgb,
    SceneDescription, SpotLight,
};
use super::faults::{Faults, largest};
use super::objects::transform;

/// More pixels than this are a slip of the finger.
const MOST_PIXELS: u64 = 1 << 28;

/// Bounces up to which a thread's stack suffices: each takes some kilobytes of it.
const MOST_BOUNCES: u32 = 256;

pub(super) fn check(f: &mut Faults, scene: &SceneDescription) {
    f.at("camera", |f| camera(f, &scene.camera));
    f.at("render", |f| render(f, &scene.render));
    f.at("background", |f| background(f, &scene.background));
    f.each("material", &scene.material, material);
    f.at("light", |f| lights(f, &scene.light));
}

fn camera(f: &mut Faults, c: &Camera) {
    let placed = f.point("position", &c.position) & f.point("look_at", &c.look_at);
    f.direction("up", &c.up);
    if placed {
        view_axis(f, c);
    }
    window(f, c);
    f.not_negative("aperture_radius", &[c.aperture_radius]);
    f.not_negative("near", &[c.near]);
    if let Some(distance) = c.focus_distance {
        f.length("focus_distance", distance);
    }
    transform(f, &c.transform);
}

/// The view axis has a direction, and `up` another one.
fn view_axis(f: &mut Faults, c: &Camera) {
    let axis: [f64; 3] = std::array::from_fn(|i| c.look_at[i] - c.position[i]);
    let (a, u) = (largest(&axis), largest(&c.up));
    if a == 0.0 {
        return f.add_at("look_at", "is the same point as `position`: the camera looks nowhere");
    }
    let (axis, up) = (axis.map(|x| x / a), c.up.map(|x| x / u));
    let across: [f64; 3] = std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        axis[j] * up[k] - axis[k] * up[j]
    });
    // Single precision cannot tell directions this close apart.
    if largest(&across) < 1e-6 {
        f.add_at("up", "points along the view: the top of the picture is not defined");
    }
}

fn window(f: &mut Faults, c: &Camera) {
    // A hair inside 0 and 180, where the tangent of half the angle still fits.
    let fov_fits = c.fov_deg >= 1e-4 && c.fov_deg <= 180.0 - 1e-4;
    f.require("fov_deg", fov_fits, &format!("must be above 0 and below 180 degrees, is {}", c.fov_deg));
    match (c.kind, c.height) {
        (CameraKind::Orthographic, None) => f.add("an orthographic camera needs `height`"),
        (CameraKind::Perspective, Some(_)) => f.add_at("height", "is for orthographic cameras only"),
        (CameraKind::Orthographic, Some(height)) => f.length("height", height),
        (CameraKind::Perspective, None) => {}
    }
}

fn render(f: &mut Faults, r: &Render) {
    let twice = r.aovs.iter().enumerate().find(|(i, aov)| r.aovs[..*i].contains(aov));
    if let Some((_, aov)) = twice {
        f.add_at("aovs", format!("has `{}` twice", aov.name()));
    }
    let pixels = r.size.iter().map(|&s| u64::from(s)).product::<u64>();
    let [width, height] = r.size;
    f.require("size", pixels > 0, &format!("a picture of {width} x {height} pixels has no pixel"));
    f.require("size", pixels <= MOST_PIXELS, &format!("{width} x {height} is more than 2^28 pixels"));
    f.require("spp", r.spp > 0, "must be at least 1 sample a pixel");
    let bounces = format!("{} bounces are more than {MOST_BOUNCES}", r.max_depth);
    f.require("max_depth", r.max_depth <= MOST_BOUNCES, &bounces);
    f.between("exposure", r.exposure, -64.0, 64.0);
    f.between("min_throughput", r.min_throughput, 0.0, 1.0);
    f.at("filter", |f| filter(f, &r.filter));
}

fn filter(f: &mut Faults, filter: &Filter) {
    if let Some(radius) = filter.radius {
        f.between("radius", radius, 0.0, 16.0);
    }
    if filter.kind == FilterKind::Gaussian {
        f.between("sigma", filter.sigma, 1e-3, 16.0);
    }
    if filter.kind == FilterKind::Mitchell {
        f.between("b", filter.b, 0.0, 1.0);
        f.between("c", filter.c, 0.0, 1.0);
    }
}

fn background(f: &mut Faults, b: &Background) {
    for (key, color) in [("color", b.color), ("bottom", b.bottom), ("top", b.top), ("ambient", b.ambient)] {
        coefficient(f, key, color);
    }
    match (b.color, b.bottom, b.top) {
        (Some(_), None, None) | (None, Some(_), Some(_)) | (None, None, None) => {}
        (Some(_), ..) => f.add_at("color", "excludes `bottom` and `top`"),
        _ => f.add("a gradient needs both `bottom` and `top`"),
    }
}

fn coefficient(f: &mut Faults, key: &'static str, written: Option<Rgb>) {
    if let Some(color) = written {
        f.not_negative(key, &color.0);
    }
}

fn material(f: &mut Faults, m: &Material) {
    for (key, color) in [("ka", m.ka), ("kd", m.kd), ("ks", m.ks), ("tint", m.tint), ("emission", m.emission)]
    {
        coefficient(f, key, color);
    }
    f.between("shininess", m.shininess, 0.0, 65536.0);
    f.not_negative("attenuation", &[m.attenuation]);
    let ior_fits = m.ior > 0.0 && m.ior <= 1e3;
    f.require("ior", ior_fits, &format!("must be above 0 and at most 1000, is {}", m.ior));
    let scatters = !m.bounce || m.kind == MaterialKind::Diffuse;
    f.require("bounce", scatters, "is for diffuse materials only");
}

fn lights(f: &mut Faults, lights: &Lights) {
    f.each("point", &lights.point, |f, light| {
        f.point("position", &light.position);
        strength(f, light.color, light.intensity);
    });
    f.each("directional", &lights.directional, |f, light| {
        f.direction("direction", &light.direction);
        strength(f, light.color, light.intensity);
    });
    f.each("spot", &lights.spot, spot);
}

fn spot(f: &mut Faults, light: &SpotLight) {
    let placed = f.point("position", &light.position) & f.point("look_at", &light.look_at);
    let aims = !placed || light.look_at != light.position;
    f.require("look_at", aims, "is the same point as `position`: the light aims nowhere");
    f.between("cone_deg", light.cone_deg, 1e-3, 180.0);
    f.between("penumbra_deg", light.penumbra_deg, 0.0, light.cone_deg.clamp(0.0, 180.0));
    strength(f, light.color, light.intensity);
}

fn strength(f: &mut Faults, color: Rgb, intensity: f64) {
    f.not_negative("color", &color.0);
    f.not_negative("intensity", &[intensity]);
}
