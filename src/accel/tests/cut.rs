//! Trees that cut triangles against the plain loop, where cutting is hardest: long, thin, large among small, and rays in
//! their planes.

use proptest::prelude::*;

use super::scenes::World;
use super::streams::check_tree;
use super::{check, rays, sound};
use crate::accel::Accel;
use crate::accel::build::Quality;
use crate::intersect::testing::dice::Dice;
use crate::intersect::testing::grazing::{Corners, KINDS, hard_triangle, in_plane};
use crate::intersect::{Exact, Tier, Watertight};

fn hard_world(seed: u64) -> (World, Vec<Corners>) {
    let mut dice = Dice(seed);
    let scale = [1.0, 1e-4, 1e5][dice.below(3)];
    // Mostly of one kind: where kinds mix, the largest decide, and cutting them seldom pays.
    let most = dice.below(KINDS);
    let kind = |dice: &mut Dice| if dice.below(16) == 0 { dice.below(KINDS) } else { most };
    // Cutting pays most for a few large ones among small ones.
    let large = [1, 8][dice.below(2)];
    let triangle = |dice: &mut Dice| {
        let corners = hard_triangle(kind(dice), dice).map(|p| p.map(|x| scale * x));
        let small = corners.map(|p| std::array::from_fn(|k| corners[0][k] + 0.2 * (p[k] - corners[0][k])));
        if dice.below(large) == 0 { corners } else { small }
    };
    let triangles: Vec<Corners> = (0..100 + dice.below(500)).map(|_| triangle(&mut dice)).collect();
    let mut world = World::default();
    for corners in &triangles {
        world.push_mesh(corners, &[[0, 1, 2]]);
    }
    (world, triangles)
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
