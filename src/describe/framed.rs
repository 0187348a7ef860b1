//! A scene around a bare mesh file.

use super::{
    Background, Camera, Lights, Material, MaterialKind, Mesh, PointLight, Quad, Rgb, SceneDescription,
};
use std::path::Path;

/// The scene for a mesh without one: three-quarter view with all of it in the picture, two lights and a floor.
///
/// **Needs**: `bounds` is the lowest and highest corner of the mesh, as loaded; y is up.
/// Materials are those of the file, and plain grey where it has none.
#[must_use]
pub fn framed_mesh(path: &Path, bounds: [[f64; 3]; 2]) -> SceneDescription {
    let [low, high] = bounds;
    let middle: [f64; 3] = std::array::from_fn(|i| 0.5 * (low[i] + high[i]));
    let half_diagonal = 0.5 * (0..3).map(|i| (high[i] - low[i]).powi(2)).sum::<f64>().sqrt();
    // A mesh of one point still needs a camera that stands somewhere else.
    let radius = half_diagonal.max(middle.iter().fold(1e-6, |m: f64, x| m.max(1e-6 * x.abs())));
    let around = |direction: [f64; 3], distance: f64| -> [f64; 3] {
        let length = direction.iter().map(|d| d * d).sum::<f64>().sqrt();
        std::array::from_fn(|i| middle[i] + direction[i] / length * distance)
    };
    let mut scene = SceneDescription::new(Camera::perspective(around(VIEW, 2.8 * radius), middle, FOV_DEG));
    scene.background = Background::gradient([0.32, 0.36, 0.42], [0.55, 0.66, 0.82]);
    scene.material.push(floor_material());
    scene.quad.push(floor(middle, low[1] - 1e-3 * radius, 40.0 * radius));
    scene.light = Lights {
        point: vec![
            light(around([-0.9, 1.5, 1.2], 5.0 * radius), [1.0, 0.97, 0.92], 30.0 * radius * radius),
            light(around([1.4, 0.8, 0.6], 6.0 * radius), [0.75, 0.85, 1.0], 12.0 * radius * radius),
        ],
        ..Lights::default()
    };
    scene.mesh.push(Mesh::from_path(path));
    scene
}

/// From the middle towards the camera: from the right, a little above.
const VIEW: [f64; 3] = [0.62, 0.42, 1.0];
/// A sphere around the mesh fits: `asin(1 / 2.8) = 20.9` degrees of the half angle 21.
const FOV_DEG: f64 = 42.0;

fn light(position: [f64; 3], color: [f64; 3], intensity: f64) -> PointLight {
    PointLight { position, color: Rgb(color), intensity }
}

fn floor_material() -> Material {
    Material {
        kd: Some(Rgb([0.62, 0.60, 0.57])),
        ..Material::new("floor of the frame", MaterialKind::Diffuse)
    }
}

fn floor(middle: [f64; 3], y: f64, side: f64) -> Quad {
    Quad {
        origin: [middle[0] - 0.5 * side, y, middle[2] - 0.5 * side],
        edge_u: [0.0, 0.0, side],
        edge_v: [side, 0.0, 0.0],
        material: Some("floor of the frame".into()),
        transform: Default::default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_of_any_size_pass_the_check() {
        for size in [1e-9, 1.0, 1e6] {
            let scene = framed_mesh(Path::new("a.obj"), [[0.0; 3], [size, 2.0 * size, size]]);
            scene.check().unwrap();
        }
        framed_mesh(Path::new("a.obj"), [[5.0; 3], [5.0; 3]]).check().unwrap();
    }
}
