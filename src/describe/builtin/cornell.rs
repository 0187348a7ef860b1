//! `cornell`: the box, with a glass and a metal sphere, two lights under the ceiling.

use super::super::{Background, Camera, Rgb, SceneDescription};
use super::parts::{dielectric, diffuse, metal, point_lights, quad, sphere, triangle};

/// The room reaches from -1 to 1 in x and y, from -1 (back) to 1 (open front) in z.
pub(super) fn scene() -> SceneDescription {
    let mut scene = SceneDescription::new(Camera::perspective([0.0, 0.0, 3.75], [0.0; 3], 39.0));
    scene.render.size = [512, 512];
    scene.background.color = Some(Rgb::BLACK);
    scene.background = Background { ambient: Some(Rgb::grey(0.35)), ..scene.background };
    scene.light = point_lights(&[
        ([-0.35, 0.93, -0.1], [1.0, 0.86, 0.68], 0.75),
        ([0.35, 0.93, 0.25], [1.0, 0.90, 0.76], 0.75),
    ]);
    scene.material = vec![
        diffuse("white", [0.74, 0.73, 0.70]),
        diffuse("red", [0.65, 0.06, 0.05]),
        diffuse("green", [0.12, 0.45, 0.10]),
        metal("chrome", [0.93, 0.94, 0.96]),
        dielectric("glass", 1.5),
    ];
    add_walls(&mut scene);
    scene.sphere =
        vec![sphere("chrome", [-0.42, -0.62, -0.35], 0.38), sphere("glass", [0.43, -0.66, 0.30], 0.34)];
    scene
}

/// All walls face inwards. The back wall is two single triangles, the others are quads.
fn add_walls(scene: &mut SceneDescription) {
    scene.quad = vec![
        quad("white", [-1.0, -1.0, 1.0], [2.0, 0.0, 0.0], [0.0, 0.0, -2.0]),
        quad("white", [-1.0, 1.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0]),
        quad("red", [-1.0, -1.0, 1.0], [0.0, 0.0, -2.0], [0.0, 2.0, 0.0]),
        quad("green", [1.0, -1.0, -1.0], [0.0, 0.0, 2.0], [0.0, 2.0, 0.0]),
    ];
    let [a, b, c, d] = [[-1.0, -1.0, -1.0], [1.0, -1.0, -1.0], [1.0, 1.0, -1.0], [-1.0, 1.0, -1.0]];
    scene.triangle = vec![triangle("white", [a, b, c]), triangle("white", [a, c, d])];
}
