//! A camera's numbers as JSON, for programs that read the pictures.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::scene::{Camera, Projection};

/// The file beside a picture that holds its camera: `a/b.exr` has `a/b.camera.json`.
pub fn camera_path(picture: &Path) -> PathBuf {
    picture.with_extension("camera.json")
}

/// The camera of a picture of this size in the convention of computer vision: x right, y down, z along the view axis.
///
/// **Shape:** matrices are four rows. A point `p` of the world is at `c = world_to_camera p`; a pinhole sees it at pixel
/// `x = fx c.x / c.z + cx`, `y = fy c.y / c.z + cy`, an orthographic camera at `x = fx c.x + cx`, `y = fy c.y + cy`. The
/// centre of the top left pixel is (0.5, 0.5). Depth is `c.z`.
///
/// **Units:** `fx`, `fy`, `cx`, `cy` in pixels (orthographic: pixels a world unit).
pub fn camera_json(camera: &Camera, size: [u32; 2], crop: Option<[u32; 4]>) -> Value {
    let [right, up] = [camera.right, camera.up].map(unit);
    let rows = [right, up.map(|x| -x), camera.forward];
    let [width, height] = size.map(f64::from);
    let [fx, fy] =
        [(width, camera.right), (height, camera.up)].map(|(side, half)| 0.5 * side / dot(half, half).sqrt());
    json!({
        "width": size[0],
        "height": size[1],
        "crop": crop,
        "projection": projection(camera.projection),
        "fx": fx, "fy": fy, "cx": 0.5 * width, "cy": 0.5 * height,
        "near": camera.near,
        "world_to_camera": world_to_camera(rows, camera.position),
        "camera_to_world": camera_to_world(rows, camera.position),
    })
}

fn projection(projection: Projection) -> Value {
    match projection {
        Projection::Pinhole => json!({ "kind": "pinhole" }),
        Projection::Orthographic => json!({ "kind": "orthographic" }),
        Projection::ThinLens { aperture_radius, focus_distance } => {
            json!({ "kind": "thin_lens", "aperture_radius": aperture_radius, "focus_distance": focus_distance })
        }
    }
}

fn world_to_camera(rows: [[f64; 3]; 3], position: [f64; 3]) -> [[f64; 4]; 4] {
    let row = |axis: [f64; 3]| [axis[0], axis[1], axis[2], -dot(axis, position)];
    [row(rows[0]), row(rows[1]), row(rows[2]), [0.0, 0.0, 0.0, 1.0]]
}

fn camera_to_world(rows: [[f64; 3]; 3], position: [f64; 3]) -> [[f64; 4]; 4] {
    let row = |k: usize| [rows[0][k], rows[1][k], rows[2][k], position[k]];
    [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    v.map(|x| x / dot(v, v).sqrt())
}
