//! Cylinders against exact arithmetic, and one test a slip of the textbook form.

use super::oracle::{Cylinder, Part, meetings};
use super::products::Plain;
use super::{Lanes, is_behind, is_beyond, leaves, solve, solve_rounded, solve_widened};
use crate::intersect::curved::Widened;
use crate::intersect::testing::dice::Dice;
use crate::intersect::testing::{exact, line, percentile, ray, t_of, ulps};
use crate::intersect::{Curved, LaneHit, RayLanes, oracle};
use crate::math::{Real, Vec3};

type Solve = fn(&RayLanes<f32>, &Lanes<f32>) -> LaneHit<f32>;

fn f32s(p: [f64; 3]) -> [f32; 3] {
    p.map(|x| x as f32)
}

fn plain(c: &Lanes<f32>) -> Cylinder {
    Cylinder { from: c.from.widen(), to: c.to.widen(), radius: c.radius.into(), capped: c.capped }
}

/// From coins to wires, standing anywhere, some along an axis of the world.
fn any_cylinder(dice: &mut Dice) -> Lanes<f32> {
    let radius = dice.magnitude(-3.0, 3.0).abs();
    let length = radius * dice.magnitude(-2.0, 3.0).abs();
    let from = dice.point().map(|x| 3.0 * x * (radius + length));
    let axis =
        [dice.heading(), [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]][dice.below(3)]][dice.below(2)];
    let to = std::array::from_fn(|k| from[k] + length * axis[k]);
    let capped = dice.below(2) == 0;
    Lanes { from: Vec3::splat(f32s(from)), to: Vec3::splat(f32s(to)), radius: radius as f32, capped }
}

/// A point of the cylinder: `height` 0 to 1 along the axis, `out` 0 to 1 across it.
fn point_of(dice: &mut Dice, c: &Lanes<f32>, height: f64, out: f64) -> [f64; 3] {
    let axis = c.to.widen() - c.from.widen();
    let across = axis.normalize().cross(Vec3::splat(dice.heading())).normalize();
    (c.from.widen() + axis * height + across * (out * f64::from(c.radius))).get(0)
}

fn towards(dice: &mut Dice, c: &Lanes<f32>, target: [f64; 3]) -> RayLanes<f32> {
    let away = (c.to.widen() - c.from.widen()).length() + f64::from(c.radius);
    let back = dice.heading().map(|x| x * away * 2.0);
    let origin = f32s(std::array::from_fn(|k| target[k] - back[k]));
    line(origin, f32s(std::array::from_fn(|k| target[k] - f64::from(origin[k]))))
}

/// Decisions may differ from exact arithmetic only within `margin` roundoffs of the surface.
fn assert_agrees(
    name: &str,
    solve: Solve,
    roundoff: f64,
    margin: f64,
    case: fn(&mut Dice) -> (RayLanes<f32>, Lanes<f32>),
) {
    let mut dice = Dice(41);
    let mut hits = 0;
    for _ in 0..15_000 {
        let (r, c) = case(&mut dice);
        let c = Lanes { capped: true, ..c };
        let radius = f64::from(c.radius);
        let reach = (r.origin.widen() - c.from.widen()).length() + (c.to.widen() - c.from.widen()).length();
        let slack = margin * roundoff * (reach + radius);
        let meets = |slack: f64| radius + slack > 0.0 && exact::cylinder(&r, [c.from, c.to], radius, slack);
        let hit = solve(&r, &c).mask;
        hits += usize::from(hit);
        assert!(hit || !meets(-slack), "{name} misses {c:?} by {r:?}");
        assert!(!hit || meets(slack), "{name} invents {c:?} by {r:?}");
    }
    println!("cylinder {name}: {hits} hits of 15000");
    assert!(hits > 3_000 && hits < 14_900, "{hits}");
}

fn anywhere(dice: &mut Dice) -> (RayLanes<f32>, Lanes<f32>) {
    let c = any_cylinder(dice);
    let (height, out) = (dice.between(-0.3, 1.3), dice.between(0.0, 1.5));
    let target = point_of(dice, &c, height, out);
    (towards(dice, &c, target), c)
}

/// Aimed at the rim, within 1e-6 of it.
fn at_the_rim(dice: &mut Dice) -> (RayLanes<f32>, Lanes<f32>) {
    let c = any_cylinder(dice);
    let (end, out) = (dice.below(2) as f64, 1.0 + dice.between(-1e-6, 1e-6));
    let height = end + dice.between(-1e-6, 1e-6);
    let target = point_of(dice, &c, height, out);
    (towards(dice, &c, target), c)
}

/// Along the axis but for rounding, or for a tiny angle.
fn along_the_axis(dice: &mut Dice) -> (RayLanes<f32>, Lanes<f32>) {
    let c = any_cylinder(dice);
    let (out, tilt) = (dice.between(0.0, 1.4), [0.0, dice.magnitude(-12.0, -2.0)][dice.below(2)]);
    let start = point_of(dice, &c, -1.0, out);
    let (axis, aside) = ((c.to.widen() - c.from.widen()).get(0), dice.heading());
    let direction = std::array::from_fn(|k| axis[k] + tilt * aside[k] * f64::from(c.radius));
    (line(f32s(start), f32s(direction)), c)
}

/// The products of such numbers lose their digits to underflow in `f32`, while one of them is 1e10.
#[test]
fn the_filter_keeps_a_speck_seen_from_far_away() {
    let mut dice = Dice(44);
    for _ in 0..2_000 {
        let heading = f32s(dice.heading());
        let to = Vec3::splat(f32s(dice.heading())) * 1e-22;
        let c = Lanes { from: Vec3::splat([0.0; 3]), to, radius: 1e-22, capped: true };
        let tiny = 2f32.powi(-66);
        let r = line(heading.map(|x| -x * 2f32.powi(33)), heading.map(|x| x * tiny));
        assert!(Widened::cylinder(&r, &c).mask, "{r:?} {c:?}");
    }
}

#[test]
fn the_filtered_test_agrees_with_exact_arithmetic() {
    assert_agrees("filtered along", Widened::cylinder::<f32>, f64::ROUNDOFF, 32.0, along_the_axis);
    assert_agrees("filtered", Widened::cylinder::<f32>, f64::ROUNDOFF, 32.0, anywhere);
}

/// Slip: side asked by height and cap by radius, each rounded alone, so that rays at the rim pass between them.
#[test]
fn no_ray_passes_between_side_and_cap() {
    assert_agrees("filtered at the rim", Widened::cylinder::<f32>, f64::ROUNDOFF, 32.0, at_the_rim);
    assert_agrees("direct at the rim", solve::<f32>, f32::ROUNDOFF, 32.0, at_the_rim);
}

/// Away from rims and tangents, where the oracle gives the same meetings for a radius 1e-7 larger or smaller.
#[test]
fn first_meeting_and_its_part_are_those_of_the_oracle() {
    let mut dice = Dice(42);
    let (mut errors, mut skipped) = (Vec::new(), 0);
    for _ in 0..60_000 {
        let (r, c) = anywhere(&mut dice);
        let r = RayLanes { t_min: [0.0, 1.0][dice.below(2)], ..r };
        let first = |radius: f64| {
            let all = meetings(&r.widen(), &Cylinder { radius, ..plain(&c) });
            all.into_iter().find(|m| m.0 > f64::from(r.t_min) + 1e-6)
        };
        let radius = f64::from(c.radius);
        let [less, more] = [first(radius * (1.0 - 1e-7)), first(radius * (1.0 + 1e-7))];
        if less.map(|m| m.1) != more.map(|m| m.1)
            || less.zip(more).is_some_and(|(a, b)| (a.0 - b.0).abs() > 1e-4)
        {
            skipped += 1;
            continue;
        }
        let (hit, want) = (Widened::cylinder(&r, &c), first(radius));
        assert_eq!(hit.mask && hit.t > r.t_min, want.is_some(), "{hit:?} {want:?} {c:?} {r:?}");
        if let Some((t, part)) = want {
            let code = [Part::Side, Part::FromCap, Part::ToCap].iter().position(|p| *p == part);
            assert_eq!(Some(hit.u as usize), code, "{c:?} {r:?}");
            errors.push(ulps(hit.t, t));
        }
    }
    let (p99, max) = (percentile(&mut errors, 0.99), percentile(&mut errors, 1.0));
    println!("cylinder filtered: {} hits, {skipped} skipped, t p99 {p99} max {max} ulp", errors.len());
    assert!(errors.len() > 15_000 && skipped < 600 && p99 <= 0.51, "{} {skipped} {p99}", errors.len());
}

fn upright(capped: bool) -> Lanes<f32> {
    Lanes { from: Vec3::splat([0.0; 3]), to: Vec3::splat([0.0, 0.0, 2.0]), radius: 1.0, capped }
}

/// `(t, u, v)` as the caller sees it, which both versions must give.
fn seen(r: &RayLanes<f32>, c: &Lanes<f32>) -> Option<[f32; 3]> {
    let [a, b] = [solve(r, c), Widened::cylinder(r, c)]
        .map(|h| t_of(h).filter(|t| r.t_min < *t && *t < r.t_max).map(|t| [t, h.u, h.v]));
    assert_eq!(a, b);
    a
}

/// Slip: `d.y` written for `d.z` in the quadratic. A ray without `y` would have seen no side at all.
#[test]
fn each_component_of_the_direction_counts() {
    let lying = |axis: usize| {
        let mut to = [0.0; 3];
        to[axis] = 2.0;
        Lanes { to: Vec3::splat(to), ..upright(true) }
    };
    for axis in 0..3 {
        for across in [(axis + 1) % 3, (axis + 2) % 3] {
            let (mut o, mut d) = ([0.0; 3], [0.0; 3]);
            (o[axis], o[across], d[across]) = (1.0, -3.0, 1.0);
            assert_eq!(seen(&ray(o, d), &lying(axis)), Some([2.0, 0.0, 0.5]), "axis {axis}, along {across}");
        }
    }
}

/// Slip: `a = 0` for a ray along the axis gave NaN.
#[test]
fn a_ray_along_the_axis_hits_the_caps_only() {
    for x in [0.0, 0.5, 1.0] {
        let r = ray([x, 0.0, -3.0], [0.0, 0.0, 1.0]);
        assert_eq!(seen(&r, &upright(true)), Some([3.0, 1.0, 0.0]), "x {x}");
        let back = ray([x, 0.0, 5.0], [0.0, 0.0, -1.0]);
        assert_eq!(seen(&back, &upright(true)), Some([3.0, 2.0, 1.0]), "x {x}");
        assert_eq!(seen(&r, &upright(false)), None, "x {x}");
    }
    assert_eq!(seen(&ray([1.5, 0.0, -3.0], [0.0, 0.0, 1.0]), &upright(true)), None);
}

#[test]
fn an_open_cylinder_shows_its_inner_side_through_the_end() {
    let r = ray([0.0, 0.0, -1.0], [0.5, 0.0, 1.0]);
    assert_eq!(seen(&r, &upright(false)), Some([2.0, 0.0, 0.5]));
    assert_eq!(seen(&r, &upright(true)), Some([1.0, 1.0, 0.0]));
    let through = ray([0.0, 0.0, -1.0], [0.125, 0.0, 1.0]);
    assert_eq!(seen(&through, &upright(false)), None, "in at one end and out at the other");
}

#[test]
fn from_inside_side_and_caps_are_hit() {
    assert_eq!(seen(&ray([0.0, 0.0, 1.0], [1.0, 0.0, 0.0]), &upright(true)), Some([1.0, 0.0, 0.5]));
    assert_eq!(seen(&ray([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]), &upright(true)), Some([1.0, 1.0, 0.0]));
    assert_eq!(seen(&ray([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]), &upright(true)), Some([1.0, 2.0, 1.0]));
}

#[test]
fn a_tangent_ray_touches_once_wherever_it_starts() {
    assert_eq!(seen(&ray([1.0, -3.0, 1.0], [0.0, 1.0, 0.0]), &upright(true)), Some([3.0, 0.0, 0.5]));
    assert_eq!(seen(&ray([1.001, -3.0, 1.0], [0.0, 1.0, 0.0]), &upright(true)), None);
    // From the point of contact, rising: it leaves the cylinder there, and must not meet the plane of the cap.
    for capped in [true, false] {
        assert_eq!(seen(&ray([1.0, 0.0, 1.0], [0.0, 1.0, 1.0]), &upright(capped)), None);
    }
}

#[test]
fn the_ends_of_the_range_do_not_count() {
    let r = ray([-3.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
    let c = upright(true);
    assert_eq!(seen(&RayLanes { t_min: 2.0, ..r }, &c), Some([4.0, 0.0, 0.5]), "t_min at the near side");
    assert_eq!(seen(&RayLanes { t_min: 4.0, ..r }, &c), None, "t_min at the far side");
    assert_eq!(seen(&RayLanes { t_max: 2.0, ..r }, &c), None, "t_max at the near side");
}

/// A ray continued with the `t` of its first hit as `t_min` must find the second, however the first was rounded.
#[test]
fn continuing_from_the_first_hit_finds_the_second() {
    let mut dice = Dice(43);
    for _ in 0..20_000 {
        let (r, c) = anywhere(&mut dice);
        let c = Lanes { capped: true, ..c };
        let [(near, _), (far, _)] = meetings(&r.widen(), &plain(&c))[..] else { continue };
        if far - near < 1e-3 * (far.abs() + near.abs()) {
            continue;
        }
        let first = Widened::cylinder(&r, &c).t;
        let second = Widened::cylinder(&RayLanes { t_min: first, ..r }, &c);
        let reached = f64::from(second.t) > 0.5 * (near + far);
        assert!(second.mask && reached, "{first} then {} of {near} {far}", second.t);
    }
}

/// Found by `verify`: a wire that `f64` alone says is met, by rounding of its far ends.
#[test]
fn the_exact_tier_misses_a_wire_that_the_ray_passes() {
    let end = [358222.06f32, 92356.97, -336373.56].map(f64::from);
    let ends = [Vec3::splat(end), Vec3::splat(end.map(|x| -x))];
    let wire = Lanes { from: ends[0], to: ends[1], radius: f64::from(0.001f32), capped: true };
    let r = ray(
        [0.5504746f32, 0.094409086, 0.82870597].map(f64::from),
        [-1.102265f32, -0.18702921, -1.658322].map(f64::from),
    );
    assert!(!exact::cylinder(&r, ends, wire.radius, 0.0));
    assert!(solve(&r, &wire).mask, "f64 alone is wrong here, or the case tells nothing");
    assert!(!Widened::cylinder(&r, &wire).mask, "made a hit of a wire that is passed");
}

/// Found by the fuzz target `tiers`: the ray starts inside by less than a roundoff.
#[test]
fn the_exact_tier_finds_a_side_just_ahead_of_the_start() {
    let wide = |p: [f32; 3]| p.map(f64::from);
    let ends =
        [[6.1875005, 5.3125005, 5.3125005], [6.1875005, 2.9802322e-8, 0.0]].map(|p| Vec3::splat(wide(p)));
    let c = Lanes { from: ends[0], to: ends[1], radius: f64::from(7.0625005f32), capped: true };
    let r = ray(wide([2.125, 0.0, 2.9802322e-8]), wide([8.000001, -29.999998, 1.1920929e-7]));
    let hit = Widened::cylinder(&r, &c);
    let want = 5.572884109553546e-18;
    assert!(hit.mask && (hit.t - want).abs() < 1e-9 * want, "{hit:?}");
}

/// Hit or miss of each line is that of exact arithmetic, and `t` as well; and `f64` alone gets some wrong.
fn assert_decided(name: &str, case: fn(&mut Dice, &Lanes<f64>) -> [Vec3<f64>; 2]) {
    let mut dice = Dice(45);
    let mut counts = [0; 3];
    for _ in 0..4_000 {
        let c = any_cylinder(&mut dice);
        let c = Lanes { from: c.from.widen(), to: c.to.widen(), radius: c.radius.into(), capped: true };
        let [origin, direction] = case(&mut dice, &c);
        let r = line(origin.get(0), direction.get(0));
        let (from, to, radius, capped) = (c.from.get(0), c.to.get(0), c.radius, true);
        let solid = oracle::Shape::Cylinder(oracle::Cylinder { from, to, radius, capped });
        let line = oracle::Line { origin: origin.get(0), direction: direction.get(0) };
        let [want, last] = oracle::surfaces(&line, &solid);
        counts[usize::from(want.is_some())] += 1;
        counts[2] += usize::from(solve(&r, &c).mask != want.is_some());
        let got = Widened::cylinder(&r, &c);
        assert_eq!(got.mask, want.is_some(), "{name} decided by rounding: {c:?} by {r:?}");
        if let (Some(want), Some(last)) = (want, last) {
            let reach = want.abs().max(last.abs());
            assert!((got.t - want).abs() <= 1e-7 * reach, "{name}: {} for {want} of {c:?} by {r:?}", got.t);
        }
    }
    println!("cylinder {name}: misses, hits, and those that f64 gets wrong: {counts:?}");
    assert!(counts[0] > 100 && counts[1] > 100 && counts[2] > 20, "{name}: {counts:?}");
}

fn frame(dice: &mut Dice, c: &Lanes<f64>) -> [Vec3<f64>; 2] {
    let axis = (c.to - c.from).normalize();
    [axis, axis.cross(Vec3::splat(dice.heading())).normalize()]
}

/// Within 1e-10 radii of tangency, from up to 1e6 radii away.
#[test]
fn the_exact_tier_decides_tangents_without_rounding() {
    assert_decided("tangents", |dice, c| {
        let [axis, aside] = frame(dice, c);
        let touch =
            c.from + (c.to - c.from) * 0.5 + aside * (c.radius * (1.0 + dice.magnitude(-16.0, -10.0)));
        let along = (axis.cross(aside) + axis * dice.between(-1.0, 1.0)).normalize();
        [touch - along * (c.radius * dice.magnitude(0.0, 6.0).abs()), along]
    });
}

/// Within 1e-12 of a rim, most of them skew to it.
#[test]
fn the_exact_tier_decides_rims_without_rounding() {
    assert_decided("rims", |dice, c| {
        let [axis, aside] = frame(dice, c);
        let off = |dice: &mut Dice| c.radius * dice.magnitude(-17.0, -12.0);
        let rim = [c.from, c.to][dice.below(2)] + aside * (c.radius + off(dice)) + axis * off(dice);
        let along = Vec3::<f64>::splat(dice.heading());
        [rim - along * (c.radius * dice.magnitude(-1.0, 2.0).abs()), along]
    });
}

/// With the direction the axis itself, or turned by less than `f64` tells: the formula for a skew line means nothing there.
#[test]
fn the_exact_tier_decides_lines_along_the_axis_without_rounding() {
    assert_decided("lines along the axis", |dice, c| {
        let [axis, aside] = frame(dice, c);
        let start = c.from - axis * c.radius + aside * (c.radius * (1.0 + dice.magnitude(-18.0, -14.0)));
        let tilt = [0.0, dice.magnitude(-18.0, -12.0)][dice.below(2)];
        [start, (c.to - c.from) + Vec3::splat(dice.heading()) * (tilt * c.radius)]
    });
}

/// Hits that a nearer one makes needless may be left out, no others, however close the two are.
#[test]
fn only_hits_beyond_the_limit_are_left_out() {
    let mut dice = Dice(46);
    let mut left_out = 0;
    for _ in 0..50_000 {
        let case = [anywhere, at_the_rim, along_the_axis][dice.below(3)];
        let (r, c) = case(&mut dice);
        let c = Lanes { from: c.from.widen(), to: c.to.widen(), radius: c.radius.into(), capped: c.capped };
        let r = RayLanes { t_min: 0.0, ..r.widen() };
        let hit = Widened::cylinder(&r, &c);
        if !hit.mask || hit.t <= 0.0 {
            continue;
        }
        let off = [0.0, dice.magnitude(-17.0, -1.0)][dice.below(2)];
        let limit = hit.t * (1.0 + off);
        let within = !is_beyond(&r, &c, limit);
        assert!(within || hit.t > limit, "{hit:?} is not beyond {limit}: {c:?} by {r:?}");
        left_out += usize::from(!within);
    }
    assert!(left_out > 1_000, "{left_out}");
}

/// The cheap test leaves out only what goes away, by more than rounding, from wherever near the surface it starts.
#[test]
fn rays_that_are_said_to_go_away_have_no_hit_ahead() {
    let mut dice = Dice(52);
    let mut behind = 0;
    for _ in 0..100_000 {
        let (r, c) = [anywhere, at_the_rim, along_the_axis][dice.below(3)](&mut dice);
        let hit = solve_widened(true, &r, &c);
        let off = [0.0, dice.magnitude(-8.0, 0.0)][dice.below(2)] as f32;
        let from = r.origin + r.direction * (if hit.mask { hit.t } else { 0.0 } + off);
        let d = [r.direction, -r.direction][dice.below(2)];
        let r = RayLanes { origin: from, direction: d, t_min: 0.0, ..r };
        if is_behind(&r, &c) {
            behind += 1;
            let hit = solve_widened(true, &r, &c);
            assert!(!(hit.mask && hit.t > 0.0), "{hit:?}: {c:?} by {r:?}");
        }
    }
    assert!(behind > 10_000, "{behind}");
}

/// What is not asked of rays that go away would not have been taken.
#[test]
fn rays_that_leave_have_no_hit_ahead() {
    let mut dice = Dice(51);
    let mut leaving = 0;
    for _ in 0..50_000 {
        let (r, c) = [anywhere, at_the_rim, along_the_axis][dice.below(3)](&mut dice);
        let wide = RayLanes { t_min: 0.0, ..r.widen() };
        let c =
            Lanes { from: c.from.widen(), to: c.to.widen(), radius: f64::from(c.radius), capped: c.capped };
        let meet = |r: &RayLanes<f64>| solve_rounded::<_, Plain>(r, &c, |t| t, |_, chord| chord);
        let on = wide.origin + wide.direction * [meet(&wide).t, 0.0][dice.below(2)];
        let r = RayLanes { origin: on, direction: [wide.direction, -wide.direction][dice.below(2)], ..wide };
        if leaves(&r, &c) {
            leaving += 1;
            let hit = meet(&r);
            assert!(!(hit.mask && hit.t > 0.0), "{hit:?}: {c:?} by {r:?}");
        }
    }
    assert!(leaving > 5_000, "{leaving}");
}
