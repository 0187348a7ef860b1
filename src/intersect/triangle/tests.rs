//! The triangle tests against exact arithmetic, and closed meshes that must not leak.

mod glimpse;

use wide::{f32x8, f64x8};

use super::{ExactVolumes, FilteredVolumes, MollerTrumbore, Woop, oracle};
use crate::intersect::aabb::CullRay;
use crate::intersect::testing::dice::Dice;
use crate::intersect::testing::grazing::{KINDS, hard_triangle, in_plane};
use crate::intersect::testing::meshes::{Mesh, cube, icosphere, tetrahedron};
use crate::intersect::testing::{exact, line, percentile, ray, t_of, ulps};
use crate::intersect::{LaneHit, Ray, RayLanes, TriangleTest};
use crate::math::{Aabb, Lane, Mask, Real, Vec3};

fn meet<T: TriangleTest, R: Real>(ray: &RayLanes<R>, v: [Vec3<R>; 3]) -> LaneHit<R> {
    T::test(ray, &T::prepare(ray), v, R::constant(f64::INFINITY))
}

/// How far the line passes from the nearest point of the triangle's edges.
fn distance_to_edges(ray: &RayLanes<f64>, v: [Vec3<f64>; 3]) -> f64 {
    let d = ray.direction * (1.0 / ray.direction.length());
    let across = v.map(|p| (p - ray.origin) + d * -(p - ray.origin).dot(d));
    let to_segment = |a: Vec3<f64>, b: Vec3<f64>| {
        let e = b - a;
        let share = (-a.dot(e) / e.length_squared()).clamp(0.0, 1.0);
        (a + e * share).length()
    };
    (0..3).map(|i| to_segment(across[i], across[(i + 1) % 3])).fold(f64::INFINITY, f64::min)
}

/// The magnitude that roundoffs are relative to: the farthest coordinates of origin and triangle.
fn magnitude(ray: &RayLanes<f64>, v: [Vec3<f64>; 3]) -> f64 {
    ray.origin.abs().max_component() + v.iter().map(|p| p.abs().max_component()).fold(0.0, f64::max)
}

fn random_case(dice: &mut Dice) -> (RayLanes<f32>, [Vec3<f32>; 3]) {
    let size = [1.0, 1e-3, 1e3][dice.below(3)];
    let v: [[f64; 3]; 3] = std::array::from_fn(|_| dice.point().map(|x| x * size));
    let origin = dice.point().map(|x| x * 3.0);
    let (a, b) = (dice.between(-0.3, 1.1), dice.between(-0.3, 1.1));
    let target: [f64; 3] =
        std::array::from_fn(|k| v[0][k] + a * (v[1][k] - v[0][k]) + b * (v[2][k] - v[0][k]));
    let direction = std::array::from_fn(|k| (target[k] - origin[k]) as f32);
    (line(origin.map(|x| x as f32), direction), v.map(|p| Vec3::splat(p.map(|x| x as f32))))
}

/// Hit or miss may differ from exact arithmetic only for lines that pass an edge at 12 roundoffs or less, and `t` is
/// the nearest `f32` for nearly all.
#[test]
fn woop_agrees_with_exact_arithmetic_but_at_edges() {
    let mut dice = Dice(11);
    let (mut errors, mut differ, mut farthest) = (Vec::new(), 0, 0f64);
    for _ in 0..60_000 {
        let (r, v) = random_case(&mut dice);
        let (got, want) = (t_of(meet::<Woop, f32>(&r, v)), exact::triangle(&r, v));
        let (wide, wide_v) = (r.widen(), v.map(Vec3::widen));
        if let (Some(got), Some(want)) = (got, want) {
            errors.push(ulps(got, want));
        } else if got.is_some() != want.is_some() {
            differ += 1;
            let distance = distance_to_edges(&wide, wide_v) / magnitude(&wide, wide_v) / f32::ROUNDOFF;
            farthest = farthest.max(distance);
            assert!(distance <= 12.0, "{distance} roundoffs from an edge: {r:?} {v:?}");
        }
    }
    let share = |errors: &mut [f64], p| percentile(errors, p);
    let (p50, p99, max) = (share(&mut errors, 0.5), share(&mut errors, 0.99), share(&mut errors, 1.0));
    println!(
        "woop f32: {} hits, {differ} differ up to {farthest} roundoffs, t p50 {p50} p99 {p99} max {max} ulp",
        errors.len()
    );
    assert!(errors.len() > 10_000 && p99 <= 0.51);
}

#[test]
fn the_oracle_and_woop_in_f64_agree_with_exact_arithmetic_but_at_edges() {
    let mut dice = Dice(12);
    for _ in 0..40_000 {
        let (r, v) = random_case(&mut dice);
        let (r, v) = (r.widen(), v.map(Vec3::widen));
        let want = exact::triangle(&r, v);
        let near = distance_to_edges(&r, v) / magnitude(&r, v) <= 16.0 * f64::ROUNDOFF;
        let oracle = oracle::meet(&r, v).map(|m| m.t);
        for (name, got) in [("oracle", oracle), ("woop", t_of(meet::<Woop, f64>(&r, v)))] {
            assert!(near || got.is_some() == want.is_some(), "{name}: {got:?} for {want:?} of {r:?} {v:?}");
            if let (Some(got), Some(want)) = (got, want) {
                assert!((got - want).abs() <= 1e-6 * want.abs(), "{name}: {got} for {want} of {r:?} {v:?}");
            }
        }
    }
}

/// Corners of any size, aimed at vertices, edges and faces, by rays whose last bits `f32` does not have.
fn hard_case(dice: &mut Dice) -> (RayLanes<f64>, [Vec3<f64>; 3]) {
    let v: [[f32; 3]; 3] = std::array::from_fn(|_| std::array::from_fn(|_| dice.hard()));
    let weights = aim(dice);
    let target: [f64; 3] =
        std::array::from_fn(|k| (0..3).map(|i| weights[i] * f64::from(v[i][k])).sum::<f64>());
    let near = dice.below(3) == 0;
    let origin: [f64; 3] = std::array::from_fn(|k| {
        if near { target[k] + 1e-9 * f64::from(dice.hard()) } else { f64::from(dice.hard()) }
    });
    let direction = match dice.below(4) {
        0 => std::array::from_fn(|_| f64::from(dice.hard())),
        _ => std::array::from_fn(|k| target[k] - origin[k]),
    };
    let direction = if direction == [0.0; 3] { [0.0, 0.0, 1.0] } else { direction };
    (line(origin, direction), v.map(|p| Vec3::splat(p.map(f64::from))))
}

/// Trees hold parts of triangles by that: the glance passes 10 roundoffs and errs by as many, what it doubts is held to 16
/// before `t, u, v` are rounded.
#[test]
fn a_hit_of_woop_lies_within_20_roundoffs_of_its_triangle() {
    let mut dice = Dice(17);
    let (mut hits, mut farthest) = (0, 0f64);
    for round in 0..400_000 {
        let scale = [1.0, 1e-3, 1e4][dice.below(3)];
        let corners = hard_triangle(round % KINDS, &mut dice).map(|p| p.map(|x| scale * x));
        let Ray { origin, direction, .. } = in_plane(&[corners], &mut dice);
        if direction == [0.0; 3] {
            continue;
        }
        let (r, v) = (line(origin, direction), corners.map(Vec3::splat));
        let hit = meet::<Woop, f32>(&r, v);
        if hit.mask {
            hits += 1;
            farthest = farthest.max(roundoffs_apart(&r.widen(), v.map(Vec3::widen), hit));
            assert!(
                farthest <= 20.0,
                "{farthest} roundoffs between ray and triangle: {hit:?} of {r:?} {v:?}"
            );
        }
    }
    println!("woop f32: {hits} hits in planes, up to {farthest} roundoffs off");
    assert!(hits > 20_000, "{hits}");
}

/// How far, by axis, the point of the ray is from that of the triangle.
fn roundoffs_apart(ray: &RayLanes<f64>, v: [Vec3<f64>; 3], hit: LaneHit<f32>) -> f64 {
    let [t, at_u, at_v] = [hit.t, hit.u, hit.v].map(f64::from);
    let on_triangle = v[0] * (1.0 - at_u - at_v) + v[1] * at_u + v[2] * at_v;
    let apart = (ray.origin + ray.direction * t - on_triangle).abs().max_component();
    apart / (magnitude(ray, v) * f32::ROUNDOFF)
}

/// No case is too hard: hit or miss is that of exact arithmetic, and `t` is off by less than a hundredth of an `f32` ulp.
#[test]
fn the_exact_test_is_exact() {
    let mut dice = Dice(14);
    let (mut hits, mut on_edges) = (0, 0);
    for _ in 0..60_000 {
        let (r, v) = hard_case(&mut dice);
        let (got, want) = (meet::<ExactVolumes, f64>(&r, v), exact::triangle(&r, v));
        assert_eq!(got.mask, want.is_some(), "{r:?} {v:?}");
        if let Some(want) = want {
            hits += 1;
            on_edges += usize::from(got.u == 0.0 || got.v == 0.0 || got.u + got.v == 1.0);
            assert!((got.t - want).abs() <= 1e-9 * want.abs(), "{:e} for {want:e} of {r:?} {v:?}", got.t);
        }
    }
    assert!(hits > 10_000 && on_edges > 3_000, "{hits} {on_edges}");
}

/// Rays that start within some roundoffs of a triangle, as those do that leave one: what lies in front is hit, and nothing else.
#[test]
fn the_exact_test_tells_before_from_behind() {
    let mut dice = Dice(16);
    let mut sides = [0, 0];
    for _ in 0..30_000 {
        let v: [[f32; 3]; 3] = std::array::from_fn(|_| dice.point().map(|x| x as f32));
        let weights = aim(&mut dice);
        let by = 1e-17 * dice.below(60) as f64;
        let aside = dice.heading();
        let on = |k: usize| (0..3).map(|i| weights[i] * f64::from(v[i][k])).sum::<f64>();
        let ray =
            RayLanes { t_min: 0.0, ..line(std::array::from_fn(|k| on(k) + by * aside[k]), dice.heading()) };
        let v = v.map(|p| Vec3::splat(p.map(f64::from)));
        let (got, want) = (meet::<ExactVolumes, f64>(&ray, v), exact::triangle(&ray, v));
        let Some(want) = want else { continue };
        assert_eq!(got.mask && got.t > 0.0, want > 0.0, "{want:e} of {ray:?} {v:?}");
        sides[usize::from(want > 0.0)] += 1;
    }
    assert!(sides.iter().all(|&n| n > 8_000), "{sides:?}");
}

/// Eight triangles for one ray: candidates hold all that the plain test accepts, and the test of a candidate says the same.
#[test]
fn candidates_of_the_exact_test_say_the_same() {
    let mut dice = Dice(15);
    for _ in 0..5_000 {
        let (r, _) = hard_case(&mut dice);
        let mut corners = [[[0.0f32; 8]; 3]; 3];
        let triangles: [[Vec3<f64>; 3]; 8] = std::array::from_fn(|_| hard_case(&mut dice).1);
        for (i, v) in triangles.iter().enumerate() {
            for (k, corner) in v.iter().enumerate() {
                for (axis, x) in corner.get(0).into_iter().enumerate() {
                    corners[k][axis][i] = x as f32;
                }
            }
        }
        let bits = ExactVolumes::candidates::<f64x8>(&r, &(), &corners);
        for (i, &v) in triangles.iter().enumerate() {
            let want = meet::<ExactVolumes, f64>(&r, v);
            let got = ExactVolumes::test_candidates(&r, v, f64::INFINITY);
            assert!(!want.mask || bits >> i & 1 != 0);
            assert_eq!((got.mask, got.t.to_bits()), (want.mask, want.t.to_bits()));
        }
    }
}

/// On a small grid with a dominant component that is a power of two nothing is rounded, so edges and vertices must be
/// decided as exact arithmetic does: they count.
#[test]
fn woop_is_exact_on_a_grid_edges_included() {
    let mut dice = Dice(13);
    let mut on_edges = 0;
    for _ in 0..60_000 {
        let mut grid = || -> [f32; 3] { std::array::from_fn(|_| dice.below(9) as f32 - 4.0) };
        let (v, origin, mut direction) = ([grid(), grid(), grid()], grid(), grid());
        direction[dice.below(3)] = [4.0, -4.0][dice.below(2)];
        let (r, v) = (line(origin, direction), v.map(Vec3::splat));
        let (got, want) = (meet::<Woop, f32>(&r, v), exact::triangle(&r, v));
        assert_eq!(got.mask, want.is_some(), "{r:?} {v:?}");
        if let Some(want) = want {
            on_edges += usize::from(got.u == 0.0 || got.v == 0.0 || got.u + got.v == 1.0);
            assert!(ulps(got.t, want) <= 1.0, "{} for {want} of {r:?} {v:?}", got.t);
        }
    }
    assert!(on_edges > 1_000, "{on_edges}");
}

/// Slip: a triangle test that accepts points on the extended line of an edge.
#[test]
fn a_ray_on_the_extended_line_of_an_edge_misses() {
    let v = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Vec3::<f32>::splat);
    for p in [[2.0, 0.0], [-1.0, 0.0], [0.0, 1.5], [0.0, -0.5], [2.0, -1.0], [-0.5, 1.5]] {
        let r = line([p[0], p[1], -1.0], [0.0, 0.0, 1.0]);
        let hits = [
            meet::<Woop, f32>(&r, v),
            meet::<MollerTrumbore, f32>(&r, v),
            meet::<FilteredVolumes, f32>(&r, v),
        ];
        assert!(hits.iter().all(|hit| !hit.mask), "{p:?}");
    }
}

#[test]
fn barycentric_weights_name_the_vertices() {
    let v = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]].map(Vec3::<f32>::splat);
    let r = line([1.0, 2.0, -8.0], [0.0, 0.0, 2.0]);
    let plain = meet::<MollerTrumbore, f32>(&r, v);
    for hit in [meet::<Woop, f32>(&r, v), plain, meet::<FilteredVolumes, f32>(&r, v)] {
        assert_eq!((hit.mask, hit.t, hit.u, hit.v), (true, 4.0, 0.25, 0.5));
    }
}

/// A mesh in packets, with a box around each.
struct Packets<L> {
    triangles: Vec<[Vec3<L>; 3]>,
    boxes: Vec<Aabb>,
    scale: f32,
}

impl<L: Lane> Packets<L> {
    fn new(mesh: &Mesh, points: &[[f32; 3]]) -> Self {
        let corners =
            |ts: &[[usize; 3]]| ts.iter().flatten().fold(Aabb::EMPTY, |b, &i| b.join_point(points[i]));
        let boxes: Vec<Aabb> = mesh.triangles.chunks(L::WIDTH).map(corners).collect();
        let scale = boxes.iter().map(Aabb::magnitude).fold(0.0, f32::max);
        Self { triangles: mesh.packets(points), boxes, scale }
    }

    /// The nearest `t` beyond zero; infinite where the ray leaks.
    fn nearest<T: TriangleTest>(
        &self,
        ray: &RayLanes<L::Scalar>,
        mut visit: impl FnMut(usize) -> bool,
    ) -> f64 {
        let lanes = RayLanes::<L>::splat(ray);
        let prepared = T::prepare(&lanes);
        let mut nearest = f64::INFINITY;
        for (_, v) in self.triangles.iter().enumerate().filter(|(i, _)| visit(*i)) {
            let hit = T::test(&lanes, &prepared, *v, L::constant(f64::INFINITY));
            let bits = (hit.mask & hit.t.gt(L::zero())).bits();
            for lane in (0..L::WIDTH).filter(|lane| bits >> lane & 1 != 0) {
                nearest = nearest.min(hit.t.get(lane).to_f64());
            }
        }
        nearest
    }

    /// The same behind culled boxes.
    fn nearest_culled<T: TriangleTest>(&self, ray: &RayLanes<L::Scalar>) -> f64 {
        let f32s = |v: Vec3<L::Scalar>| Vec3::splat(v.get(0).map(Real::to_f32));
        let cull = CullRay::new(f32s(ray.origin), f32s(ray.direction), self.scale);
        self.nearest::<T>(ray, |i| {
            let (lo, hi) = (Vec3::splat(self.boxes[i].min), Vec3::splat(self.boxes[i].max));
            let (enter, leave) = cull.interval_any(lo, hi, 0.0, f32::INFINITY);
            enter <= leave
        })
    }
}

/// A vertex, a point on an edge or a point on a face, as weights.
fn aim(dice: &mut Dice) -> [f64; 3] {
    let (a, b) = (dice.unit(), dice.unit());
    [[1.0, 0.0, 0.0], [a, 1.0 - a, 0.0], [a * b, a * (1.0 - b), 1.0 - a]][dice.below(3)]
}

/// Rays from inside that no triangle stops, of `count`; asserts that culling changes nothing.
fn leaks<T: TriangleTest, L: Lane>(mesh: &Mesh, count: usize, dice: &mut Dice) -> usize {
    let mut leaks = 0;
    for _ in 0..20 {
        let reach = [0.0, 1.0, 30.0][dice.below(3)];
        let (points, center, size) = mesh.placed(dice, reach);
        let packets = Packets::<L>::new(mesh, &points);
        for _ in 0..count / 20 {
            let offset = dice.point().map(|x| 0.2 * size * x);
            let origin: [L::Scalar; 3] = (center + Vec3::splat(offset)).get(0).map(L::Scalar::from_f64);
            let (t, w) = (mesh.triangles[dice.below(mesh.triangles.len())], aim(dice));
            let direction = std::array::from_fn(|k| {
                let target: f64 = (0..3).map(|i| w[i] * f64::from(points[t[i]][k])).sum();
                L::Scalar::from_f64(target) - origin[k]
            });
            let r = ray(origin, direction);
            let nearest = packets.nearest_culled::<T>(&r);
            assert_eq!(nearest, packets.nearest::<T>(&r, |_| true), "culling changed {r:?}");
            leaks += usize::from(nearest == f64::INFINITY);
        }
    }
    leaks
}

#[test]
fn no_closed_mesh_leaks_in_the_watertight_tier() {
    let mut dice = Dice(21);
    let meshes =
        [(tetrahedron(), 100_000), (cube(), 100_000), (icosphere(3), 80_000), (icosphere(4), 20_000)];
    for (mesh, count) in meshes {
        assert_eq!(leaks::<Woop, f32x8>(&mesh, count, &mut dice), 0, "{} triangles", mesh.triangles.len());
    }
}

#[test]
fn no_closed_mesh_leaks_in_the_exact_tier() {
    let mut dice = Dice(22);
    for (mesh, count) in [(cube(), 40_000), (icosphere(3), 20_000)] {
        assert_eq!(
            leaks::<ExactVolumes, f64x8>(&mesh, count, &mut dice),
            0,
            "{} triangles",
            mesh.triangles.len()
        );
    }
}

/// The test of leaks can fail: it finds those of a test that decides edges triangle by triangle.
#[test]
fn the_leaks_of_the_fast_tier_are_found() {
    let mut dice = Dice(23);
    let mesh = icosphere(3);
    let leaks = fast_leaks(&mesh, 20_000, &mut dice);
    println!("fast: {leaks} leaks of 20000");
    assert!(leaks > 0, "{leaks}");
}

fn fast_leaks(mesh: &Mesh, count: usize, dice: &mut Dice) -> usize {
    let points: Vec<[f32; 3]> = mesh.points.iter().map(|p| p.map(|x| x as f32)).collect();
    let packets = Packets::<f32x8>::new(mesh, &points);
    (0..count)
        .filter(|_| {
            let origin = dice.point().map(|x| 0.2 * x as f32);
            let p = points[dice.below(points.len())];
            let r = ray(origin, std::array::from_fn(|k| p[k] - origin[k]));
            packets.nearest::<FilteredVolumes>(&r, |_| true) == f64::INFINITY
        })
        .count()
}

/// What is left behind for certain is not solved for, and would have been no hit: from points on triangles and beside
/// them, along them and away from them, whatever their shape.
#[test]
fn triangles_left_behind_would_not_have_been_hit() {
    let mut dice = Dice(91);
    let (mut left, mut ahead) = (0, 0);
    for n in 0..300_000 {
        let (r, mut v) = random_case(&mut dice);
        if n % 2 == 0 {
            v = hard_triangle(n / 2 % KINDS, &mut dice).map(Vec3::splat);
        }
        let aside = [0.0, dice.magnitude(-9.0, -1.0)][dice.below(2)] as f32;
        let weights = [dice.between(-0.1, 1.0) as f32, dice.between(-0.1, 1.0) as f32];
        let on = v[0] + (v[1] - v[0]) * weights[0] + (v[2] - v[0]) * weights[1];
        let direction = match dice.below(3) {
            0 => r.direction,
            1 => (v[1] - v[0]) * weights[1] + (v[2] - v[1]) * weights[0] + r.direction * aside,
            _ => Vec3::splat(dice.heading().map(|x| x as f32)),
        };
        let origin = [r.origin, on, on + r.direction * aside][dice.below(3)];
        let r = RayLanes { origin, direction, t_min: 0.0, ..r };
        let prepared = Woop::prepare(&r);
        let hit = Woop::test(&r, &prepared, v, f32::INFINITY);
        let is_ahead = hit.mask && hit.t > 0.0;
        let seen = Woop::glimpse(&r, &prepared, v).expect("glimpses");
        if Woop::is_left(&r, &seen, v.map(|p| p.get(0))) {
            left += 1;
            assert!(!is_ahead, "{hit:?}: {r:?} {v:?}");
        }
        ahead += usize::from(is_ahead);
    }
    assert!(left > 10_000 && ahead > 10_000, "{left} {ahead}");
}
