//! The plain clip, and the slips of slab tests: parallel rays, flat boxes, NaN.

use super::{CullRay, OwnBox, oracle};
use crate::intersect::testing::dice::Dice;
use crate::intersect::testing::ray;
use crate::math::{Lane, Mask, Vec3};

fn cull_meets(origin: [f32; 3], direction: [f32; 3], lo: [f32; 3], hi: [f32; 3]) -> bool {
    let scale = lo.iter().chain(&hi).fold(0.0, |m: f32, x| m.max(x.abs()));
    let cull = CullRay::new(Vec3::splat(origin), Vec3::splat(direction), scale);
    let (enter, leave) = cull.interval_any(Vec3::splat(lo), Vec3::splat(hi), 0.0, f32::INFINITY);
    enter <= leave
}

fn own_meets<L: Lane>(origin: [f32; 3], direction: [f32; 3], lo: [f32; 3], hi: [f32; 3]) -> bool {
    let own = OwnBox::<L>::new(Vec3::splat_f32(origin), Vec3::splat_f32(direction));
    let (first, last) = own.interval(Vec3::splat_f32(lo), Vec3::splat_f32(hi));
    (first.le(last) & last.ge(L::zero())).any()
}

fn all_meet(origin: [f32; 3], direction: [f32; 3], lo: [f32; 3], hi: [f32; 3]) -> [bool; 3] {
    [
        cull_meets(origin, direction, lo, hi),
        own_meets::<f32>(origin, direction, lo, hi),
        own_meets::<f64>(origin, direction, lo, hi),
    ]
}

/// Slip: flat boxes of axis-parallel triangles give `0 * infinity` for rays that run in their plane.
#[test]
fn a_flat_box_is_met_by_rays_across_it_and_in_its_plane() {
    let (lo, hi) = ([-1.0, 0.0, -1.0], [1.0, 0.0, 1.0]);
    assert_eq!(all_meet([0.0, 5.0, 0.0], [0.0, -1.0, 0.0], lo, hi), [true; 3], "across");
    for (origin, direction) in [([-5.0, 0.0, 0.0], [1.0, 0.0, 0.0]), ([-5.0, -0.0, -5.0], [1.0, -0.0, 1.0])] {
        assert_eq!(all_meet(origin, direction, lo, hi), [true; 3], "in the plane, {direction:?}");
    }
    assert_eq!(all_meet([-5.0, 0.01, 0.0], [1.0, 0.0, 0.0], lo, hi), [false; 3], "beside the plane");
}

#[test]
fn a_ray_in_the_plane_of_a_face_or_along_an_edge_meets() {
    let (lo, hi) = ([-1.0; 3], [1.0; 3]);
    for direction in [[0.0, 0.0, 1.0], [-0.0, -0.0, 1.0], [0.0, -0.0, 1.0]] {
        assert_eq!(all_meet([1.0, 0.0, -3.0], direction, lo, hi), [true; 3], "face");
        assert_eq!(all_meet([-1.0, 1.0, -3.0], direction, lo, hi), [true; 3], "edge");
        assert_eq!(all_meet([1.001, 0.0, -3.0], direction, lo, hi), [false; 3], "outside");
    }
}

#[test]
fn behind_beside_and_nan_are_culled() {
    let (lo, hi) = ([-1.0; 3], [1.0; 3]);
    assert_eq!(all_meet([0.0, 0.0, 3.0], [0.0, 0.0, 1.0], lo, hi), [false; 3], "behind");
    assert_eq!(all_meet([0.0, 3.0, -3.0], [0.0, 0.0, 1.0], lo, hi), [false; 3], "beside");
    let nan = [f32::NAN; 3];
    assert!(!own_meets::<f32>([0.0; 3], [0.0, 0.0, 1.0], nan, nan), "padding");
}

/// The slab tests are tight as well as safe: they meet no box that the plain clip misses by 1e-4 of the scene.
#[test]
fn what_the_plain_clip_misses_clearly_is_culled() {
    let mut dice = Dice(51);
    let mut missed = 0;
    for _ in 0..100_000 {
        let (a, b) = (dice.point(), dice.point());
        let lo: [f64; 3] = std::array::from_fn(|k| a[k].min(b[k]));
        let hi: [f64; 3] = std::array::from_fn(|k| a[k].max(b[k]));
        let (origin, aim) = (dice.point().map(|x| 3.0 * x), dice.point());
        let mut direction: [f64; 3] = std::array::from_fn(|k| aim[k] - origin[k]);
        if dice.below(3) == 0 {
            direction[dice.below(3)] = 0.0;
        }
        let grown = Vec3::splat([1e-4; 3]);
        let clip = oracle::clip(&ray(origin, direction), Vec3::splat(lo) - grown, Vec3::splat(hi) + grown);
        if clip.is_none_or(|(_, last)| last < -1e-3) {
            missed += 1;
            let f = |p: [f64; 3]| p.map(|x| x as f32);
            assert_eq!(
                all_meet(f(origin), f(direction), f(lo), f(hi)),
                [false; 3],
                "{origin:?} {direction:?}"
            );
        }
    }
    assert!(missed > 20_000 && missed < 95_000, "{missed}");
}
