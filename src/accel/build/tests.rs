//! Whole trees: hard inputs, random inputs, and the same bytes for any number of threads.

mod hard;
mod memory;
mod parts;

use proptest::prelude::*;

use super::*;
use crate::accel::validate::{TreeStats, validate, validate_cut};

pub(super) fn cube(center: [f32; 3], half: f32, kind: u8) -> BuildPrimitive {
    let bounds = Aabb { min: center.map(|c| c - half), max: center.map(|c| c + half) };
    BuildPrimitive { bounds, kind }
}

/// Well mixed words for made-up scenes.
fn noise(i: u32) -> u32 {
    let x = (i ^ i >> 16).wrapping_mul(0x7feb_352d);
    let x = (x ^ x >> 15).wrapping_mul(0x846c_a68b);
    x ^ x >> 16
}

pub(super) fn unit(i: u32) -> f32 {
    (noise(i) >> 8) as f32 / (1 << 24) as f32
}

fn soup(count: u32, kinds: u32) -> Vec<BuildPrimitive> {
    let center = |i: u32| [unit(4 * i), unit(4 * i + 1), unit(4 * i + 2)];
    (0..count).map(|i| cube(center(i), 0.01 * unit(4 * i + 3), 1 + (noise(i) % kinds) as u8)).collect()
}

const QUALITIES: [Quality; 3] = [Quality::Fast, Quality::Balanced, Quality::High];

/// The balanced tree, after trees of all qualities proved sound.
fn sound(primitives: &[BuildPrimitive]) -> (Tree, TreeStats) {
    let [_, balanced, _] = sound_trees(primitives, &Uncut);
    balanced
}

fn sound_trees(primitives: &[BuildPrimitive], triangles: &impl Cuttable) -> [(Tree, TreeStats); 3] {
    QUALITIES.map(|quality| {
        let tree = build(primitives, quality, triangles);
        let stats = validate_cut(&tree, primitives, triangles);
        let stats = stats.unwrap_or_else(|fault| panic!("{quality:?}: {fault}"));
        (tree, stats)
    })
}

fn bytes(tree: &Tree) -> Vec<u32> {
    let node = |node: &Node8| {
        let boxes = node.lo.iter().chain(&node.hi).flatten().map(|x| x.to_bits());
        boxes.chain(node.child.iter().map(|child| child.bits())).collect::<Vec<u32>>()
    };
    tree.nodes.iter().flat_map(node).chain(tree.order.iter().copied()).collect()
}

#[test]
fn few_primitives() {
    for (count, leaves) in [(0, 0), (1, 1), (2, 1), (8, 1), (9, 2)] {
        let (tree, stats) = sound(&vec![cube([1.0; 3], 1.0, 3); count]);
        assert_eq!((stats.leaves, stats.nodes, tree.max_depth), (leaves, 1, 1), "{count} primitives");
        assert_eq!(tree.leaves_of(3).len(), leaves);
        assert!(tree.leaves_of(2).is_empty() && tree.leaves_of(4).is_empty());
    }
}

#[test]
fn eight_primitives_of_six_kinds_share_a_place() {
    let primitives: Vec<_> = (0..8).map(|i| cube([0.0; 3], 1.0, 1 + i % 6)).collect();
    let (tree, stats) = sound(&primitives);
    assert_eq!((stats.leaves, stats.nodes), (6, 1));
    assert_eq!(tree.primitives(&tree.leaves_of(2)[0]), [1, 7]);
}

#[test]
fn coincident_primitives_fill_their_leaves() {
    let (tree, stats) = sound(&vec![cube([5.0; 3], 1.0, 1); 100_000]);
    assert_eq!(stats.leaves, 100_000 / 8);
    assert!(tree.max_depth <= 17, "depth {}", tree.max_depth);
    let (tree, _) = sound(&(0..10_000).map(|i| cube([5.0; 3], 1.0, 1 + i as u8 % 6)).collect::<Vec<_>>());
    assert!(tree.max_depth <= 20, "depth {}", tree.max_depth);
}

#[test]
fn points_on_a_line_have_no_area_and_still_spread() {
    let primitives: Vec<_> = (0..50_000).map(|i| cube([i as f32, 0.0, 0.0], 0.0, 1)).collect();
    let (tree, stats) = sound(&primitives);
    assert!(tree.max_depth <= 10 && stats.mean_primitives >= 4.0, "{stats:?}, depth {}", tree.max_depth);
}

#[test]
fn one_huge_among_many_tiny() {
    let mut primitives = soup(20_000, 1);
    primitives.push(cube([0.0; 3], 1e30, 1));
    let (tree, _) = sound(&primitives);
    assert!(tree.max_depth <= 12, "depth {}", tree.max_depth);
}

/// Each cut at the best place would take a handful from the end, level after level.
#[test]
fn scales_over_the_whole_range_of_floats_stay_within_the_depth() {
    let at = |i: u32| 1.01_f32.powi((i % 17_000) as i32 - 8_500).clamp(1e-37, 1e30);
    let primitives: Vec<_> = (0..60_000).map(|i| cube([at(i), -at(i), at(i + 1)], at(i) * 0.5, 1)).collect();
    let (tree, _) = sound(&primitives);
    assert!(tree.max_depth <= MAX_DEPTH);
}

#[test]
fn the_ends_of_the_number_range_build() {
    let ends = [f32::MIN, -1e30, -0.0, 0.0, f32::MIN_POSITIVE / 4.0, 1e30, f32::MAX, f32::INFINITY];
    let interval = |i: u32| {
        let (a, b) = (ends[(noise(i) % 8) as usize], ends[(noise(i) / 8 % 8) as usize]);
        (a.min(b), a.max(b))
    };
    let primitive = |i: u32| {
        let ([x, y, z], kind) = ([interval(3 * i), interval(3 * i + 1), interval(3 * i + 2)], 1);
        BuildPrimitive { bounds: Aabb { min: [x.0, y.0, z.0], max: [x.1, y.1, z.1] }, kind }
    };
    sound(&(0..5_000).map(primitive).collect::<Vec<_>>());
    let everything = Aabb { min: [f32::NEG_INFINITY; 3], max: [f32::INFINITY; 3] };
    sound(&vec![BuildPrimitive { bounds: everything, kind: 2 }; 500]);
}

#[test]
fn threads_leave_no_trace() {
    let primitives = soup(GRAIN as u32 * 4 + 777, 3);
    for quality in QUALITIES {
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| build(&primitives, quality, &Uncut))
        };
        let (one, four) = (with(1), with(4));
        assert!(bytes(&one) == bytes(&four) && one == four);
        validate(&one, &primitives).unwrap();
    }
}

/// Parents come before children, subtrees are stretches, and leaves are numbered on the way.
#[test]
fn nodes_and_leaves_stand_in_depth_first_order() {
    let (tree, _) = sound(&soup(GRAIN as u32 * 2, 2));
    let (mut stack, mut next, mut next_leaf) = (vec![ChildRef::node(0)], 0, [0; KINDS]);
    while let Some(at) = stack.pop() {
        assert_eq!(at.index(), next);
        next += 1;
        let child = tree.nodes[at.index() as usize].child;
        for leaf in child.iter().filter(|child| child.is_leaf()) {
            assert_eq!(leaf.index(), next_leaf[usize::from(leaf.kind())]);
            next_leaf[usize::from(leaf.kind())] += 1;
        }
        stack.extend(child.iter().rev().filter(|child| child.is_node()));
    }
    assert_eq!(next as usize, tree.nodes.len());
}

#[test]
fn offset_moves_nodes_and_leaves_apart() {
    let (mut tree, _) = sound(&soup(1_000, 2));
    let before = tree.nodes.clone();
    tree.offset(&[100, 10, 20, 0, 0, 0, 0, 5]);
    for (old, new) in before.iter().zip(&tree.nodes) {
        for (old, new) in old.child.iter().zip(&new.child) {
            let by = [100, 10, 20, 0, 0, 0, 0, 0][usize::from(old.kind())];
            assert_eq!((new.kind(), new.index()), (old.kind(), old.index() + by));
        }
    }
}

/// A full leaf of a kind alone is not opened without need, and nodes are well filled.
#[test]
fn trees_are_well_filled() {
    let (_, stats) = sound(&soup(50_000, 1));
    assert!(stats.mean_children > 4.5 && stats.mean_primitives > 2.0, "{stats:?}");
}

#[test]
#[should_panic(expected = "no kind")]
fn kind_zero_is_refused() {
    build(&[cube([0.0; 3], 1.0, 0)], Quality::Balanced, &Uncut);
}

prop_compose! {
    /// Coordinates from a coarse grid as often as not: coincident centres and flat boxes are the hard case.
    fn primitive()(
        corners in prop::array::uniform6(prop_oneof![(-4_i8..4).prop_map(f32::from), -4.0_f32..4.0]),
        kind in 1..=ChildRef::LAST_KIND,
    ) -> BuildPrimitive {
        let [x, y, z, u, v, w] = corners;
        BuildPrimitive { bounds: Aabb::EMPTY.join_point([x, y, z]).join_point([u, v, w]), kind }
    }
}

proptest! {
    #[test]
    fn random_soups_of_mixed_kinds_are_sound(primitives in prop::collection::vec(primitive(), 0..400)) {
        for quality in QUALITIES {
            let tree = build(&primitives, quality, &Uncut);
            prop_assert!(validate(&tree, &primitives).is_ok(), "{:?}", validate(&tree, &primitives));
        }
    }
}
