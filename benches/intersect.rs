//! Tests a second of every kernel: one ray at a time and eight, per tier. Names follow the folders of `src`.
//!
//! About half of the inputs hit. Before a kernel is timed, its hits are counted against the plain version beside it.

use criterion::{
    BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main, measurement::WallTime,
};
use octray::intersect::aabb::{self, CullRay, OwnBox};
use octray::intersect::{
    Curved, Exact, Fast, LaneHit, RayLanes, Tier, TriangleTest, Watertight, cylinder, sphere, triangle,
};
use octray::math::{Lane, Mask, Real, Vec3};
use std::hint::black_box;

/// Rays, and as many primitives; every ray meets every primitive once.
const COUNT: usize = 256;
/// Numbers a case: ray origin and direction, three points of the primitive.
const NUMBERS: usize = 15;

type Case = [f32; NUMBERS];

/// **Source:** Marsaglia, Xorshift RNGs, 2003.
fn uniform(state: &mut u64) -> f32 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (*state >> 40) as f32 / (1u64 << 23) as f32 - 1.0
}

/// Three random points to the points (or corners, or radius) of a primitive that about half of the rays hit.
type Shape = fn([[f32; 3]; 3]) -> [[f32; 3]; 3];

fn triangle_around([a, b, c]: [[f32; 3]; 3]) -> [[f32; 3]; 3] {
    let third = std::array::from_fn(|k| 0.5 * c[k] - a[k] - b[k]);
    [a, b, third].map(|p| p.map(|x| 1.5 * x))
}

fn box_around([a, _, _]: [[f32; 3]; 3]) -> [[f32; 3]; 3] {
    [a.map(|x| 0.5 * x - 0.375), a.map(|x| 0.5 * x + 0.375), a]
}

fn ball_around([a, _, _]: [[f32; 3]; 3]) -> [[f32; 3]; 3] {
    [a, [0.8; 3], a]
}

fn pipe_around([a, b, _]: [[f32; 3]; 3]) -> [[f32; 3]; 3] {
    [a, b, [0.5; 3]]
}

/// Primitives around the origin, and rays from 3 away aimed at its neighbourhood.
fn cases(shape: Shape) -> Vec<Case> {
    let mut state = 0x853c_49e6_748f_ea9b;
    let case = |_| {
        let mut point = || -> [f32; 3] { std::array::from_fn(|_| uniform(&mut state)) };
        let ([x, y, z], aim, points) = (point(), point(), shape([point(), point(), point()]));
        let origin = [x, y, z - 3.0];
        let direction = std::array::from_fn(|k| 0.5 * aim[k] - origin[k]);
        let all = [origin, direction, points[0], points[1], points[2]];
        std::array::from_fn(|i| all[i / 3][i % 3])
    };
    (0..COUNT).map(case).collect()
}

/// A kernel over lanes, and its plain version: whether a ray without bounds hits.
trait Kernel {
    type Prepared<L: Lane>: Copy;
    fn prepare<L: Lane>(ray: &RayLanes<L>) -> Self::Prepared<L>;
    fn meets<L: Lane>(ray: &RayLanes<L>, prepared: &Self::Prepared<L>, p: [Vec3<L>; 3]) -> (L::Mask, L);
    fn oracle(ray: &RayLanes<f64>, p: [Vec3<f64>; 3]) -> bool;
}

fn seen<L: Lane>(hit: LaneHit<L>) -> (L::Mask, L) {
    (hit.mask & hit.t.gt(L::zero()), hit.t)
}

struct Triangle<T>(T);
impl<T: TriangleTest> Kernel for Triangle<T> {
    type Prepared<L: Lane> = T::Prepared<L>;
    #[inline(always)]
    fn prepare<L: Lane>(ray: &RayLanes<L>) -> T::Prepared<L> {
        T::prepare(ray)
    }
    #[inline(always)]
    fn meets<L: Lane>(ray: &RayLanes<L>, prepared: &T::Prepared<L>, p: [Vec3<L>; 3]) -> (L::Mask, L) {
        seen(T::test(ray, prepared, p, ray.t_max))
    }
    fn oracle(ray: &RayLanes<f64>, p: [Vec3<f64>; 3]) -> bool {
        triangle::oracle::meet(ray, p).is_some_and(|m| m.t > 0.0)
    }
}

struct Sphere<C>(C);
impl<C: Curved> Kernel for Sphere<C> {
    type Prepared<L: Lane> = ();
    fn prepare<L: Lane>(_: &RayLanes<L>) {}
    #[inline(always)]
    fn meets<L: Lane>(ray: &RayLanes<L>, _: &(), p: [Vec3<L>; 3]) -> (L::Mask, L) {
        seen(C::sphere(ray, &sphere::Lanes { center: p[0], radius: p[1].x }))
    }
    fn oracle(ray: &RayLanes<f64>, p: [Vec3<f64>; 3]) -> bool {
        sphere::oracle::enter_and_leave(ray, p[0], p[1].x).is_some_and(|(_, last)| last > 0.0)
    }
}

struct Cylinder<C>(C);
impl<C: Curved> Kernel for Cylinder<C> {
    type Prepared<L: Lane> = ();
    fn prepare<L: Lane>(_: &RayLanes<L>) {}
    #[inline(always)]
    fn meets<L: Lane>(ray: &RayLanes<L>, _: &(), p: [Vec3<L>; 3]) -> (L::Mask, L) {
        let (radius, capped) = (p[2].x, L::Mask::splat(true));
        seen(C::cylinder(ray, &cylinder::Lanes { from: p[0], to: p[1], radius, capped }))
    }
    fn oracle(ray: &RayLanes<f64>, p: [Vec3<f64>; 3]) -> bool {
        let c = cylinder::oracle::Cylinder { from: p[0], to: p[1], radius: p[2].x, capped: true };
        cylinder::oracle::meetings(ray, &c).iter().any(|m| m.0 > 0.0)
    }
}

/// The plain clip of a box given by two corners.
fn clipped(ray: &RayLanes<f64>, p: [Vec3<f64>; 3]) -> bool {
    aabb::oracle::clip(ray, p[0], p[1]).is_some_and(|(_, last)| last > 0.0)
}

struct Cull;
impl Kernel for Cull {
    type Prepared<L: Lane> = CullRay<L>;
    #[inline(always)]
    fn prepare<L: Lane>(ray: &RayLanes<L>) -> CullRay<L> {
        CullRay::new(ray.origin, ray.direction, L::constant(2.0))
    }
    #[inline(always)]
    fn meets<L: Lane>(ray: &RayLanes<L>, cull: &CullRay<L>, p: [Vec3<L>; 3]) -> (L::Mask, L) {
        let (first, last) = cull.interval_any(p[0], p[1], ray.t_min, ray.t_max);
        (first.le(last), first)
    }
    fn oracle(ray: &RayLanes<f64>, p: [Vec3<f64>; 3]) -> bool {
        clipped(ray, p)
    }
}

struct Own;
impl Kernel for Own {
    type Prepared<L: Lane> = OwnBox<L>;
    #[inline(always)]
    fn prepare<L: Lane>(ray: &RayLanes<L>) -> OwnBox<L> {
        OwnBox::new(ray.origin, ray.direction)
    }
    #[inline(always)]
    fn meets<L: Lane>(ray: &RayLanes<L>, own: &OwnBox<L>, p: [Vec3<L>; 3]) -> (L::Mask, L) {
        let (first, last) = own.interval(p[0], p[1]);
        (first.le(last) & last.ge(ray.t_min), first)
    }
    fn oracle(ray: &RayLanes<f64>, p: [Vec3<f64>; 3]) -> bool {
        clipped(ray, p)
    }
}

fn ray_and_points<L: Lane>(cases: &[Case]) -> (RayLanes<L>, [Vec3<L>; 3]) {
    let number = |k: usize| L::from_fn(|i| L::Scalar::from_f32(cases[i][k]));
    let v = |k: usize| Vec3::new(number(k), number(k + 1), number(k + 2));
    let (t_min, t_max) = (L::zero(), L::constant(f64::INFINITY));
    (RayLanes { origin: v(0), direction: v(3), t_min, t_max }, [v(6), v(9), v(12)])
}

/// Every ray against all primitives, which stand in columns: hits, and a sum that keeps `t` alive.
fn all_pairs<K: Kernel, L: Lane>(rays: &[RayLanes<L>], primitives: &[[Vec3<L>; 3]]) -> (u32, L) {
    let (mut hits, mut sum) = (0, L::zero());
    for ray in rays {
        let prepared = K::prepare(ray);
        for p in primitives {
            let (mask, t) = K::meets(ray, &prepared, *p);
            hits += mask.bits().count_ones();
            sum += L::select(mask, t, L::zero());
        }
    }
    (hits, sum)
}

/// Panics if the hits differ from those of the plain version by more than what edges may decide, or are not about half.
fn check<K: Kernel>(name: &str, cases: &[Case], hits: u32) {
    let plain: Vec<_> = cases.iter().map(|c| ray_and_points::<f64>(&[*c])).collect();
    let expected = plain.iter().flat_map(|(r, _)| plain.iter().map(move |(_, p)| K::oracle(r, *p)));
    let (expected, pairs) = (expected.filter(|hit| *hit).count(), COUNT * COUNT);
    let share = expected as f64 / pairs as f64;
    assert!((0.3..0.7).contains(&share), "{name}: {share} of the tests hit");
    let differ = (f64::from(hits) - expected as f64).abs();
    assert!(differ <= 1e-4 * pairs as f64, "{name}: {hits} hits, the plain version {expected}");
}

fn bench<K: Kernel, L: Lane>(group: &mut BenchmarkGroup<WallTime>, name: &str, cases: &[Case]) {
    let rays: Vec<_> =
        cases.iter().map(|c| RayLanes::<L>::splat(&ray_and_points::<L::Scalar>(&[*c]).0)).collect();
    let primitives: Vec<_> = cases.chunks(L::WIDTH).map(|c| ray_and_points::<L>(c).1).collect();
    let (hits, _) = all_pairs::<K, L>(&rays, &primitives);
    check::<K>(name, cases, hits);
    group.throughput(Throughput::Elements((COUNT * COUNT) as u64));
    group.bench_function(name, |b| b.iter(|| all_pairs::<K, L>(black_box(&rays), black_box(&primitives))));
}

/// One kernel of a tier, one primitive at a time and eight.
fn both_widths<K: Kernel, T: Tier>(group: &mut BenchmarkGroup<WallTime>, kernel: &str, cases: &[Case]) {
    let real = std::any::type_name::<T::Real>();
    bench::<K, T::Real>(group, &format!("{kernel}/{real}"), cases);
    bench::<K, T::Wide>(group, &format!("{kernel}/{real}x8"), cases);
}

fn kernels(c: &mut Criterion) {
    let [boxes, triangles, balls, pipes] =
        [box_around, triangle_around, ball_around, pipe_around as Shape].map(cases);
    let mut group = c.benchmark_group("intersect");
    let g = &mut group;
    both_widths::<Cull, Fast>(g, "aabb/cull", &boxes);
    both_widths::<Own, Watertight>(g, "aabb/own", &boxes);
    both_widths::<Own, Exact>(g, "aabb/own", &boxes);
    both_widths::<Triangle<<Fast as Tier>::Triangle>, Fast>(g, "triangle/moller_trumbore", &triangles);
    both_widths::<Triangle<<Watertight as Tier>::Triangle>, Watertight>(g, "triangle/woop", &triangles);
    both_widths::<Triangle<<Exact as Tier>::Triangle>, Exact>(g, "triangle/woop", &triangles);
    both_widths::<Sphere<<Fast as Tier>::Curved>, Fast>(g, "sphere/direct", &balls);
    both_widths::<Sphere<<Watertight as Tier>::Curved>, Watertight>(g, "sphere/filtered", &balls);
    both_widths::<Sphere<<Exact as Tier>::Curved>, Exact>(g, "sphere/direct", &balls);
    both_widths::<Cylinder<<Fast as Tier>::Curved>, Fast>(g, "cylinder/direct", &pipes);
    both_widths::<Cylinder<<Watertight as Tier>::Curved>, Watertight>(g, "cylinder/filtered", &pipes);
    both_widths::<Cylinder<<Exact as Tier>::Curved>, Exact>(g, "cylinder/direct", &pipes);
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .warm_up_time(std::time::Duration::from_millis(300))
        .measurement_time(std::time::Duration::from_millis(1000));
    targets = kernels
}
criterion_main!(benches);
