//! Surfaces seen through instances.

use wide::{f32x8, f64x8};

use super::*;
use crate::accel::Accel;
use crate::geometry::{Group, Instance, NO_MATERIAL, push3};
use crate::intersect::RayLanes;
use crate::intersect::testing::dice::Dice;
use crate::intersect::testing::pressed::pressed;
use crate::intersect::testing::{exact, line};
use crate::math::Transform;
use crate::wavefront::offset_along;

/// The same sphere in the world and shown once more, turned and pressed.
fn world() -> Geometry {
    let mut g = Geometry::default();
    g.spheres.push([0.3, 0.2, 0.1], 1.7, NO_MATERIAL);
    let group = || Group { triangles: 0..0, spheres: 0..1, cylinders: 0..0 };
    g.groups = vec![group(), group()];
    let to_world = Transform::from_rows([[0.1, 0.7, 0.0, 5.0], [-0.4, 0.2, 0.3, 0.0], [0.0, 0.1, 0.9, 1.0]]);
    g.instances = vec![Instance { group: 1, to_world: to_world.unwrap(), material: NO_MATERIAL, object: 1 }];
    g
}

/// One triangle, shown by an instance that is pressed and far from the origin or back at it.
fn shown(dice: &mut Dice) -> (Geometry, [Vec3<f64>; 3]) {
    let far = |dice: &mut Dice| dice.point().map(|x| x * [1.0, 1e3][dice.below(2)]);
    let by = dice.magnitude(-3.0, 0.0).abs();
    let (to, at) = (far(dice), far(dice));
    let place = pressed(dice, by, [0.0; 3]);
    let back = place.direction(at);
    let to: [f64; 3] = [to, std::array::from_fn(|k| to[k] - back[k])][dice.below(2)];
    let rows = place.rows();
    let rows = std::array::from_fn(|k| [rows[k][0], rows[k][1], rows[k][2], to[k]]);
    let mut g = Geometry::default();
    let corners: [[f32; 3]; 3] = std::array::from_fn(|_| {
        let p = dice.point();
        std::array::from_fn(|k| (at[k] + p[k]) as f32)
    });
    for (column, corner) in g.triangles.vertex.iter_mut().zip(corners) {
        column.push(g.triangles.position[0].len() as u32);
        push3(&mut g.triangles.position, corner);
    }
    g.triangles.material.push(NO_MATERIAL);
    let to_world = Transform::from_rows(rows).expect("pressed, but not flat");
    g.instances = vec![Instance { group: 1, to_world, material: NO_MATERIAL, object: 1 }];
    (g, corners.map(|p| Vec3::splat(p.map(f64::from))))
}

/// Whether a point moved off the surface is off it in the space of the instance, as the next ray is rounded there.
fn starts_outside<L: Lane>(g: &Geometry, corners: [Vec3<f64>; 3], [u, v]: [f64; 2]) -> Option<bool> {
    let (zero, all) = (Vec3::<L>::splat_f32([0.0; 3]), [1; WIDTH]);
    let (u, v) = (L::constant(u), L::constant(v));
    let hit = HitLanes { origin: zero, direction: zero, t: L::zero(), u, v, row: [0; WIDTH], instance: all };
    let met = evaluate(g, PrimKind::Triangle, &hit);
    let origin = offset_along(met.point, met.error, met.geometric_normal);
    let ray = RayLanes { origin, direction: met.geometric_normal, t_min: L::zero(), t_max: L::zero() };
    let local = Accel::local_rays(&g.instances[0].to_world, &ray).get(0);
    let f64s = |v: Vec3<L::Scalar>| v.get(0).map(Real::to_f64);
    // The surface is behind a ray that goes on along the normal.
    Some(exact::triangle(&line(f64s(local.origin), f64s(local.direction)), corners)? < 0.0)
}

/// The bound holds what both ways between the spaces round, where it counts most: across surfaces that hold the axis along
/// which they are pressed.
#[test]
fn points_moved_off_an_instance_are_off_it_in_its_space() {
    let mut dice = Dice(51);
    let mut asked = 0;
    for _ in 0..60_000 {
        let (g, corners) = shown(&mut dice);
        let weights = [dice.between(0.2, 0.4), dice.between(0.2, 0.4)];
        let outside =
            [starts_outside::<f32x8>(&g, corners, weights), starts_outside::<f64x8>(&g, corners, weights)];
        asked += outside.iter().flatten().count();
        assert!(!outside.contains(&Some(false)), "[watertight, exact] {outside:?}: {weights:?} of {g:?}");
    }
    assert!(asked > 80_000, "{asked}");
}

fn surfaces(instance: [u32; WIDTH]) -> SurfaceLanes<f32x8> {
    let at = |x: f32| <f32x8 as Lane>::from_fn(|i| x * (i as f32 + 1.3));
    let hit = HitLanes {
        origin: Vec3::new(at(-0.7), at(0.31), at(-2.9)),
        direction: Vec3::new(at(0.11), at(0.07), at(0.93)),
        t: at(0.21),
        u: at(0.0),
        v: at(0.0),
        row: [0; WIDTH],
        instance,
    };
    evaluate(&world(), PrimKind::Sphere, &hit)
}

/// Which hits are evaluated together depends on how queues are cut: no bit of a surface may.
#[test]
fn a_surface_does_not_depend_on_the_lanes_beside_it() {
    let alone = [surfaces([0; WIDTH]), surfaces([1; WIDTH])];
    let mixed: [u32; WIDTH] = std::array::from_fn(|i| i as u32 & 1);
    let bits = |s: &SurfaceLanes<f32x8>, i: usize| {
        let [p, g, n] = [s.point, s.geometric_normal, s.shading_normal].map(|v| v.get(i));
        [p, g, n, [s.error.get(i), s.uv.0.get(i), s.uv.1.get(i)]].map(|v| v.map(f32::to_bits))
    };
    let together = surfaces(mixed);
    for (i, &instance) in mixed.iter().enumerate() {
        assert_eq!(bits(&together, i), bits(&alone[instance as usize], i), "lane {i}");
    }
}
