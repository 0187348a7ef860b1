//! Spheres against exact arithmetic, and the cases that defeat the textbook quadratic.

use super::{Lanes, is_beyond, leaves, oracle, solve, surely_hits};
use crate::intersect::curved::Widened;
use crate::intersect::testing::dice::Dice;
use crate::intersect::testing::{exact, line, percentile, ray, t_of, ulps};
use crate::intersect::{Curved, LaneHit, RayLanes};
use crate::math::{Real, Vec3};

type Solve = fn(&RayLanes<f32>, &Lanes<f32>) -> LaneHit<f32>;

/// Rays from `away` radii, aimed within 1.2 radii of the centre.
fn seen_from(dice: &mut Dice, away: f64) -> (RayLanes<f32>, Lanes<f32>) {
    let radius = dice.magnitude(-3.0, 3.0).abs();
    let center = dice.point().map(|x| 10.0 * radius * x);
    let towards = dice.heading();
    let origin: [f64; 3] = std::array::from_fn(|k| center[k] - away * radius * towards[k]);
    let spread = dice.heading().map(|x| x * radius * 1.2);
    let direction = std::array::from_fn(|k| ((center[k] + spread[k] - origin[k]) / radius) as f32);
    let center = Vec3::splat(center.map(|x| x as f32));
    (line(origin.map(|x| x as f32), direction), Lanes { center, radius: radius as f32 })
}

/// Decisions may differ from exact arithmetic only within `margin` roundoffs (of distance and radius) of tangency.
/// Gives the 99th percentile of the error of `t` in ulps, of lines that do not graze.
fn assert_agrees(name: &str, solve: Solve, roundoff: f64, margin: f64, away: f64) -> f64 {
    let mut dice = Dice(31);
    let mut errors = Vec::new();
    for _ in 0..10_000 {
        let (r, s) = seen_from(&mut dice, away);
        let got = solve(&r, &s);
        let radius = f64::from(s.radius);
        let far = (r.origin.widen() - s.center.widen()).length();
        let slack = margin * roundoff * (far + radius);
        let meets = |radius: f64| exact::sphere(&r, s.center, radius);
        assert!(got.mask || meets(radius - slack).is_none(), "{name} misses {s:?} by {r:?}");
        assert!(!got.mask || meets(radius + slack).is_some(), "{name} invents {s:?} by {r:?}");
        if let (true, Some([near, _]), Some(_)) = (got.mask, meets(radius), meets(radius * 0.9)) {
            errors.push(ulps(got.t, near));
        }
    }
    let p99 = percentile(&mut errors, 0.99);
    println!("sphere {name} from {away} radii: {} hits, t p99 {p99} ulp", errors.len());
    p99
}

#[test]
fn the_filtered_test_agrees_with_exact_arithmetic_near_and_far() {
    for away in [1.5, 10.0, 1e4] {
        let p99 = assert_agrees("filtered", Widened::sphere::<f32>, f64::ROUNDOFF, 16.0, away);
        assert!(p99 <= 0.51, "{p99}");
    }
}

/// Slip: `b^2 - 4 a c` cancels for spheres seen from 1e4 radii.
#[test]
fn even_f32_alone_agrees_from_far_away() {
    for away in [1.5, 10.0, 1e4] {
        let p99 = assert_agrees("direct", solve::<f32>, f32::ROUNDOFF, 16.0, away);
        assert!(p99 <= 16.0, "{p99}");
    }
}

#[test]
fn the_oracle_agrees_with_exact_arithmetic() {
    let mut dice = Dice(32);
    for _ in 0..10_000 {
        let (r, s) = seen_from(&mut dice, 10.0);
        let radius = f64::from(s.radius);
        let got = oracle::enter_and_leave(&r.widen(), s.center.widen(), radius);
        let want = exact::sphere(&r, s.center, radius);
        let clear = exact::sphere(&r, s.center, radius * (1.0 - 1e-12)).is_some()
            == exact::sphere(&r, s.center, radius * (1.0 + 1e-12)).is_some();
        assert!(!clear || got.is_some() == want.is_some());
        if let (Some(got), Some(want)) = (got, want) {
            assert!((got.0 - want[0]).abs() <= 1e-6 * want[0].abs(), "{got:?} {want:?}");
        }
    }
}

/// Slip: the ground as a sphere of radius 1e6, where `f32` loses seven digits of `t`.
#[test]
fn a_ground_sphere_is_hit_where_it_is() {
    let mut dice = Dice(33);
    let ground = Lanes { center: Vec3::splat([0.0, -1e6, 0.0]), radius: 1e6f32 };
    for _ in 0..5_000 {
        let p = dice.point();
        let r = ray([p[0] as f32, 1.0, p[2] as f32], [p[0] as f32, -0.1 - p[1].abs() as f32, p[2] as f32]);
        let [near, _] = exact::sphere(&r, ground.center, 1e6).expect("looking down");
        let error = ulps(t_of(Widened::sphere(&r, &ground)).expect("the ground"), near);
        assert!(error <= 1.0, "{error} ulp of {near}: {r:?}");
    }
}

const UNIT: Lanes<f32> = Lanes { center: Vec3 { x: 0.0, y: 0.0, z: 0.0 }, radius: 1.0 };

/// `t` as the caller sees it, by both versions.
fn both(r: &RayLanes<f32>, s: &Lanes<f32>) -> [Option<f32>; 2] {
    [solve(r, s), Widened::sphere(r, s)].map(|h| t_of(h).filter(|t| r.t_min < *t && *t < r.t_max))
}

#[test]
fn from_inside_the_far_side_is_hit() {
    assert_eq!(both(&ray([0.5, 0.0, 0.0], [1.0, 0.0, 0.0]), &UNIT), [Some(0.5); 2]);
    assert_eq!(both(&ray([0.0; 3], [0.0, 2.0, 0.0]), &UNIT), [Some(0.5); 2]);
}

#[test]
fn a_tangent_ray_touches_once_and_one_beside_misses() {
    assert_eq!(both(&ray([1.0, 0.0, -3.0], [0.0, 0.0, 1.0]), &UNIT), [Some(3.0); 2]);
    assert_eq!(both(&ray([1.001, 0.0, -3.0], [0.0, 0.0, 1.0]), &UNIT), [None; 2]);
}

#[test]
fn a_ray_that_starts_where_it_touches_is_no_nan() {
    let touching = line([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    assert_eq!(both(&touching, &UNIT), [Some(0.0); 2]);
    assert_eq!(both(&RayLanes { t_min: 0.0, ..touching }, &UNIT), [None; 2]);
}

/// Found by `verify`: the ray touches where it starts, but for a millionth of a roundoff, and what rounding makes of the root there was
/// half a radius.
#[test]
fn a_ray_that_starts_where_it_nearly_touches_hits_nothing_far_away() {
    let center = [0.00061035156, 0.00030517578, -0.00061035156];
    let s = Lanes { center: Vec3::splat(center), radius: 0.00091552734f32 };
    let r = ray([0.0, 2.1204858e-19, 0.0], [-0.25, 1.0, 0.25]);
    for t in both(&r, &s).into_iter().flatten() {
        assert!(t < 1e-5, "{t}");
    }
}

#[test]
fn behind_or_at_the_ends_of_the_range_does_not_count() {
    let r = ray([0.0, 0.0, -3.0], [0.0, 0.0, 1.0]);
    assert_eq!(both(&RayLanes { t_min: 2.0, ..r }, &UNIT), [Some(4.0); 2], "t_min at the near side");
    assert_eq!(both(&RayLanes { t_min: 4.0, ..r }, &UNIT), [None; 2], "t_min at the far side");
    assert_eq!(both(&RayLanes { t_max: 2.0, ..r }, &UNIT), [None; 2], "t_max at the near side");
    assert_eq!(both(&ray([0.0, 0.0, -3.0], [0.0, 0.0, -1.0]), &UNIT), [None; 2], "behind");
}

/// A ray continued with the `t` of its first hit as `t_min` must find the second, however the first was rounded.
#[test]
fn continuing_from_the_near_side_finds_the_far_side() {
    let mut dice = Dice(34);
    for _ in 0..20_000 {
        let (r, s) = seen_from(&mut dice, 3.0);
        let Some([near, far]) = exact::sphere(&r, s.center, f64::from(s.radius) * 0.999) else { continue };
        for solve in [solve::<f32> as Solve, Widened::sphere::<f32>] {
            let first = solve(&r, &s).t;
            let second = solve(&RayLanes { t_min: first, ..r }, &s);
            let reached = f64::from(second.t) > 0.5 * (near + far);
            assert!(second.mask && reached, "{first} then {} of {near} {far}", second.t);
        }
    }
}

/// Within 1e-10 radii of tangency, from up to 1e8 radii away: hit or miss is that of exact arithmetic.
#[test]
fn the_exact_tier_decides_tangents_without_rounding() {
    let mut dice = Dice(35);
    let mut counts = [0; 3];
    for _ in 0..10_000 {
        let (_, s) = seen_from(&mut dice, 1.0);
        let s = Lanes { center: s.center.widen(), radius: f64::from(s.radius) };
        let aside = Vec3::<f64>::splat(dice.heading());
        let along = aside.cross(Vec3::splat(dice.heading())).normalize();
        let touch = s.center + aside * (s.radius * (1.0 + dice.magnitude(-16.0, -10.0)));
        let origin = touch - along * (s.radius * dice.magnitude(0.0, 8.0).abs());
        let r = line(origin.get(0), along.get(0));
        let want = exact::sphere(&r, s.center, s.radius).is_some();
        counts[usize::from(want)] += 1;
        counts[2] += usize::from(solve(&r, &s).mask != want);
        let got = Widened::sphere(&r, &s).mask;
        assert_eq!(got, want, "a tangent is decided by rounding: {s:?} by {r:?}");
    }
    assert!(counts.iter().all(|&n| n > 100), "misses, hits, and those that f64 gets wrong: {counts:?}");
}

/// A line of the exact tier past a sphere, half of them within 1e-3 to 1e-16 radii of tangency.
fn past(dice: &mut Dice) -> (RayLanes<f64>, Lanes<f64>) {
    let away = [0.0, 1.5, 1e3, 1e8][dice.below(4)];
    let (r, s) = seen_from(dice, away);
    let s = Lanes { center: s.center.widen(), radius: f64::from(s.radius) };
    if dice.below(2) == 0 {
        return (RayLanes { t_min: 0.0, ..r.widen() }, s);
    }
    let aside = Vec3::<f64>::splat(dice.heading());
    let along = aside.cross(Vec3::splat(dice.heading())).normalize();
    let touch = s.center + aside * (s.radius * (1.0 - dice.magnitude(-16.0, -3.0).abs()));
    let origin = touch - along * (s.radius * dice.magnitude(-3.0, 8.0).abs());
    (ray(origin.get(0), along.get(0)), s)
}

/// Hits that a nearer one makes needless may be left out, no others, however close the two are.
#[test]
fn only_hits_beyond_the_limit_are_left_out() {
    let mut dice = Dice(36);
    let mut left_out = 0;
    for _ in 0..50_000 {
        let (r, s) = past(&mut dice);
        let hit = Widened::sphere(&r, &s);
        if !hit.mask || hit.t <= 0.0 {
            continue;
        }
        let off = [0.0, dice.magnitude(-17.0, -1.0)][dice.below(2)];
        let limit = hit.t * (1.0 + off);
        let within = !is_beyond(&r, &s, limit);
        assert!(within || hit.t > limit, "{hit:?} is not beyond {limit}: {s:?} by {r:?}");
        left_out += usize::from(!within);
    }
    assert!(left_out > 1_000, "{left_out}");
}

/// Rays said to hit do, and before what they were asked about.
#[test]
fn what_surely_is_hit_is_hit_before_the_limit() {
    let mut dice = Dice(37);
    let mut sure = [0; 2];
    for _ in 0..50_000 {
        let (r, s) = past(&mut dice);
        let off = [0.0, 10.0, dice.magnitude(-8.0, -1.0)][dice.below(3)];
        let hit = Widened::sphere(&r, &s);
        let limit = if hit.mask { hit.t * (1.0 + off) } else { [1e3, f64::INFINITY][dice.below(2)] };
        if surely_hits(&r, &s, limit) {
            sure[0] += 1;
            assert!(hit.mask && hit.t > 0.0 && hit.t < limit, "{hit:?} by {limit}: {s:?} by {r:?}");
        }
        let narrow = |v: Vec3<f64>| Vec3::<f32>::narrow(v);
        let r = RayLanes {
            origin: narrow(r.origin),
            direction: narrow(r.direction),
            t_min: 0.0f32,
            t_max: f32::INFINITY,
        };
        let s = Lanes { center: narrow(s.center), radius: s.radius as f32 };
        let hit = Widened::sphere(&r, &s);
        let limit = if hit.mask { hit.t * (1.0 + off as f32) } else { f32::INFINITY };
        if surely_hits(&r, &s, limit) {
            sure[1] += 1;
            assert!(hit.mask && hit.t > 0.0 && hit.t < limit, "{hit:?} by {limit}: {s:?} by {r:?}");
        }
    }
    assert!(sure.iter().all(|&n| n > 1_000), "{sure:?}");
}

/// What is not asked of rays that go away would not have been taken.
#[test]
fn rays_that_leave_have_no_hit_ahead() {
    let mut dice = Dice(38);
    let mut leaving = 0;
    for _ in 0..50_000 {
        let (r, s) = past(&mut dice);
        let on = r.origin + r.direction * [solve(&r, &s).t, 0.0][dice.below(2)];
        let r = RayLanes { origin: on, direction: [r.direction, -r.direction][dice.below(2)], ..r };
        if leaves(&r, &s) {
            leaving += 1;
            let hit = solve(&r, &s);
            assert!(!(hit.mask && hit.t > 0.0), "{hit:?}: {s:?} by {r:?}");
        }
    }
    assert!(leaving > 5_000, "{leaving}");
}
