//! The rays of a class: a function of the subject, the size of the picture and nothing else.
//!
//! Secondary rays start where the plain traversal finds what the camera sees, off the surface by so much of the scene that
//! no ray tracer with `f32` distances finds the same surface again. All directions have length one: not every ray tracer
//! allows others (Embree 4.4 loses hits on cones).

use super::classes::Class;
use wide::f32x8;

use super::octray::Octray;
use super::rays::RaySet;
use super::subject::{Subject, Target};
use crate::accel::query::Closest;
use crate::accel::stream::Apex;
use crate::accel::{Hint, Traversal};
use crate::intersect::{PrimId, RayLanes, Watertight};
use crate::math::{BitLane, Lane, Mask, Vec3, WIDTH};
use crate::sampling::{cosine_hemisphere, pcg4d, to_frame, unit};
use crate::wavefront::{self, HitLanes, evaluate, tiles};

/// How far secondary rays start off their surface, as a share of the diagonal.
const OFFSET: f64 = 1e-5;
/// Length of rays that ask whether anything is near, as a share of the diagonal.
const AO_LENGTH: f64 = 0.05;

/// The rays of a class. Secondary ones are as many as camera rays hit something, in the order of the picture.
pub fn ray_set(subject: &Subject, class: Class, size: [u32; 2]) -> RaySet {
    match class {
        Class::Primary => primary(subject, size),
        Class::Random => random(subject, size),
        _ => secondary(subject, class, size),
    }
}

/// Numbers from 0 to 1 for a ray of a class.
fn numbers(class: Class, ray: usize) -> [f64; 4] {
    pcg4d([ray as u32, class as u32, 0, 0x0c7a]).map(unit::<f64>)
}

fn to_f32(v: Vec3<f64>) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}

/// Pixels in the order in which a render sends them.
fn pixels([width, height]: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    tiles([0, 0, width, height]).into_iter().flat_map(|tile| {
        let mut list = Vec::new();
        wavefront::pixels(tile, &mut list);
        list
    })
}

fn primary(subject: &Subject, size @ [width, height]: [u32; 2]) -> RaySet {
    let apex = subject.camera.apex();
    let mut rays = RaySet { apex, ..RaySet::default() };
    for (i, [x, y]) in pixels(size).enumerate() {
        let [jx, jy, ..] = numbers(Class::Primary, i);
        let film_x = 2.0 * (f64::from(x) + jx) / f64::from(width) - 1.0;
        let film_y = 1.0 - 2.0 * (f64::from(y) + jy) / f64::from(height);
        let ray = subject.camera.rays::<f64>((film_x, film_y), || (0.0, 0.0));
        rays.push(to_f32(ray.origin), to_f32(ray.direction), [0.0, f32::INFINITY]);
    }
    rays
}

fn random(subject: &Subject, [width, height]: [u32; 2]) -> RaySet {
    let bounds = subject.accel.bounds();
    let (low, size) = (bounds.min, bounds.size());
    let mut rays = RaySet::default();
    for i in 0..width as usize * height as usize {
        let [x, y, z, _] = numbers(Class::Random, 2 * i);
        let [u, v, ..] = numbers(Class::Random, 2 * i + 1);
        let share = [x, y, z].map(|s| s as f32);
        let origin = std::array::from_fn(|k| low[k] + share[k] * size[k]);
        rays.push(origin, sphere_direction(u, v), [0.0, f32::INFINITY]);
    }
    rays
}

/// A direction that is uniform over the sphere where `u` and `v` are uniform from 0 to 1.
fn sphere_direction(u: f64, v: f64) -> [f32; 3] {
    let z = 1.0 - 2.0 * u;
    let radius = (1.0 - z * z).max(0.0).sqrt();
    let (sin, cos) = libm::sincos(std::f64::consts::TAU * v);
    [(radius * cos) as f32, (radius * sin) as f32, z as f32]
}

/// What a camera ray met.
struct Seen {
    /// Off the surface, on the side that the ray came from.
    point: Vec3<f64>,
    /// To that side.
    normal: Vec3<f64>,
    direction: Vec3<f64>,
}

fn secondary(subject: &Subject, class: Class, size: [u32; 2]) -> RaySet {
    let apex = match (class, subject.light) {
        (Class::Shadow, Target::Point(place)) => Some(Apex::Target(place.map(|x| x as f32))),
        (Class::Shadow, Target::Direction(_)) => Some(Apex::Parallel),
        _ => None,
    };
    let mut rays = RaySet { apex, ..RaySet::default() };
    let mut traversal = Traversal::new(&subject.accel);
    let camera_rays = primary(subject, size);
    for first in (0..camera_rays.len()).step_by(WIDTH) {
        let packet = Octray::<Watertight>::packet(&camera_rays.columns(), first);
        let found = traversal.closest::<Watertight>(&packet, Hint::Incoherent);
        let hit = found.t.lt(packet.t_max).bits();
        for lane in (0..WIDTH).filter(|lane| hit >> lane & 1 != 0) {
            let seen = seen(subject, &packet, &found, lane);
            let (direction, t_max) = leave(subject, class, &seen, numbers(class, first + lane));
            rays.push(to_f32(seen.point), to_f32(direction), [0.0, t_max]);
        }
    }
    rays
}

/// The surface that a lane met.
fn seen(subject: &Subject, packet: &RayLanes<f32x8>, found: &Closest<f32x8>, lane: usize) -> Seen {
    let ray = packet.get(lane);
    let prim = PrimId(found.prim.get(lane));
    let hit = HitLanes {
        origin: ray.origin,
        direction: ray.direction,
        t: found.t.get(lane),
        u: found.u.get(lane),
        v: found.v.get(lane),
        row: [prim.row() as u32; WIDTH],
        instance: [found.instance.get(lane); WIDTH],
    };
    let surface = evaluate(&subject.geometry, prim.kind(), &hit);
    let (direction, outward) = (ray.direction.widen(), surface.geometric_normal.widen().normalize());
    let normal = if outward.dot(direction) > 0.0 { -outward } else { outward };
    Seen { point: surface.point.widen() + normal * (OFFSET * subject.diagonal()), normal, direction }
}

/// Direction and length of a ray of a class that leaves what was seen.
fn leave(subject: &Subject, class: Class, seen: &Seen, [u, v, ..]: [f64; 4]) -> (Vec3<f64>, f32) {
    let (d, n) = (seen.direction, seen.normal);
    match (class, subject.light) {
        (Class::Shadow, Target::Point(place)) => {
            let way = Vec3::splat(place) - seen.point;
            (way.normalize(), way.length() as f32)
        }
        (Class::Shadow, Target::Direction(direction)) => (Vec3::splat(direction).normalize(), f32::INFINITY),
        (Class::Reflect, _) => (d - n * (2.0 * d.dot(n)), f32::INFINITY),
        (Class::Ao, _) => (to_frame(cosine_hemisphere(u, v), n), (AO_LENGTH * subject.diagonal()) as f32),
        _ => (to_frame(cosine_hemisphere(u, v), n), f32::INFINITY),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::brute;
    use crate::intersect::Ray;
    use crate::measure::bench::testing::subject;
    use crate::measure::bench::view::View;

    const SIZE: [u32; 2] = [16, 16];

    #[test]
    fn pixels_come_once_each_and_in_blocks_of_neighbours() {
        for size in [[16, 16], [9, 3], [1, 1], [64, 8]] {
            let all: Vec<_> = pixels(size).collect();
            let mut sorted = all.clone();
            sorted.sort_unstable();
            sorted.dedup();
            assert_eq!((all.len(), sorted.len()), ((size[0] * size[1]) as usize, all.len()));
        }
        let tile: Vec<_> = pixels([32, 32]).collect();
        assert_eq!(tile[..8], [[0, 0], [1, 0], [2, 0], [3, 0], [0, 1], [1, 1], [2, 1], [3, 1]]);
        assert_eq!([tile[63], tile[64], tile[255], tile[256]], [[7, 7], [8, 0], [15, 15], [16, 0]]);
    }

    #[test]
    fn the_same_rays_every_time_and_in_any_number_of_threads() {
        let subject = subject("instances", View::Scene);
        for class in Class::ALL {
            let rays = ray_set(&subject, class, SIZE);
            assert!(!rays.is_empty(), "{class}");
            let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
            assert!(rays == pool.install(|| ray_set(&subject, class, SIZE)), "{class}");
        }
    }

    #[test]
    fn rays_that_leave_a_sphere_do_not_hit_it() {
        let subject = subject("spheres", View::Scene);
        for class in [Class::Reflect, Class::Diffuse, Class::Ao] {
            let rays = ray_set(&subject, class, SIZE);
            let columns = rays.columns();
            for i in 0..rays.len() {
                let [origin, direction] = columns.ray(i);
                let ray = Ray { origin, direction, t_min: rays.t_min[i], t_max: rays.t_max[i] };
                let hit = brute::closest::<Watertight>(&subject.geometry, &RayLanes::from(&ray));
                assert!(hit.is_none_or(|hit| hit.t > 1e-3), "{class} {i}: {hit:?}");
            }
        }
    }

    #[test]
    fn shadow_rays_end_at_the_light_and_short_ones_soon() {
        let subject = subject("cornell", View::Scene);
        let Target::Point(light) = subject.light else { panic!("cornell has a light with a place") };
        let rays = ray_set(&subject, Class::Shadow, SIZE);
        for i in 0..rays.len() {
            let [origin, direction] = rays.columns().ray(i);
            let end = |k: usize| f64::from(origin[k] + direction[k] * rays.t_max[i]);
            assert!((0..3).all(|k| (end(k) - light[k]).abs() < 1e-4), "{i}");
        }
        let short = ray_set(&subject, Class::Ao, SIZE);
        assert!(short.t_max.iter().all(|&t| f64::from(t) < 0.06 * subject.diagonal()));
    }

    #[test]
    fn random_rays_start_within_the_bounds_and_go_everywhere() {
        let subject = subject("spheres", View::Scene);
        let (rays, bounds) = (ray_set(&subject, Class::Random, [64, 64]), subject.accel.bounds());
        for k in 0..3 {
            assert!(rays.origin[k].iter().all(|&x| bounds.min[k] <= x && x <= bounds.max[k]));
            let mean = rays.direction[k].iter().sum::<f32>() / rays.len() as f32;
            assert!(mean.abs() < 0.03, "axis {k}: {mean}");
        }
    }
}
