//! Mirrors, random bounces and where paths end.

use super::common::{film, parse};
use super::{camera, close, look};

#[test]
fn a_mirror_shows_the_exact_colour_times_its_tint() {
    let scene = format!(
        "{}
[[material]]
name = 'mirror'
kind = 'metal'
tint = [0.9, 0.5, 0.2]
attenuation = 0.8
ks = 0
[[material]]
name = 'lamp'
ka = 0
kd = 0
emission = [1, 2, 3]
[[plane]]
point = [0, 0, 0]
normal = [1, 0, 0]
material = 'mirror'
[[sphere]]
center = [2, 2, 0]
radius = 0.1
material = 'lamp'
",
        camera([2.0, -2.0, 0.0], [0.0; 3])
    );
    close(look(&scene, 1, 1e-6), [0.72, 0.8, 0.48], 1e-6, "mirrored");
    close(look(&scene, 0, 0.0), [0.0; 3], 0.0, "no bounce allowed");
}

/// The camera behind the mirror sees the highlight that the mirror shows; the report took the real camera's direction.
#[test]
fn a_mirror_shows_what_the_mirrored_camera_sees() {
    let body = "
[render]
size = [40, 30]
spp = 1
filter = { radius = 0 }
[[light.point]]
position = [3, 4, 1]
intensity = 30
[[material]]
name = 'ball'
kd = 0.2
ks = 1
shininess = 40
[[sphere]]
center = [2.5, 0, 0]
radius = 1.2
material = 'ball'
";
    let mirror = "[[material]]\nname = 'mirror'\nkind = 'metal'\nks = 0\n[[plane]]\npoint = [0, 0, 0]\nnormal = [1, 0, 0]\nmaterial = 'mirror'\n";
    let eye = |x: f64, hand: &str| {
        let look_at = if x > 0.0 { -2.5 } else { 2.5 };
        format!(
            "[camera]\nposition = [{x}, 1, 5]\nlook_at = [{look_at}, 0, 0]\nhandedness = '{hand}'\nfov_deg = 30\n"
        )
    };
    let through = film(&parse(&format!("{}{body}{mirror}", eye(3.0, "right"))));
    let direct = film(&parse(&format!("{}{body}", eye(-3.0, "left"))));
    let lit = direct.pixels.iter().filter(|p| p[0] > 0.5).count();
    assert!(lit > 3, "the highlight is in the picture: {lit} pixels");
    let off = through.pixels.iter().zip(&direct.pixels).filter(|(a, b)| (a[0] - b[0]).abs() > 1e-3).count();
    assert!(off <= 6, "{off} pixels differ, more than a few at the edge");
}

/// Between mirrors each bounce adds the glow of one more: a geometric series that stops at the depth limit.
#[test]
fn facing_mirrors_end_at_max_depth() {
    let mirror =
        |z: f64| format!("[[plane]]\npoint = [0, 0, {z}]\nnormal = [0, 0, 1]\nmaterial = 'mirror'\n");
    let material =
        "[[material]]\nname = 'mirror'\nkind = 'metal'\nks = 0\ntint = 0.5\nemission = [1, 2, 3]\n";
    let scene =
        format!("{}{material}{}{}", camera([0.0, 0.0, 1.0], [0.1, 0.3, 0.0]), mirror(0.0), mirror(2.0));
    for max_depth in [0, 1, 2, 5, 20] {
        let sum = 2.0 - 0.5f64.powi(max_depth as i32);
        close(
            look(&scene, max_depth, 1e-5),
            [sum, 2.0 * sum, 3.0 * sum],
            1e-5,
            &format!("depth {max_depth}"),
        );
    }
}

/// In a closed glowing box every bounce sees the same: the sum of powers of the albedo, whatever the directions.
#[test]
fn a_white_furnace_is_the_series_of_its_albedo() {
    let scene = "
[camera]
position = [0.3, 0.1, -0.2]
look_at = [1, 0.3, 0.4]
[[material]]
name = 'wall'
ka = 0
kd = [0.5, 0.8, 0.0]
emission = 1
bounce = true
[[sphere]]
center = [0, 0, 0]
radius = 1
material = 'wall'
[[cylinder]]
from = [-0.2, -0.5, 0]
to = [-0.2, 0.5, 0]
radius = 0.1
material = 'wall'
";
    for n in [0, 1, 4, 12] {
        let sum = |albedo: f64| (0..=n).map(|k| albedo.powi(k)).sum();
        close(look(scene, n as u32, 1e-5), [sum(0.5), sum(0.8), 1.0], 1e-5, &format!("depth {n}"));
    }
}

/// Under a sky that grows from 0 below to 1 above, the mean of `(1 + cos) / 2` over the cosine lobe is 5/6 seen from the
/// ground and 1/2 seen from a wall. Directions that are even over the hemisphere would give 3/4.
#[test]
fn diffuse_bounces_follow_the_cosine() {
    for (normal, expected) in [([0.0, 1.0, 0.0], 5.0 / 6.0), ([0.0, 0.0, 1.0], 0.5), ([0.0, 0.6, 0.8], 0.7)] {
        for sampler in ["random", "sobol"] {
            let text = format!(
                "
[camera]
position = [0, 1, 3]
look_at = [0, 0, 0]
[render]
size = [4, 4]
spp = 1024
max_depth = 1
sampler = '{sampler}'
[background]
bottom = 0
top = 1
[[material]]
name = 'white'
ka = 0
kd = 1
bounce = true
[[plane]]
point = [0, 0, 0]
normal = {normal:?}
material = 'white'
"
            );
            // Only the plane: looked at from close by, it fills the picture.
            let mut scene = parse(&text);
            scene.camera.fov_deg = 10.0;
            let pixels = film(&scene).pixels;
            let mean = pixels.iter().map(|p| f64::from(p[0])).sum::<f64>() / pixels.len() as f64;
            // 16384 samples of a deviation of at most 0.25: six standard errors.
            assert!((mean - expected).abs() < 6.0 * 0.25 / 128.0, "{normal:?} {sampler}: {mean}");
        }
    }
}
