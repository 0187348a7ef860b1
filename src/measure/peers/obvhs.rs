//! The crate `obvhs`: a compressed 8-wide tree, with its own triangle test.

use std::time::Duration;

use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::cwbvh::{CwBvh, builder::build_cwbvh_from_tris};
use obvhs::ray::{Ray, RayHit};
use obvhs::triangle::Triangle;

use super::faces::Faces;

/// The tree, and the triangles in its order.
pub(super) struct Obvhs {
    tree: CwBvh,
    triangles: Vec<Triangle>,
}

impl Faces for Obvhs {
    const NAME: &'static str = "obvhs";
    const MODE: &'static str = "slow build";

    fn build(corners: &[[[f32; 3]; 3]]) -> Self {
        let triangle = |c: &[[f32; 3]; 3]| {
            let [v0, v1, v2] = c.map(Vec3A::from_array);
            Triangle { v0, v1, v2 }
        };
        let given: Vec<Triangle> = corners.iter().map(triangle).collect();
        let tree = build_cwbvh_from_tris(&given, BvhBuildParams::slow_build(), &mut Duration::default());
        let triangles = tree.primitive_indices.iter().map(|&i| given[i as usize]).collect();
        Self { tree, triangles }
    }

    fn nearest(&self, ray: [[f32; 3]; 2], range: [f32; 2]) -> Option<(f32, usize)> {
        let mut hit = RayHit::none();
        let found =
            self.tree.ray_traverse(asked(ray, range), &mut hit, |ray, i| self.triangles[i].intersect(ray));
        found.then(|| (hit.t, self.tree.primitive_indices[hit.primitive_id as usize] as usize))
    }

    fn any(&self, ray: [[f32; 3]; 2], range: [f32; 2]) -> bool {
        !self.tree.ray_traverse_miss(asked(ray, range), |ray, i| self.triangles[i].intersect(ray))
    }
}

fn asked([origin, direction]: [[f32; 3]; 2], [t_min, t_max]: [f32; 2]) -> Ray {
    Ray::new(Vec3A::from_array(origin), Vec3A::from_array(direction), t_min, t_max)
}
