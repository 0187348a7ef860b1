//! Dielectrics: Fresnel, Snell, slabs, prisms, bodies inside bodies.

use super::{camera, close, look};

const MATERIALS: &str = "
[[material]]
name = 'glass'
kind = 'dielectric'
ior = 1.5
ks = 0
[[material]]
name = 'water'
kind = 'dielectric'
ior = 1.33
ks = 0
[[material]]
name = 'lamp'
ka = 0
kd = 0
emission = [1, 0.5, 0.25]
";
const LAMP: [f64; 3] = [1.0, 0.5, 0.25];

/// A plane across z whose front looks to `facing`.
fn across(z: f64, facing: f64, material: &str) -> String {
    format!("[[plane]]\npoint = [0, 0, {z}]\nnormal = [0, 0, {facing}]\nmaterial = '{material}'\n")
}

/// Fresnel's share by the laws of sines and tangents.
fn fresnel(incident_rad: f64, from: f64, to: f64) -> f64 {
    if incident_rad == 0.0 {
        return ((from - to) / (from + to)).powi(2);
    }
    let refracted_rad = (incident_rad.sin() * from / to).asin();
    let (minus, plus) = (incident_rad - refracted_rad, incident_rad + refracted_rad);
    0.5 * ((minus.sin() / plus.sin()).powi(2) + (minus.tan() / plus.tan()).powi(2))
}

fn expect(scene: &str, max_depth: u32, share: f64, what: &str) {
    close(look(scene, max_depth, 1e-5), LAMP.map(|c| c * share), 1e-5, what);
}

#[test]
fn reflection_is_fresnels_at_every_angle() {
    for degrees in [0.0, 20.0, 40.0, 56.31, 70.0, 80.0, 89.0f64] {
        let angle = degrees.to_radians();
        let eye = camera([0.3, 2.0 * angle.sin(), 2.0 * angle.cos()], [0.3, 0.0, 0.0]);
        let scene = format!("{eye}{MATERIALS}{}{}", across(0.0, 1.0, "glass"), across(3.0, -1.0, "lamp"));
        expect(&scene, 1, fresnel(angle, 1.0, 1.5), &format!("{degrees} degrees"));
    }
}

/// `(1-R)^2 (1 + R^2 + R^4 + ...)`, one more term for each two bounces.
#[test]
fn a_slab_lets_through_the_series() {
    let r = fresnel(0.0, 1.0, 1.5);
    let slab = format!("{}{}", across(0.0, 1.0, "glass"), across(-1.0, -1.0, "glass"));
    let scene =
        format!("{}{MATERIALS}{slab}{}", camera([0.1, 0.2, 2.0], [0.1, 0.2, 0.0]), across(-2.0, 1.0, "lamp"));
    let terms = |n: i32| (0..n).map(|k| (1.0 - r).powi(2) * r.powi(2 * k)).sum::<f64>();
    for (max_depth, expected) in [
        (0, 0.0),
        (1, 0.0),
        (2, terms(1)),
        (3, terms(1)),
        (4, terms(2)),
        (6, terms(3)),
        (30, (1.0 - r) / (1.0 + r)),
    ] {
        expect(&scene, max_depth, expected, &format!("depth {max_depth}"));
    }
}

#[test]
fn nothing_is_lost_in_glass() {
    let sky = "[background]\ncolor = [1, 0.5, 0.25]\n";
    let ball = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'glass'\n[[sphere]]\ncenter = [0.2, 0, 0]\nradius = 0.5\nmaterial = 'water'\n";
    for look_at in [[0.0, 0.0, 0.0], [0.5, 0.2, 0.0], [0.7, 0.6, 0.0], [0.0, 0.95, 0.0]] {
        let scene = format!("{}{sky}{MATERIALS}{ball}", camera([0.0, 0.0, 4.0], look_at));
        close(look(&scene, 14, 1e-4), LAMP, 1e-3, &format!("towards {look_at:?}"));
    }
}

/// A target stands where Snell's law puts it; one that stands in the straight line is not seen.
#[test]
fn a_slab_displaces_and_does_not_bend() {
    for degrees in [15.0, 30.0, 50.0, 70.0f64] {
        let angle = degrees.to_radians();
        let refracted = (angle.sin() / 1.5).asin();
        let (thickness, behind) = (1.0, 3.0);
        let seen = thickness * refracted.tan() + behind * angle.tan();
        let straight = (thickness + behind) * angle.tan();
        let eye = camera([-2.0 * angle.tan(), 0.0, 2.0], [0.0; 3]);
        let slab = format!("{}{}", across(0.0, 1.0, "glass"), across(-thickness, -1.0, "glass"));
        let target = |x: f64| {
            let z = -thickness - behind;
            format!("[[sphere]]\ncenter = [{x}, 0, {z}]\nradius = 0.02\nmaterial = 'lamp'\n")
        };
        let share = (1.0 - fresnel(angle, 1.0, 1.5)).powi(2);
        expect(&format!("{eye}{MATERIALS}{slab}{}", target(seen)), 2, share, &format!("{degrees} degrees"));
        expect(&format!("{eye}{MATERIALS}{slab}{}", target(straight)), 2, 0.0, "the straight line");
    }
}

/// In at a right angle, mirrored at 45 degrees, which is beyond the critical 41.8, out at a right angle.
#[test]
fn a_prism_reflects_everything() {
    let prism = "
[[mesh]]
vertices = [[0, 0, -3], [2, 0, -3], [0, 2, -3], [0, 0, 3], [2, 0, 3], [0, 2, 3]]
faces = [[0, 2, 1], [3, 4, 5], [0, 1, 4, 3], [0, 3, 5, 2], [1, 2, 5, 4]]
material = 'glass'
";
    let lamp = "[[plane]]\npoint = [0, -1, 0]\nnormal = [0, 1, 0]\nmaterial = 'lamp'\n";
    let scene = format!("{}{MATERIALS}{prism}{lamp}", camera([-3.0, 0.7, 0.1], [0.0, 0.7, 0.1]));
    let r = fresnel(0.0, 1.0, 1.5);
    expect(&scene, 3, (1.0 - r).powi(2), "through the prism");
    expect(&scene, 2, 0.0, "not out of it yet");
}

#[test]
fn water_in_glass_counts_each_boundary_once() {
    let layers = [(0.0, 1.0, "glass"), (-1.0, 1.0, "water"), (-2.0, -1.0, "water"), (-3.0, -1.0, "glass")];
    let layers: String = layers.iter().map(|&(z, facing, material)| across(z, facing, material)).collect();
    for degrees in [0.0, 35.0f64] {
        let angle = degrees.to_radians();
        let in_glass = (angle.sin() / 1.5).asin();
        let eye = camera([2.0 * angle.tan(), 0.0, 2.0], [0.0; 3]);
        let scene = format!("{eye}{MATERIALS}{layers}{}", across(-4.0, 1.0, "lamp"));
        let outer = 1.0 - fresnel(angle, 1.0, 1.5);
        let inner = 1.0 - fresnel(in_glass, 1.5, 1.33);
        expect(&scene, 4, outer * outer * inner * inner, &format!("{degrees} degrees"));
    }
}

/// The eye is in glass that no ray was seen to enter; what the glass reflects is still in glass when it meets water.
#[test]
fn what_glass_reflects_inwards_stays_in_it() {
    let (glass, water) = (across(0.0, -1.0, "glass"), across(3.0, -1.0, "water"));
    let eye = camera([0.1, 0.2, 1.0], [0.1, 0.2, 0.0]);
    let scene = format!("{eye}{MATERIALS}{glass}{water}{}", across(5.0, -1.0, "lamp"));
    expect(&scene, 2, fresnel(0.0, 1.5, 1.0) * (1.0 - fresnel(0.0, 1.5, 1.33)), "by way of the water");
}
