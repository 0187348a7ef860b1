//! What several benches are made of.

use octray::geometry::{Geometry, Group, NO_MATERIAL};
use octray::load::terrain;

/// The columns of a displaced mesh of about so many triangles.
pub(crate) fn terrain_columns(triangles: u64) -> Geometry {
    let mesh = terrain(triangles, 0, false);
    let mut g = Geometry::default();
    g.triangles.position = std::array::from_fn(|k| mesh.positions.iter().map(|p| p[k]).collect());
    g.triangles.vertex = std::array::from_fn(|k| mesh.triangles.iter().map(|t| t[k]).collect());
    g.triangles.material = vec![NO_MATERIAL; mesh.triangles.len()];
    g.groups = vec![Group { triangles: 0..mesh.triangles.len(), ..Group::default() }];
    g
}
