//! Trees that cut triangles against the plain loop, where cutting is hardest: long, thin, large among small, and rays in
//! their planes.

use proptest::prelude::*;

use super::scenes::World;
use super::streams::check_tree;
use super::{check, rays, sound};
use crate::accel::Accel;
use crate::accel::build::Quality;
use crate::intersect::testing::dice::Dice;
use crate::intersect::{Exact, Ray, Tier, Watertight};

type Corners = [[f32; 3]; 3];

/// Kinds of [`hard_triangle`].
pub(in crate::accel) const KINDS: usize = 8;

/// A triangle that boxes fit badly.
pub(in crate::accel) fn hard_triangle(kind: usize, dice: &mut Dice) -> Corners {
    let mut point = |scale: f64| dice.point().map(|x| (scale * x) as f32);
    let (a, b, c, small) = (point(4.0), point(4.0), point(4.0), point(1.0));
    let beside = |p: [f32; 3], by: f32| std::array::from_fn(|k| p[k] + by * small[k]);
    let mut along = a;
    let axis = dice.below(3);
    along[axis] += 6.0;
    match kind {
        0 => [a, b, beside(b, 1e-3)],
        1 => [a, b, beside(a, 1e-6)],
        2 => [a, along, beside(along, 0.05)],
        3 => [a, along, std::array::from_fn(|k| if k == (axis + 1) % 3 { b[k] } else { a[k] })],
        4 => [a, beside(a, 0.1), beside(a, -0.07)],
        5 => [[0.0; 3], b, c],
        6 => [a, a.map(|x| x + 5.0), beside(a, 0.02)],
        _ => [a, b, c].map(|p| p.map(|x| (2.0 * x).round() * 0.5)),
    }
}

fn hard_world(seed: u64) -> (World, Vec<Corners>) {
    let mut dice = Dice(seed);
    let scale = [1.0, 1e-4, 1e5][dice.below(3)];
    // Mostly of one kind: where kinds mix, the largest decide, and cutting them seldom pays.
    let most = dice.below(KINDS);
    let kind = |dice: &mut Dice| if dice.below(16) == 0 { dice.below(KINDS) } else { most };
    let triangle = |dice: &mut Dice| hard_triangle(kind(dice), dice).map(|p| p.map(|x| scale * x));
    let triangles: Vec<Corners> = (0..100 + dice.below(500)).map(|_| triangle(&mut dice)).collect();
    let mut world = World::default();
    for corners in &triangles {
        world.push_mesh(corners, &[[0, 1, 2]]);
    }
    (world, triangles)
}

/// From a point of a triangle's plane to another: the signs of its edge functions are chance.
pub(in crate::accel) fn in_plane(triangles: &[Corners], dice: &mut Dice) -> Ray {
    let [a, b, c] = triangles[dice.below(triangles.len())];
    let point = |dice: &mut Dice| -> [f32; 3] {
        let (u, v) = (dice.between(-1.0, 2.0), dice.between(-1.0, 2.0));
        let at = |k: usize| f64::from(a[k]) * (1.0 - u - v) + f64::from(b[k]) * u + f64::from(c[k]) * v;
        std::array::from_fn(|k| at(k) as f32)
    };
    let (origin, target) = (point(dice), point(dice));
    let nudge = [0.0, 1e-7, 1e-5][dice.below(3)];
    Ray::new(origin, std::array::from_fn(|k| target[k] - origin[k] + nudge * dice.point()[k] as f32))
}

fn check_hard_world<T: Tier>(seed: u64) -> (usize, usize) {
    let (world, triangles) = hard_world(seed);
    let geometry = world.geometry();
    let accel = Accel::build_with(&geometry, Quality::High);
    let mut dice = Dice(!seed);
    let mut asked = rays::around(&world.landmarks(), &mut dice, 64);
    asked.extend((0..64).map(|_| in_plane(&triangles, &mut dice)).filter(|ray| ray.direction != [0.0; 3]));
    let stats = sound(&geometry, Quality::High).unwrap_or_else(|fault| panic!("{fault}"));
    let references = (stats.mean_primitives * stats.leaves as f64).round() as usize;
    (check::<T>(&geometry, &accel, &asked), references - triangles.len())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn cut_triangles_are_hit_as_whole_ones_in_watertight(seed: u64) {
        check_hard_world::<Watertight>(seed);
    }

    #[test]
    fn cut_triangles_are_hit_as_whole_ones_in_exact(seed: u64) {
        check_hard_world::<Exact>(seed);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn streams_hit_cut_triangles_as_whole_ones(seed: u64) {
        let (world, _) = hard_world(seed);
        check_tree::<Watertight>(&world, Quality::High, seed);
        check_tree::<Exact>(&world, Quality::High, seed);
    }
}

/// The battery would prove nothing if nothing was cut or hit.
#[test]
fn the_battery_cuts_and_hits() {
    let of: Vec<_> = (0..20).map(check_hard_world::<Watertight>).collect();
    let (hits, cut) = of.iter().fold((0, 0), |all, one| (all.0 + one.0, all.1 + one.1));
    assert!(hits > 20 * 40 && cut > 20 * 10, "{hits} hits, {cut} parts");
}
