//! `terrain:N`: hills of about N triangles under an evening sun.

use super::super::{Background, Camera, DescribeError, Mesh, Procedural, ProceduralKind, SceneDescription};
use super::parts::{diffuse, suns};

const DEFAULT_TRIANGLES: u64 = 1_000_000;
const MOST_TRIANGLES: u64 = 200_000_000;

/// The scene; `argument` is empty or a colon and the number of triangles.
pub(super) fn scene(argument: &str) -> Result<SceneDescription, DescribeError> {
    let triangles = match argument.strip_prefix(':') {
        None => DEFAULT_TRIANGLES,
        Some(number) => count(number).ok_or_else(|| DescribeError::Builtin {
            name: format!("terrain:{number}"),
            message: format!("needs a number of triangles from 2 to {MOST_TRIANGLES}, as in terrain:1000000"),
        })?,
    };
    Ok(with_triangles(triangles))
}

fn count(number: &str) -> Option<u64> {
    let digits = number.replace('_', "");
    digits.parse().ok().filter(|n| (2..=MOST_TRIANGLES).contains(n))
}

fn with_triangles(triangles: u64) -> SceneDescription {
    let mut scene = SceneDescription::new(Camera::perspective([0.25, 0.62, 1.35], [0.0, 0.12, 0.0], 44.0));
    scene.background = Background::gradient([0.86, 0.76, 0.66], [0.24, 0.42, 0.74]);
    scene.light =
        suns(&[([-0.8, -0.55, -0.35], [1.0, 0.86, 0.66], 1.1), ([0.5, -0.9, 0.2], [0.60, 0.74, 1.0], 0.18)]);
    scene.material = vec![diffuse("rock", [0.56, 0.50, 0.42])];
    let terrain = Mesh::procedural(Procedural { kind: ProceduralKind::Terrain, triangles, seed: 0 });
    scene.mesh.push(Mesh { material: Some("rock".into()), ..terrain });
    scene
}
