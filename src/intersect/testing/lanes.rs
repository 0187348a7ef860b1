//! One battery for every kernel and width: each of eight lanes gives the bits that the scalar gives alone.

use proptest::prelude::*;
use wide::{f32x8, f64x8};

use crate::intersect::aabb::{CullRay, OwnBox};
use crate::intersect::curved::{Direct, Widened};
use crate::intersect::triangle::{ExactVolumes, FilteredVolumes, MollerTrumbore, Woop};
use crate::intersect::{Curved, LaneHit, RayLanes, TriangleTest, cylinder, plane, sphere};
use crate::math::{Lane, Mask, Real, Vec3};

/// Eight numbers for the ray, nine for the primitive.
const NUMBERS: usize = 17;

/// A kernel as a function of numbers: where its results count, and three of them.
trait Kernel {
    fn run<L: Lane>(ray: &RayLanes<L>, p: [Vec3<L>; 3]) -> (L::Mask, [L; 3]);
}

fn parts<L: Lane>(hit: LaneHit<L>) -> (L::Mask, [L; 3]) {
    (hit.mask, [hit.t, hit.u, hit.v])
}

impl<T: TriangleTest> Kernel for T {
    fn run<L: Lane>(ray: &RayLanes<L>, p: [Vec3<L>; 3]) -> (L::Mask, [L; 3]) {
        parts(T::test(ray, &T::prepare(ray), p, ray.t_max))
    }
}

struct Sphere<C>(C);
impl<C: Curved> Kernel for Sphere<C> {
    fn run<L: Lane>(ray: &RayLanes<L>, p: [Vec3<L>; 3]) -> (L::Mask, [L; 3]) {
        parts(C::sphere(ray, &sphere::Lanes { center: p[0], radius: p[1].x.abs() }))
    }
}

struct Cylinder<C>(C);
impl<C: Curved> Kernel for Cylinder<C> {
    fn run<L: Lane>(ray: &RayLanes<L>, p: [Vec3<L>; 3]) -> (L::Mask, [L; 3]) {
        let (radius, capped) = (p[2].x.abs(), p[2].y.lt(L::zero()));
        parts(C::cylinder(ray, &cylinder::Lanes { from: p[0], to: p[1], radius, capped }))
    }
}

struct Plane;
impl Kernel for Plane {
    fn run<L: Lane>(ray: &RayLanes<L>, p: [Vec3<L>; 3]) -> (L::Mask, [L; 3]) {
        parts(plane::solve(ray, &plane::Lanes { point: p[0], normal: p[1] }))
    }
}

struct Own;
impl Kernel for Own {
    fn run<L: Lane>(ray: &RayLanes<L>, p: [Vec3<L>; 3]) -> (L::Mask, [L; 3]) {
        let (first, last) = OwnBox::new(ray.origin, ray.direction).interval(p[0].min(p[1]), p[0].max(p[1]));
        (L::Mask::splat(true), [first, last, last])
    }
}

struct Cull;
impl Kernel for Cull {
    fn run<L: Lane>(ray: &RayLanes<L>, p: [Vec3<L>; 3]) -> (L::Mask, [L; 3]) {
        let cull = CullRay::new(ray.origin, ray.direction, p[2].x.abs());
        let (lo, hi) = (p[0].min(p[1]), p[0].max(p[1]));
        let (first, last) = cull.interval_any(lo, hi, ray.t_min, ray.t_max);
        (L::Mask::splat(true), [first, last, last])
    }
}

fn run<K: Kernel, L: Lane>(n: [L; NUMBERS]) -> (L::Mask, [L; 3]) {
    let v = |i: usize| Vec3::new(n[i], n[i + 1], n[i + 2]);
    let ray = RayLanes { origin: v(0), direction: v(3), t_min: n[6], t_max: n[7] };
    K::run(&ray, [v(8), v(11), v(14)])
}

fn lanes_equal_scalar<K: Kernel, L: Lane>(cases: &[[f64; NUMBERS]; 8]) {
    let number = |i: usize, k: usize| L::Scalar::from_f64(cases[i][k]);
    let (mask, together) = run::<K, L>(std::array::from_fn(|k| L::from_fn(|i| number(i, k))));
    for i in 0..L::WIDTH {
        let (hit, alone) = run::<K, L::Scalar>(std::array::from_fn(|k| number(i, k)));
        assert_eq!(mask.bits() >> i & 1 != 0, hit, "lane {i} of {cases:?}");
        for (a, b) in together.map(|x| x.get(i).to_f64()).into_iter().zip(alone.map(Real::to_f64)) {
            let same = a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
            assert!(same || !hit, "lane {i}: {a:e} and alone {b:e}, of {cases:?}");
        }
    }
}

fn special() -> impl Strategy<Value = f64> {
    let tiny = f64::from(f32::MIN_POSITIVE);
    let values = vec![0.0, -0.0, 1.0, -1.0, tiny / 4.0, -tiny, 1e-30, 1e20, -3e38, f64::INFINITY, f64::NAN];
    prop::sample::select(values)
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![8 => -1.0..1.0f64, 4 => (-2..3i32).prop_map(f64::from), 1 => special()]
}

/// Rays aimed at the middle of the primitive's first two points, so that a good share hits; some from odd numbers.
fn case() -> impl Strategy<Value = [f64; NUMBERS]> {
    let plain = prop::array::uniform17(number());
    let aimed = (prop::array::uniform17(-1.0..1.0f64), 0..4usize).prop_map(|(mut n, zeroed)| {
        for k in 0..3 {
            n[3 + k] = if k == zeroed { 0.0 } else { (n[8 + k] + n[11 + k]) * 0.5 - n[k] };
        }
        (n[6], n[7]) = (0.0, f64::INFINITY);
        n
    });
    let padding = prop::array::uniform17(-1.0..1.0f64).prop_map(|mut n| {
        n[8..].fill(f64::NAN);
        n
    });
    prop_oneof![4 => plain, 6 => aimed, 1 => padding]
}

macro_rules! battery {
    ($($name:ident: $kernel:ty),* $(,)?) => {
        $(mod $name {
            use super::*;
            proptest! {
                #![proptest_config(ProptestConfig::with_cases(2000))]
                #[test]
                fn f32_lanes_equal_the_scalar(cases in prop::array::uniform8(case())) {
                    lanes_equal_scalar::<$kernel, f32x8>(&cases);
                }
                #[test]
                fn f64_lanes_equal_the_scalar(cases in prop::array::uniform8(case())) {
                    lanes_equal_scalar::<$kernel, f64x8>(&cases);
                }
            }
        })*
    };
}
battery!(
    moller_trumbore: MollerTrumbore,
    filtered_volumes: FilteredVolumes,
    woop: Woop,
    exact_volumes: ExactVolumes,
    direct_sphere: Sphere<Direct>,
    filtered_sphere: Sphere<Widened>,
    direct_cylinder: Cylinder<Direct>,
    filtered_cylinder: Cylinder<Widened>,
    infinite_plane: Plane,
    own_box: Own,
    cull_ray: Cull,
);
