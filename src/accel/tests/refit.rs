//! Trees whose primitives moved against the plain loop.

use proptest::prelude::*;

use super::scenes::{World, world};
use super::{QUALITIES, check, rays};
use crate::accel::Accel;
use crate::accel::build::Quality;
use crate::geometry::Geometry;
use crate::intersect::testing::dice::Dice;
use crate::intersect::{Exact, Watertight};
use crate::math::{Aabb, Transform, WIDTH};

/// Everything a little or far elsewhere; of some, nothing.
fn moved(geometry: &Geometry, dice: &mut Dice) -> Geometry {
    let mut g = geometry.clone();
    let by = [0.0, 1e-3, 0.5, 30.0][dice.below(4)];
    let columns = g.triangles.position.iter_mut().chain(&mut g.spheres.center).chain(&mut g.cylinders.to);
    for x in columns.flatten() {
        *x += [0.0, by * dice.between(-1.0, 1.0) as f32][dice.below(2)];
    }
    for instance in &mut g.instances {
        let shift = dice.point().map(|x| x * f64::from(by));
        let [x, y, z] = shift;
        let rows = [[1.0, 0.0, 0.0, x], [0.0, 1.0, 0.0, y], [0.0, 0.0, 1.0, z]];
        instance.to_world = Transform::from_rows(rows).expect("a shift has an inverse");
    }
    g
}

/// Boxes hold what is below, down to whole primitives; gives the box of a node.
fn sound_below(accel: &Accel, node: u32, claimed: &Aabb) {
    let holder = &accel.nodes[node as usize];
    for slot in (0..WIDTH).filter(|&slot| !holder.child[slot].is_empty()) {
        let (child, bounds) = (holder.child[slot], holder.bounds(slot));
        assert!(!bounds.is_empty() && claimed.contains(&bounds), "slot {slot} of node {node}");
        if child.is_node() {
            sound_below(accel, child.index(), &bounds);
        }
    }
}

fn check_moved(world: &World, seed: u64) {
    let mut dice = Dice(seed);
    for quality in QUALITIES {
        let built = world.geometry();
        let mut accel = Accel::build_with(&built, quality);
        let geometry = moved(&built, &mut dice);
        accel.refit(&geometry).unwrap();
        assert_eq!(accel.bounds(), Accel::build(&geometry).bounds());
        let bounds = accel.bounds();
        sound_below(&accel, accel.world.node, &bounds);
        let rays = rays::around(&world.landmarks(), &mut dice, 32);
        check::<Watertight>(&geometry, &accel, &rays);
        check::<Exact>(&geometry, &accel, &rays);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn moved_worlds_equal_brute_force(world in world(120), seed: u64) {
        check_moved(&world, seed);
    }
}

/// Where nothing moved, nothing changes: not even the small boxes of cut triangles.
#[test]
fn without_movement_the_tree_is_the_same() {
    let terrain = crate::load::terrain(5_000, 1, false);
    let mut world = World::default();
    world.push_mesh(&terrain.positions, &terrain.triangles);
    let geometry = world.geometry();
    for quality in QUALITIES {
        let (mut refitted, built) =
            (Accel::build_with(&geometry, quality), Accel::build_with(&geometry, quality));
        refitted.refit(&geometry).unwrap();
        assert!(refitted.nodes == built.nodes && refitted.bounds() == built.bounds());
        assert_eq!(refitted.world.scale, built.world.scale);
    }
}

#[test]
fn other_primitives_are_refused() {
    let mut world = World::default();
    world.push_mesh(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2]]);
    let one = world.geometry();
    world.push_mesh(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2]]);
    let mut accel = Accel::build_with(&one, Quality::High);
    assert_eq!(accel.refit(&world.geometry()).unwrap_err().what, "groups");
    let mut planes = one.clone();
    planes.planes.push([0.0; 3], [0.0, 1.0, 0.0], 0);
    assert_eq!(accel.refit(&planes).unwrap_err().what, "planes");
}
