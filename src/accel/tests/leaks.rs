//! Closed meshes around the origins of rays.

use super::scenes::World;
use super::{HINTS, lane};
use crate::accel::build::Quality;
use crate::accel::ray_scene::lanes;
use crate::accel::{Accel, Traversal};
use crate::intersect::testing::dice::Dice;
use crate::intersect::testing::meshes::icosphere;
use crate::intersect::{Exact, Ray, Tier, Watertight};
use crate::math::WIDTH;

/// No ray gets out of a closed mesh: not through edges, not through vertices, not through the tree. Stretched, its
/// triangles are needles, which are cut.
#[test]
fn a_closed_mesh_holds_every_ray_inside() {
    for (stretch, quality) in [(1.0, Quality::Balanced), (1.0, Quality::High), (60.0, Quality::High)] {
        let (points, center, size) = icosphere(4).placed(&mut Dice(17), 3.0);
        let center: [f64; 3] = center.get(0);
        let stretched = |p: [f32; 3]| {
            let from = |k: usize| f64::from(p[k]) - center[k];
            let along = (stretch - 1.0) * (0..3).map(from).sum::<f64>() / 3.0;
            std::array::from_fn(|k| (f64::from(p[k]) + along) as f32)
        };
        let points: Vec<[f32; 3]> = points.into_iter().map(stretched).collect();
        let triangles: Vec<[u32; 3]> = icosphere(4).triangles.iter().map(|t| t.map(|v| v as u32)).collect();
        let mut world = World::default();
        world.push_mesh(&points, &triangles);
        let accel = Accel::build_with(&world.geometry(), quality);
        let rays = from_inside(&points, center, 0.5 * size, &mut Dice(18));
        assert_eq!(leaks::<Watertight>(&accel, &rays), [0; 3]);
        assert_eq!(leaks::<Exact>(&accel, &rays), [0; 3]);
    }
}

/// Rays from within a radius, anywhere and at vertices.
fn from_inside(points: &[[f32; 3]], center: [f64; 3], radius: f64, dice: &mut Dice) -> Vec<Ray> {
    let ray = |i: usize| {
        let offset = dice.point();
        let origin: [f32; 3] = std::array::from_fn(|k| (center[k] + radius * offset[k]) as f32);
        let vertex = points[i % points.len()];
        let towards =
            [dice.heading().map(|x| x as f32), std::array::from_fn(|k| vertex[k] - origin[k])][i % 2];
        Ray::new(origin, towards)
    };
    (0..60_000).map(ray).collect()
}

fn leaks<T: Tier>(accel: &Accel, rays: &[Ray]) -> [usize; 3] {
    let mut traversal = Traversal::new(accel);
    HINTS.map(|hint| {
        let mut missed = |packet: &[Ray]| {
            let rays = lanes::<T>(packet).expect("rays have directions");
            let found = traversal.closest::<T>(&rays, hint);
            let missed = (0..packet.len()).filter(|&i| lane(&found, rays.t_max, i).is_none()).count();
            missed
                + (traversal.any::<T>(&rays, hint).count_zeros() as usize).saturating_sub(32 - packet.len())
        };
        rays.chunks(WIDTH).map(&mut missed).sum()
    })
}
