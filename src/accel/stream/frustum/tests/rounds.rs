//! Spheres and cylinders: what rays of a pyramid tell of them together, against what each finds.

use super::*;
use crate::accel::block::Round;
use crate::intersect::{Curved, cylinder, sphere};

/// A sphere, or a cylinder by its ends: about the way of a ray, or about the apex.
#[derive(Clone, Copy, Debug)]
struct Body {
    ends: [[f32; 3]; 2],
    radius: f32,
}

fn body(rays: &[Ray], dice: &mut Dice) -> Body {
    let ray = &rays[dice.below(rays.len())];
    let t = dice.between(-0.5, 2.0);
    let at = three(|k| f64::from(ray.origin[k]) + t * f64::from(ray.direction[k]));
    let radius = [1e-5, 1e-3, 0.02, 0.5, 4.0][dice.below(5)];
    // Rays touch many of them.
    let at = offset(at, radius * [0.3, 1.0, 3.0][dice.below(3)], dice);
    let length = [1e-4, 0.05, 1.0][dice.below(3)];
    let ends = [0, 1].map(|_| offset(at, length, dice).map(|x| x as f32));
    Body { ends, radius: radius as f32 }
}

/// Where a tier has a ray hit the sphere about the first end, or the cylinder, within the ray's range.
fn hits<T: Tier>(ray: &Ray, body: &Body, is_sphere: bool) -> Option<f32> {
    let real = |x: f32| T::Real::constant(f64::from(x));
    let ray = RayLanes::<T::Real> {
        origin: Vec3::splat_f32(ray.origin),
        direction: Vec3::splat_f32(ray.direction),
        t_min: real(ray.t_min),
        t_max: real(ray.t_max),
    };
    let ([from, to], radius) = (body.ends.map(Vec3::splat_f32), real(body.radius));
    let hit = match is_sphere {
        true => T::Curved::sphere(&ray, &sphere::Lanes { center: from, radius }),
        false => T::Curved::cylinder(&ray, &cylinder::Lanes { from, to, radius, capped: true }),
    };
    let t: f32 = T::nearest_f32(T::Wide::splat(hit.t)).get(0);
    (hit.mask && hit.t.gt(ray.t_min) && hit.t.lt(ray.t_max)).then_some(t)
}

/// Whether the ray's line passes a sphere at twice its radius.
fn passes_clearly(ray: &Ray, body: &Body) -> bool {
    let f: [f64; 3] = three(|k| f64::from(body.ends[0][k]) - f64::from(ray.origin[k]));
    let d = ray.direction.map(f64::from);
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    dot(f, f) - dot(f, d).powi(2) / dot(d, d) > 4.0 * f64::from(body.radius).powi(2)
}

#[test]
fn no_ray_that_hits_is_told_to_pass_by_and_most_that_do_are() {
    let (mut met, mut passed) = ([0; 2], [0; 2]);
    for seed in 0..20_000 {
        let dice = &mut Dice(seed);
        let (mut rays, apex) = beam(dice);
        let bodies: [Body; WIDTH] = std::array::from_fn(|_| body(&rays, dice));
        let scale = [1.0, 1e-12, 1e6, 1e-6][dice.below(4)];
        let apex = scaled(&mut rays, apex, scale);
        let Some(frustum) = around(&rays, apex, false, 8.0 * scale) else { continue };
        let bodies =
            bodies.map(|b| Body { ends: b.ends.map(|end| end.map(|x| x * scale)), radius: b.radius * scale });
        let end = |n: usize| three(|k| std::array::from_fn(|i| bodies[i].ends[n][k]));
        let ([from, to], radius) = ([end(0), end(1)], bodies.map(|b| b.radius));
        let rounds = [
            frustum.rounds(Round::Cylinders { ends: [&from, &to], radius: &radius }),
            frustum.rounds(Round::Spheres { center: &from, radius: &radius }),
        ];
        let [center, wide_radius] = [&from, &[radius; 3]].map(Vec3::<f32x8>::load_f32);
        let (lo, hi) = (center - wide_radius, center + wide_radius);
        let sight = frustum.sight(&frustum.view().boxes(|k| lo.axis(k), |k| hi.axis(k)));
        for (kind, i, r) in
            (0..2).flat_map(|kind| (0..WIDTH * rays.len()).map(move |n| (kind, n % WIDTH, n / WIDTH)))
        {
            let (ray, body, j, lane) = (&rays[r], &bodies[i], r / WIDTH, r % WIDTH);
            let may_hit = frustum.may_hit(&rounds[kind], i, j) >> lane & 1 != 0;
            let hit = hits::<Watertight>(ray, body, kind == 1);
            if hit.is_some() || hits::<Exact>(ray, body, kind == 1).is_some() {
                met[kind] += 1;
                assert!(may_hit, "{ray:?} {body:?} {apex:?}, seed {seed}");
            }
            if kind == 1
                && let Some(t) = hit
            {
                let reaching = frustum.reaching(&sight, i, j, f32x8::splat(t));
                assert!(reaching >> lane & 1 != 0, "{ray:?} {body:?} {apex:?}, seed {seed}");
            }
            if kind == 1 && body.radius > 1e-3 * scale && passes_clearly(ray, body) {
                passed[usize::from(may_hit)] += 1;
            }
        }
    }
    println!("{met:?} hits; passed and told, and not told: {passed:?}");
    assert!(met[0] > 100_000 && met[1] > 100_000 && passed[1] * 50 < passed[0], "{met:?} {passed:?}");
}
