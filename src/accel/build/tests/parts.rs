//! What cut triangles rest on: wherever a ray hits a triangle, it is in the box of some part at that very `t`.

use super::super::box8::Box8;
use super::super::cut::Sweep;
use crate::accel::tests::rays;
use crate::intersect::aabb::CullRay;
use crate::intersect::testing::dice::Dice;
use crate::intersect::testing::grazing::{KINDS, hard_triangle, in_plane};
use crate::intersect::{Exact, Ray, RayLanes, Tier, TriangleTest, Watertight, triangle};
use crate::math::{Lane, Real, Vec3};

/// A triangle cut at random places.
fn parts(corners: [[f32; 3]; 3], dice: &mut Dice) -> Vec<Box8> {
    let mut parts = vec![Box8::of(&triangle::bounds(corners))];
    for _ in 0..1 + dice.below(6) {
        let sweep = |axis| Sweep::new(corners, axis);
        let cut = |part: &Box8| {
            let (b, axis) = (part.to_aabb(), dice.below(3));
            sweep(axis).cut(*part, b.min[axis] + dice.unit() as f32 * (b.max[axis] - b.min[axis]))
        };
        parts = parts.iter().flat_map(cut).filter(|part| !part.is_empty()).collect();
    }
    parts
}

/// Whether the ray hits; the boxes must hold `t` as the traversal would cull them.
fn hit_in_a_part<T: Tier>(ray: &Ray, corners: [[f32; 3]; 3], parts: &[Box8]) -> bool {
    let real = <T::Real as Real>::from_f32;
    let lanes = RayLanes {
        origin: Vec3::splat_f32(ray.origin),
        direction: Vec3::splat_f32(ray.direction),
        t_min: real(ray.t_min),
        t_max: real(ray.t_max),
    };
    let test =
        |limit| T::Triangle::test(&lanes, &T::Triangle::prepare(&lanes), corners.map(Vec3::splat_f32), limit);
    let hit = test(T::Real::constant(f64::INFINITY));
    if !hit.mask {
        return false;
    }
    let scale = triangle::bounds(corners).magnitude();
    let cull = CullRay::new(Vec3::splat(ray.origin), Vec3::splat(ray.direction), scale);
    let t = T::nearest_f32(T::Wide::splat(hit.t)).to_array()[0];
    // In `Exact` the traversal rounds limits outwards.
    let exact = T::Real::ROUNDOFF < f32::ROUNDOFF;
    let (from, to) = if exact { (t.next_down(), t.next_up()) } else { (t, t) };
    let holds = |part: &Box8| {
        let b = part.to_aabb();
        let (enter, leave) = cull.interval_any(Vec3::splat(b.min), Vec3::splat(b.max), from, to);
        enter <= leave
    };
    assert!(parts.iter().any(holds), "{ray:?} hits {corners:?} at {t} beside {parts:?}");
    true
}

#[test]
fn every_hit_is_in_the_box_of_a_part() {
    let mut dice = Dice(91);
    let (mut hits, mut in_planes) = (0, 0);
    for round in 0..40_000 {
        let scale = [1.0, 1e-3, 1e4][dice.below(3)];
        let corners = hard_triangle(round % KINDS, &mut dice).map(|p| p.map(|x| scale * x));
        let parts = parts(corners, &mut dice);
        let rays = rays::around(&corners, &mut dice, 8);
        let grazing: Vec<Ray> = (0..16).map(|_| in_plane(&[corners], &mut dice)).collect();
        let usable = |ray: &&Ray| ray.direction != [0.0; 3];
        let hit = |ray: &Ray| {
            let hit = hit_in_a_part::<Watertight>(ray, corners, &parts);
            usize::from(hit) + usize::from(hit_in_a_part::<Exact>(ray, corners, &parts))
        };
        hits += rays.iter().filter(usable).map(hit).sum::<usize>();
        in_planes += grazing.iter().filter(usable).map(hit).sum::<usize>();
    }
    assert!(hits > 10_000 && in_planes > 10_000, "{hits} hits, {in_planes} of rays in planes");
}
