//! Primitive tests on any bit patterns: eight lanes give the bits of one, and moderate numbers agree with the oracles; the
//! exact tier decides as rational arithmetic does.
#![no_main]

mod exact_tier;

use libfuzzer_sys::arbitrary::{self, Arbitrary};
use libfuzzer_sys::fuzz_target;
use octray::intersect::aabb::{self, CullRay, OwnBox};
use octray::intersect::triangle::{ExactVolumes, FilteredVolumes, MollerTrumbore, Woop};
use octray::intersect::{Curved, Exact, Fast, LaneHit, RayLanes, Tier, TriangleTest, Watertight};
use octray::intersect::{cylinder, sphere, triangle};
use octray::math::{Lane, Mask, Real, Vec3};

/// Any bits, a grid that makes things touch, or something in between.
#[derive(Arbitrary, Clone, Copy, Debug)]
enum Number {
    Bits(u32),
    Grid(i8),
    Between(i16),
}

impl Number {
    fn value(self) -> f32 {
        match self {
            Number::Bits(bits) => f32::from_bits(bits),
            Number::Grid(i) => f32::from(i) * 0.25,
            Number::Between(i) => f32::from(i) * 1e-3,
        }
    }
}

/// Origin, direction, range of a ray; three points.
type Case = [Number; 17];

#[derive(Arbitrary, Debug)]
struct Input {
    cases: [Case; 8],
}

fn ray_and_points<L: Lane>(cases: &[[f32; 17]]) -> (RayLanes<L>, [Vec3<L>; 3]) {
    let n = |k: usize| L::from_fn(|i| L::Scalar::from_f32(cases[i][k]));
    let v = |k: usize| Vec3::new(n(k), n(k + 1), n(k + 2));
    (RayLanes { origin: v(0), direction: v(3), t_min: n(6), t_max: n(7) }, [v(8), v(11), v(14)])
}

fn a_sphere<L: Lane>(p: [Vec3<L>; 3]) -> sphere::Lanes<L> {
    sphere::Lanes { center: p[0], radius: p[1].x.abs() }
}

fn a_cylinder<L: Lane>(p: [Vec3<L>; 3]) -> cylinder::Lanes<L> {
    cylinder::Lanes { from: p[0], to: p[1], radius: p[2].x.abs(), capped: p[2].y.lt(L::zero()) }
}

/// What every kernel says, as masks and numbers.
fn run<L: Lane, C: Curved>(cases: &[[f32; 17]]) -> [LaneHit<L>; 8] {
    let (ray, p) = ray_and_points::<L>(cases);
    let pair = |(t, u)| LaneHit { mask: L::Mask::splat(true), t, u, v: L::zero() };
    let (lo, hi) = (p[0].min(p[1]), p[0].max(p[1]));
    let cull = CullRay::new(ray.origin, ray.direction, p[2].x.abs());
    [
        Woop::test(&ray, &Woop::prepare(&ray), p, ray.t_max),
        MollerTrumbore::test(&ray, &(), p, ray.t_max),
        FilteredVolumes::test(&ray, &FilteredVolumes::prepare(&ray), p, ray.t_max),
        ExactVolumes::test(&ray, &ExactVolumes::prepare(&ray), p, ray.t_max),
        C::sphere(&ray, &a_sphere(p)),
        C::cylinder(&ray, &a_cylinder(p)),
        pair(OwnBox::new(ray.origin, ray.direction).interval(lo, hi)),
        pair(cull.interval_any(lo, hi, ray.t_min, ray.t_max)),
    ]
}

fn lanes_equal_scalar<T: Tier>(cases: &[[f32; 17]; 8]) {
    let together = run::<T::Wide, T::Curved>(cases);
    for i in 0..8 {
        let alone = run::<T::Real, T::Curved>(&cases[i..]);
        for (kernel, (wide, one)) in together.iter().zip(alone).enumerate() {
            assert_eq!(wide.mask.bits() >> i & 1 != 0, one.mask, "kernel {kernel}, lane {i}");
            let pairs = [(wide.t, one.t), (wide.u, one.u), (wide.v, one.v)];
            for (a, b) in pairs.map(|(a, b)| (a.get(i).to_f64(), b.to_f64())) {
                let same = a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan();
                assert!(same || !one.mask, "kernel {kernel}, lane {i}: {a:e}, alone {b:e}");
            }
        }
    }
}

/// A ray without bounds and three points, if no number is far from 1 and the direction has a length.
fn moderate(case: &[f32; 17]) -> Option<(RayLanes<f32>, [Vec3<f32>; 3])> {
    let (ray, points) = ray_and_points::<f32>(std::slice::from_ref(case));
    let in_range = case.iter().all(|x| x.abs() < 40.0) && ray.direction.length() > 0.1;
    let line = RayLanes { t_min: f32::NEG_INFINITY, t_max: f32::INFINITY, ..ray };
    in_range.then_some((line, points))
}

/// What of a scaled shape is certain: the smaller one is hit, or the larger one is missed.
fn certain(smaller: bool, larger: bool) -> Option<bool> {
    (smaller == larger).then_some(smaller)
}

const MARGIN: f64 = 0.01;

fn check_triangle(ray: &RayLanes<f32>, p: [Vec3<f32>; 3]) {
    let corners = p.map(Vec3::widen);
    let edges = [corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]];
    let normal = edges[0].cross(edges[1]);
    let longest = edges.map(|e| e.length()).into_iter().fold(0.0, f64::max);
    let (d, area) = (ray.direction.widen(), normal.length());
    // Thin triangles and those seen edge-on leave no margin for `f32`.
    if area < 0.2 * longest || normal.dot(d).abs() < 0.2 * area * d.length() {
        return;
    }
    let center = (corners[0] + corners[1] + corners[2]) * (1.0 / 3.0);
    let meet =
        |scale: f64| triangle::oracle::meet(&ray.widen(), corners.map(|c| center + (c - center) * scale));
    let hit = Woop::test(ray, &Woop::prepare(ray), p, ray.t_max);
    if let Some(expected) = certain(meet(1.0 - MARGIN).is_some(), meet(1.0 + MARGIN).is_some()) {
        assert_eq!(hit.mask, expected, "triangle");
    }
    if let (true, Some(meeting)) = (hit.mask, meet(1.0)) {
        let off = (f64::from(hit.t) - meeting.t).abs() * d.length();
        assert!(off < 1e-4, "triangle at {} for {}", hit.t, meeting.t);
    }
}

fn check_sphere(ray: &RayLanes<f32>, s: &sphere::Lanes<f32>) {
    let radius = f64::from(s.radius);
    if radius < 0.05 {
        return;
    }
    let meet = |scale: f64| sphere::oracle::enter_and_leave(&ray.widen(), s.center.widen(), radius * scale);
    let hit = <Watertight as Tier>::Curved::sphere(ray, s);
    if let Some(expected) = certain(meet(1.0 - MARGIN).is_some(), meet(1.0 + MARGIN).is_some()) {
        assert_eq!(hit.mask, expected, "sphere");
        if let Some((enter, _)) = meet(1.0) {
            let off = (f64::from(hit.t) - enter).abs() * f64::from(ray.direction.length());
            assert!(off < 1e-4, "sphere at {} for {enter}", hit.t);
        }
    }
}

fn check_cylinder(ray: &RayLanes<f32>, c: &cylinder::Lanes<f32>) {
    let (from, to, radius) = (c.from.widen(), c.to.widen(), f64::from(c.radius));
    if radius < 0.05 || (to - from).length() < 0.05 {
        return;
    }
    let is_met = |by: f64| {
        let (inset, radius) = ((to - from) * by, radius * (1.0 - by));
        let shape = cylinder::oracle::Cylinder { from: from + inset, to: to - inset, radius, capped: true };
        !cylinder::oracle::meetings(&ray.widen(), &shape).is_empty()
    };
    let hit = <Watertight as Tier>::Curved::cylinder(ray, &cylinder::Lanes { capped: true, ..*c });
    if let Some(expected) = certain(is_met(MARGIN), is_met(-MARGIN)) {
        assert_eq!(hit.mask, expected, "cylinder");
    }
}

/// Culling keeps every part of a box that the line really crosses.
fn check_box(ray: &RayLanes<f32>, p: [Vec3<f32>; 3]) {
    let (lo, hi) = (p[0].min(p[1]), p[0].max(p[1]));
    let scale = lo.abs().max(hi.abs()).max_component();
    let (enter, leave) =
        CullRay::new(ray.origin, ray.direction, scale).interval_any(lo, hi, 0.0, f32::INFINITY);
    if let Some((first, last)) = aabb::oracle::clip(&ray.widen(), lo.widen(), hi.widen())
        && last >= 0.0
    {
        // Steps between numbers below the least normal one are coarser than any bound.
        let step = f64::from(f32::MIN_POSITIVE);
        let holds = f64::from(enter) <= first.max(0.0) + step && f64::from(leave) >= last - step;
        assert!(
            holds,
            "{enter:e} to {leave:e} does not hold {first:e} to {last:e}: {ray:?}, {lo:?} to {hi:?}"
        );
    }
}

/// Triangles of any magnitude in the domain, curved surfaces of moderate ones.
fn check_exact(case: &[f32; 17]) {
    let (ray, points) = ray_and_points::<f32>(std::slice::from_ref(case));
    let Some(exact) = exact_tier::Case::new(case, &ray, points) else { return };
    exact.check_triangle();
    let (sphere, cylinder) = (a_sphere(points), a_cylinder(points));
    if moderate(case).is_some() && sphere.radius > 0.05 {
        exact.check_sphere(&sphere);
    }
    if moderate(case).is_some() && cylinder.radius > 0.05 && (cylinder.to - cylinder.from).length() > 0.05 {
        exact.check_cylinder(&cylinder);
    }
}

fuzz_target!(|input: Input| {
    let cases = input.cases.map(|case| case.map(Number::value));
    lanes_equal_scalar::<Fast>(&cases);
    lanes_equal_scalar::<Watertight>(&cases);
    lanes_equal_scalar::<Exact>(&cases);
    cases.iter().for_each(check_exact);
    for (ray, points) in cases.iter().filter_map(moderate) {
        check_triangle(&ray, points);
        check_sphere(&ray, &a_sphere(points));
        check_cylinder(&ray, &a_cylinder(points));
        check_box(&ray, points);
    }
});
