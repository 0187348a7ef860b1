//! Direct light: falloff, cones, shadows, ambient.

use super::common::{film, parse};
use super::{camera, close, look};

const FLOOR: &str = "
[[material]]
name = 'white'
ka = 0
kd = 1
[[plane]]
point = [0, 0, 0]
normal = [0, 1, 0]
material = 'white'
";

fn floor_at(point: [f64; 3], light: &str) -> f64 {
    let scene = format!("{}{FLOOR}{light}", camera([0.3, 2.5, 4.0], point));
    look(&scene, 0, 1e-5)[0]
}

fn near(a: f64, b: f64, what: &str) {
    close([a; 3], [b; 3], 1e-5 * b.abs().max(1.0), what);
}

#[test]
fn light_falls_with_the_square_of_the_distance() {
    for (x, height) in [(0.0, 1.0), (0.0, 2.0), (0.0, 4.0), (3.0, 2.0), (-6.0, 0.5)] {
        let light = format!("[[light.point]]\nposition = [0, {height}, 0]\nintensity = 10\n");
        let distance: f64 = f64::hypot(x, height);
        near(floor_at([x, 0.0, 0.0], &light), 10.0 * height / distance.powi(3), "irradiance x cosine");
    }
}

#[test]
fn a_directional_light_is_the_same_everywhere() {
    for x in [0.0, 5.0, -50.0] {
        let light = "[[light.directional]]\ndirection = [3, -4, 0]\nintensity = 2\n";
        near(floor_at([x, 0.0, 0.0], light), 2.0 * 0.8, "cosine 0.8");
    }
}

#[test]
fn a_spot_light_ends_at_its_cone() {
    let (cone, inner): (f64, f64) = (30.0, 20.0);
    let light = "[[light.spot]]\nposition = [0, 3, 0]\nlook_at = [0, 0, 0]\ncone_deg = 30\npenumbra_deg = 10\nintensity = 9\n";
    for angle_deg in [0.0, 10.0, 19.9, 22.0, 25.0, 29.0, 30.1, 50.0f64] {
        let cos = angle_deg.to_radians().cos();
        let (outer_cos, inner_cos) = (cone.to_radians().cos(), inner.to_radians().cos());
        let t = ((cos - outer_cos) / (inner_cos - outer_cos)).clamp(0.0, 1.0);
        let distance = 3.0 / cos;
        let expected = 9.0 * cos / (distance * distance) * t * t * (3.0 - 2.0 * t);
        let x = 3.0 * angle_deg.to_radians().tan();
        near(floor_at([x, 0.0, 0.0], light), expected, &format!("{angle_deg} degrees"));
    }
}

#[test]
fn lights_add_up() {
    let light = |x: f64| format!("[[light.point]]\nposition = [{x}, 2, 0]\nintensity = 5\n");
    let one = |x: f64| floor_at([0.5, 0.0, 0.0], &light(x));
    let both = floor_at([0.5, 0.0, 0.0], &format!("{}{}", light(0.0), light(3.0)));
    near(both, one(0.0) + one(3.0), "sum");
}

#[test]
fn a_shadow_ray_stops_at_the_light() {
    let ball = |y: f64| format!("[[sphere]]\ncenter = [0, {y}, 0]\nradius = 0.2\n");
    let point = "[[light.point]]\nposition = [0, 2, 0]\nintensity = 4\n";
    near(floor_at([0.0; 3], &format!("{point}{}", ball(3.0))), 1.0, "a ball behind the light");
    near(floor_at([0.0; 3], &format!("{point}{}", ball(2.3))), 1.0, "a ball just behind the light");
    near(floor_at([0.0; 3], &format!("{point}{}", ball(1.0))), 0.0, "a ball before the light");
    let sun = "[[light.directional]]\ndirection = [0, -1, 0]\nintensity = 1\n";
    near(floor_at([0.0; 3], &format!("{sun}{}", ball(1e6))), 0.0, "a ball far up below the sun");
}

#[test]
fn without_shadows_all_that_faces_a_light_is_lit() {
    let ball = "[[sphere]]\ncenter = [0, 1, 0]\nradius = 0.2\n";
    let sun = "[[light.directional]]\ndirection = [0, -1, 0]\nintensity = 1\n";
    let eye = camera([0.3, 2.5, 4.0], [0.0; 3]);
    let mut scene = parse(&format!("[render]\nsize = [1, 1]\nspp = 1\n{eye}{FLOOR}{ball}{sun}"));
    scene.render.filter.radius = Some(0.0);
    let mut seen = |shadows: bool| {
        scene.render.shadows = shadows;
        film(&scene).pixels[0].map(f64::from)[0]
    };
    near(seen(true), 0.0, "below the ball");
    near(seen(false), 1.0, "below the ball, without shadows");
    let below = "[[light.directional]]\ndirection = [0, 1, 0]\nintensity = 1\n";
    let mut scene = parse(&format!("[render]\nsize = [1, 1]\nspp = 1\n{eye}{FLOOR}{below}"));
    scene.render.shadows = false;
    near(film(&scene).pixels[0].map(f64::from)[0], 0.0, "the back of a surface");
}

#[test]
fn ambient_light_is_the_same_all_over_a_closed_box() {
    let text = "
[camera]
position = [0.2, -0.1, 0.3]
look_at = [1, 0.4, 0.5]
fov_deg = 110
[render]
size = [32, 24]
[background]
color = [0, 0, 0]
ambient = [0.8, 0.4, 0.2]
[[material]]
name = 'wall'
ka = 0.5
kd = 1
[[mesh]]
vertices = [[-1,-1,-1],[1,-1,-1],[1,1,-1],[-1,1,-1],[-1,-1,1],[1,-1,1],[1,1,1],[-1,1,1]]
faces = [[0,1,2,3],[4,5,6,7],[0,1,5,4],[2,3,7,6],[0,3,7,4],[1,2,6,5]]
material = 'wall'
";
    for pixel in film(&parse(text)).pixels {
        close(pixel.map(f64::from), [0.4, 0.2, 0.1], 1e-6, "no ray escapes through an edge");
    }
}

#[test]
fn the_gradient_runs_along_the_cameras_up() {
    let sky = |up: [f64; 3]| {
        format!(
            "[camera]\nposition = [0, 0, 0]\nlook_at = [0, 0, 1]\nup = {up:?}\n[background]\nbottom = 0\ntop = 1\n"
        )
    };
    let height = |up: [f64; 3]| up[2] / up.iter().map(|x| x * x).sum::<f64>().sqrt();
    for up in [[0.0, 1.0, 0.0], [0.0, 3.0, 4.0], [1.0, 0.0, -1.0], [2.0, 0.0, 0.0]] {
        let expected = 0.5 + 0.5 * height(up);
        close(look(&sky(up), 0, 1e-6), [expected; 3], 1e-6, &format!("up {up:?}"));
    }
}
