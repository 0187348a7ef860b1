//! What a glimpse calls certain is so in exact arithmetic, and in the full test bit for bit.

use super::*;

/// A case at any scale, its direction of any length.
fn scaled(dice: &mut Dice, (r, v): (RayLanes<f32>, [Vec3<f32>; 3])) -> (RayLanes<f32>, [Vec3<f32>; 3]) {
    let (size, length) = match dice.below(3) {
        0 => (1.0, 1.0),
        1 => (dice.magnitude(-6.0, 6.0).abs(), dice.magnitude(-6.0, 6.0).abs()),
        _ => (dice.magnitude(-40.0, 36.0).abs(), dice.magnitude(-44.0, 37.0).abs()),
    };
    let by = |v: Vec3<f32>, scale: f64| v.get(0).map(|x| (f64::from(x) * scale) as f32);
    (line(by(r.origin, size), by(r.direction, length)), v.map(|p| Vec3::splat(by(p, size))))
}

fn case(dice: &mut Dice, round: usize) -> (RayLanes<f32>, [Vec3<f32>; 3]) {
    match round % 3 {
        0 => random_case(dice),
        1 => {
            let (r, v) = hard_case(dice);
            let narrow = |v: Vec3<f64>| v.get(0).map(|x| x as f32);
            (line(narrow(r.origin), narrow(r.direction)), v.map(|p| Vec3::splat(narrow(p))))
        }
        _ => {
            let corners = hard_triangle(round / 3 % KINDS, dice);
            let Ray { origin, direction, .. } = in_plane(&[corners], dice);
            (line(origin, direction), corners.map(Vec3::splat))
        }
    }
}

#[test]
fn what_a_glimpse_calls_certain_is_so() {
    let mut dice = Dice(18);
    let (mut hits, mut certain) = (0, 0);
    for round in 0..400_000 {
        let drawn = case(&mut dice, round);
        let (r, v) = scaled(&mut dice, drawn);
        let is_ray = r.direction.get(0).iter().any(|x| *x != 0.0);
        let is_finite =
            [r.origin, r.direction, v[0], v[1], v[2]].iter().all(|p| p.get(0).iter().all(|x| x.is_finite()));
        if !is_ray || !is_finite {
            continue;
        }
        let full = meet::<Woop, f32>(&r, v);
        hits += usize::from(full.mask);
        let seen = Woop::glimpse(&r, &Woop::prepare(&r), v).expect("the watertight test glimpses");
        assert!(full.mask <= seen.inside, "a hit outside of the edges: {r:?} {v:?}");
        if !seen.near.is_finite() {
            continue;
        }
        certain += 1;
        let bits = |hit: LaneHit<f32>| [hit.t, hit.u, hit.v].map(f32::to_bits);
        assert!(full.mask, "certain, but no hit: {r:?} {v:?}");
        assert_eq!(bits(Woop::settle(&r, v)), bits(full), "{r:?} {v:?}");
        assert!(seen.near <= full.t && full.t <= seen.far, "{seen:?} {full:?} {r:?} {v:?}");
        let exact = exact::triangle(&r, v).unwrap_or_else(|| panic!("certain, but missed: {r:?} {v:?}"));
        let bounds = f64::from(seen.near)..=f64::from(seen.far);
        assert!(bounds.contains(&exact), "{exact:e} in {bounds:?} {r:?} {v:?}");
    }
    println!("{certain} of {hits} hits are certain at a glance");
    assert!(hits > 100_000 && certain > hits / 4, "{certain} of {hits}");
}

/// Of ordinary hits all but a few are, and their bounds are narrow: else nothing would be saved.
#[test]
fn a_glimpse_tells_most() {
    let mut dice = Dice(19);
    let (mut hits, mut narrow) = (0, 0);
    for _ in 0..20_000 {
        let (r, v) = random_case(&mut dice);
        if !meet::<Woop, f32>(&r, v).mask {
            continue;
        }
        hits += 1;
        let seen = Woop::glimpse(&r, &Woop::prepare(&r), v).expect("the watertight test glimpses");
        narrow += usize::from(seen.far - seen.near <= 1e-3 * seen.far.abs());
    }
    println!("{narrow} of {hits} hits are known to a thousandth at a glance");
    assert!(hits > 2_000 && narrow * 10 > hits * 9, "{narrow} of {hits}");
}
