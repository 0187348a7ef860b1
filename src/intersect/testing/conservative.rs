//! Nothing that culls may lose what decides.

use super::dice::Dice;
use super::{exact, line, ray};
use crate::intersect::aabb::{CullRay, OwnBox};
use crate::intersect::{Curved, RayLanes, curved, cylinder, sphere};
use crate::math::{Aabb, Real, Vec3};

/// Triangles that are flat, tiny, huge or far, and rays that graze them or run in their planes.
struct Meeting {
    vertices: [[f32; 3]; 3],
    origin: [f32; 3],
    direction: [f32; 3],
}

fn meeting(dice: &mut Dice) -> Meeting {
    let size = [1.0, dice.magnitude(-6.0, 6.0).abs() as f32][dice.below(2)];
    let mut vertices: [[f32; 3]; 3] = std::array::from_fn(|_| std::array::from_fn(|_| size * dice.hard()));
    if dice.below(3) == 0 {
        let axis = dice.below(3);
        (vertices[1][axis], vertices[2][axis]) = (vertices[0][axis], vertices[0][axis]);
    }
    let target = target(dice, &vertices);
    let reach = [size, 1e3 * size][dice.below(2)];
    let mut origin: [f32; 3] = std::array::from_fn(|_| reach * dice.hard());
    if dice.below(2) == 0 {
        // Parallel to an axis or to a plane of two.
        let axis = dice.below(3);
        origin[axis] = target[axis];
        if dice.below(2) == 0 {
            origin[(axis + 1) % 3] = target[(axis + 1) % 3];
        }
    }
    let length = [1.0, dice.magnitude(-12.0, 12.0).abs() as f32][dice.below(2)];
    let direction = std::array::from_fn(|k| (target[k] - origin[k]) * length);
    Meeting { vertices, origin, direction }
}

/// A vertex, a point on an edge, or a point inside.
fn target(dice: &mut Dice, v: &[[f32; 3]; 3]) -> [f32; 3] {
    let (a, b) = match dice.below(3) {
        0 => (0.0, 0.0),
        1 => (0.0, dice.unit() as f32),
        _ => (dice.unit() as f32 * 0.5, dice.unit() as f32 * 0.5),
    };
    std::array::from_fn(|k| v[0][k] + a * (v[1][k] - v[0][k]) + b * (v[2][k] - v[0][k]))
}

fn bounds(points: &[[f32; 3]]) -> Aabb {
    points.iter().fold(Aabb::EMPTY, |b, &p| b.join_point(p))
}

fn corners<R: Real>(b: &Aabb) -> (Vec3<R>, Vec3<R>) {
    (Vec3::splat_f32(b.min), Vec3::splat_f32(b.max))
}

/// The tree's interval for a box, for a ray that the tree sees in `f32`.
fn cull(ray: &RayLanes<f32>, b: &Aabb, scale: f32) -> (f64, f64) {
    let (lo, hi) = corners(b);
    let prepared = CullRay::new(ray.origin, ray.direction, scale);
    let (enter, leave) = prepared.interval_any(lo, hi, 0.0, f32::INFINITY);
    (f64::from(enter), f64::from(leave))
}

/// Asks that `outer` holds what `inner` has beyond zero.
fn assert_holds(outer: (f64, f64), inner: (f64, f64), of: &str) {
    if inner.0 <= inner.1 && inner.1 >= 0.0 {
        let holds = outer.0 <= inner.0.max(0.0) && outer.1 >= inner.1;
        assert!(holds, "{outer:?} does not hold {inner:?} of {of}");
    }
}

#[test]
fn a_tree_box_holds_the_own_box_of_every_triangle_inside() {
    let mut dice = Dice(1);
    for _ in 0..400_000 {
        let m = meeting(&mut dice);
        let own = bounds(&m.vertices);
        let far = std::array::from_fn(|_| own.magnitude() * dice.hard());
        let tree = [own, own.join_point(far)][dice.below(2)];
        let r = ray(m.origin, m.direction);
        let (lo, hi) = corners(&own);
        let (first, last) = OwnBox::new(r.origin, r.direction).interval(lo, hi);
        let inner = (f64::from(first), f64::from(last));
        let text = format!("{:?} {:?} in {:?}", m.origin, m.direction, tree);
        assert_holds(cull(&r, &tree, tree.magnitude()), inner, &text);
        let wide = RayLanes::widen(&r);
        let (lo, hi) = corners(&own);
        let inner = OwnBox::new(wide.origin, wide.direction).interval(lo, hi);
        assert_holds(cull(&r, &tree, tree.magnitude()), inner, &text);
    }
}

#[test]
fn own_box_and_tree_box_hold_the_exact_hit() {
    let mut dice = Dice(2);
    let mut hits = 0;
    for _ in 0..60_000 {
        let m = meeting(&mut dice);
        let r = line(m.origin, m.direction);
        let Some(t) = exact::triangle(&r, m.vertices.map(Vec3::splat)) else { continue };
        if t.is_nan() || t.abs() >= 1e38 {
            continue;
        }
        hits += 1;
        let b = bounds(&m.vertices);
        let text = format!("{:?} {:?} {:?}", m.origin, m.direction, m.vertices);
        let (lo, hi) = corners(&b);
        let (first, last) = OwnBox::new(r.origin, r.direction).interval(lo, hi);
        assert!(f64::from(first) <= t && t <= f64::from(last), "{first} {last} without {t} of {text}");
        assert_holds(cull(&r, &b, b.magnitude()), (t, t), &text);
        let wide = r.widen();
        let (lo, hi) = corners(&b);
        let (first, last) = OwnBox::new(wide.origin, wide.direction).interval(lo, hi);
        assert!(first <= t && t <= last, "f64: {first} {last} without {t} of {text}");
    }
    assert!(hits > 15_000, "only {hits} rays meet their triangle");
}

/// Rays of the `Exact` tier have digits that the tree's `f32` rays do not.
#[test]
fn a_tree_box_holds_hits_of_rays_rounded_to_f32() {
    let mut dice = Dice(3);
    for _ in 0..400_000 {
        let m = meeting(&mut dice);
        let mut digits = |x: f32| f64::from(x) * (1.0 + dice.between(-6e-8, 6e-8));
        let r = ray(m.origin.map(&mut digits), m.direction.map(&mut digits));
        let b = bounds(&m.vertices);
        let (lo, hi) = corners(&b);
        let inner = OwnBox::new(r.origin, r.direction).interval(lo, hi);
        let rounded = ray(r.origin.get(0).map(|x| x as f32), r.direction.get(0).map(|x| x as f32));
        assert_holds(cull(&rounded, &b, b.magnitude()), inner, &format!("{r:?} {b:?}"));
    }
}

/// A ray, and a point where something near may stand, both of any magnitude.
fn curved_ray(dice: &mut Dice) -> (RayLanes<f32>, [f32; 3], f32) {
    let exponent = [0.0, 6.0, 15.0, 28.0][dice.below(4)];
    let size = dice.magnitude(-exponent, exponent).abs() as f32;
    let far = [1.0, 6.0][dice.below(2)];
    let away = size * dice.magnitude(-1.0, far).abs() as f32;
    let center: [f32; 3] = std::array::from_fn(|_| size * dice.hard());
    let towards = dice.heading();
    let origin: [f32; 3] = std::array::from_fn(|k| center[k] - away * towards[k] as f32);
    let spread = dice.point().map(|x| size * 1.2 * x as f32);
    let speed = dice.magnitude(-exponent.min(18.0), exponent.min(18.0)).abs() as f32 / away;
    let direction = std::array::from_fn(|k| (center[k] + spread[k] - origin[k]) * speed);
    (ray(origin, direction), center, size)
}

fn assert_kept(name: &str, plain: (bool, f64), kept: bool, count: &mut [usize; 2], of: &dyn std::fmt::Debug) {
    let counts = plain.0 && plain.1 > 0.0 && plain.1 < 3e38;
    count[usize::from(counts)] += 1;
    assert!(kept || !counts, "{name}: the filter rejects t = {} of {of:?}", plain.1);
}

#[test]
fn the_f32_filters_reject_no_hit_of_f64() {
    let mut dice = Dice(4);
    let mut counts = [[0; 2]; 2];
    for _ in 0..400_000 {
        let (r, center, radius) = curved_ray(&mut dice);
        let center = Vec3::splat(center);
        let s = sphere::Lanes { center, radius };
        let wide =
            sphere::solve(&r.widen(), &sphere::Lanes { center: center.widen(), radius: radius.into() });
        let kept = curved::Widened::sphere(&r, &s);
        assert_kept("sphere", (wide.mask, wide.t), kept.mask, &mut counts[0], &(r, s));

        let long = radius * dice.magnitude(-3.0, 3.0).abs() as f32;
        let to = center + Vec3::splat(dice.heading().map(|x| x as f32)) * long;
        let c = cylinder::Lanes { from: center, to, radius, capped: dice.below(2) == 0 };
        let double =
            cylinder::Lanes { from: center.widen(), to: to.widen(), radius: radius.into(), capped: c.capped };
        let wide = cylinder::solve(&r.widen(), &double);
        let kept = curved::Widened::cylinder(&r, &c);
        assert_kept("cylinder", (wide.mask, wide.t), kept.mask, &mut counts[1], &(r, c));
    }
    assert!(counts.iter().all(|[misses, hits]| misses.min(hits) > &40_000), "{counts:?}");
}

/// Where the product of direction and axis lies nearly along a coordinate axis the filter has no slack but its own.
#[test]
fn the_filter_of_cylinders_keeps_tangents_across_axes() {
    let mut dice = Dice(5);
    let mut counts = [0; 2];
    for _ in 0..200_000 {
        let (slope, far) = (dice.magnitude(-10.0, -5.0), dice.between(1.0, 200.0));
        let radius = dice.between(0.5, 2.0) as f32;
        let height = f64::from(radius) * (1.0 + slope * slope).sqrt() - slope * far;
        let mut height = height as f32;
        (0..dice.below(3)).for_each(|_| height = height.next_down());
        let r = RayLanes {
            origin: Vec3::new(-far as f32, height, 0.0),
            direction: Vec3::new(1.0, slope as f32, 0.0),
            t_min: 0.0,
            t_max: f32::INFINITY,
        };
        let ends = [-1.0, 1.0].map(|z| Vec3::new(0.0, 0.0, z));
        let c = cylinder::Lanes { from: ends[0], to: ends[1], radius, capped: true };
        let [from, to] = ends.map(Vec3::widen);
        let double = cylinder::Lanes { from, to, radius: f64::from(radius), capped: true };
        let wide = cylinder::solve(&r.widen(), &double);
        let kept = curved::Widened::cylinder(&r, &c);
        assert_kept("cylinder", (wide.mask, wide.t), kept.mask, &mut counts, &(r, c));
    }
    assert!(counts.iter().all(|&n| n > 10_000), "{counts:?}");
}

/// From more radii away than `f32` has roundoffs in one, the filter lives by its slack alone.
#[test]
fn the_filter_of_cylinders_keeps_wires_from_far_away() {
    let mut dice = Dice(6);
    let mut counts = [0; 2];
    for _ in 0..30_000 {
        let radius = dice.magnitude(-3.0, 0.0).abs() as f32;
        let away = f64::from(radius) * dice.magnitude(6.5, 9.0).abs();
        let (axis, heading, share) = (dice.heading(), dice.heading(), dice.between(0.2, 0.8));
        let to: [f32; 3] = axis.map(|x| (0.1 * away * x) as f32);
        let target = to.map(|x| f64::from(x) * share);
        let origin: [f32; 3] = std::array::from_fn(|k| (target[k] - away * heading[k]) as f32);
        let r = ray(origin, std::array::from_fn(|k| (target[k] - f64::from(origin[k])) as f32));
        let (from, to) = (Vec3::splat([0.0; 3]), Vec3::splat(to));
        let c = cylinder::Lanes { from, to, radius, capped: true };
        let double =
            cylinder::Lanes { from: from.widen(), to: to.widen(), radius: radius.into(), capped: true };
        let wide = cylinder::solve(&r.widen(), &double);
        let kept = curved::Widened::cylinder(&r, &c);
        assert_kept("cylinder", (wide.mask, wide.t), kept.mask, &mut counts, &(r, c));
    }
    assert!(counts[1] > 10_000, "{counts:?}");
}
