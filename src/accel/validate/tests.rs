//! Damaged trees: every kind of fault is found.

use super::super::build::{Quality, build};
use super::*;
use crate::intersect::testing::dice::Dice;

fn row(count: usize) -> Vec<BuildPrimitive> {
    let at = |i: usize| Aabb { min: [i as f32, 0.0, 0.0], max: [i as f32 + 0.5, 1.0, 1.0] };
    (0..count).map(|i| BuildPrimitive { bounds: at(i), kind: 1 + (i % 2) as u8 }).collect()
}

/// The fault that some damage to a sound tree of 200 primitives causes.
fn fault(damage: impl Fn(&mut Tree)) -> TreeFault {
    let primitives = row(200);
    let mut tree = build(&primitives, Quality::Balanced, &Uncut);
    validate(&tree, &primitives).unwrap();
    damage(&mut tree);
    validate(&tree, &primitives).unwrap_err()
}

fn first(tree: &Tree, wanted: fn(ChildRef) -> bool) -> (usize, usize) {
    let places = (0..tree.nodes.len()).flat_map(|node| (0..WIDTH).map(move |slot| (node, slot)));
    places.into_iter().find(|&(node, slot)| wanted(tree.nodes[node].child[slot])).unwrap()
}

fn redirect(tree: &mut Tree, wanted: fn(ChildRef) -> bool, to: ChildRef) {
    let (node, slot) = first(tree, wanted);
    tree.nodes[node].child[slot] = to;
}

#[test]
fn references_that_lead_astray_are_found() {
    let astray = |to| fault(move |tree| redirect(tree, ChildRef::is_node, to));
    assert!(matches!(astray(ChildRef::node(0)), TreeFault::ReachedTwice(_)));
    assert!(matches!(astray(ChildRef::node(1 << 20)), TreeFault::OutOfRange(_)));
    assert!(matches!(astray(ChildRef::leaf(2, 1 << 20)), TreeFault::OutOfRange(_)));
    assert!(matches!(astray(ChildRef::leaf(5, 0)), TreeFault::OutOfRange(_)));
    assert!(matches!(astray(ChildRef::EMPTY), TreeFault::FreeSlotHasBox(_)));
}

#[test]
fn wrong_boxes_leaves_and_totals_are_found() {
    let shrunk = |tree: &mut Tree| {
        let (node, slot) = first(tree, ChildRef::is_leaf);
        tree.nodes[node].hi[0][slot] -= 0.25;
    };
    assert!(matches!(fault(shrunk), TreeFault::Box(_)));
    assert!(matches!(fault(|tree| tree.leaves[0].len = 9), TreeFault::Leaf(_)));
    assert!(matches!(fault(|tree| tree.order.swap(0, 1)), TreeFault::Leaf(_)));
    assert!(matches!(fault(|tree| tree.leaves[0].len -= 1), TreeFault::Held { leaves: 0, .. }));
    assert!(matches!(fault(|tree| tree.max_depth += 1), TreeFault::Depth { .. }));
    assert!(matches!(fault(|tree| tree.nodes.push(tree.nodes[0])), TreeFault::Unreached(1)));
    assert_eq!(fault(|tree| tree.nodes.clear()), TreeFault::NoRoot);
    assert_eq!(fault(|tree| tree.bounds.max[0] += 1.0), TreeFault::Bounds);
}

/// Long triangles among short ones, so that cutting pays.
struct Sticks(Vec<[[f32; 3]; 3]>);

impl Cuttable for Sticks {
    fn corners(&self, primitive: u32) -> Option<[[f32; 3]; 3]> {
        Some(self.0[primitive as usize])
    }
}

#[test]
fn cut_triangles_must_be_covered() {
    let mut dice = Dice(5);
    let mut stick = |i: usize| {
        let a = dice.point().map(|x| 5.0 * x as f32);
        let aside = dice.point().map(|x| 0.02 * x as f32);
        let length = if i.is_multiple_of(5) { 8.0 } else { 0.1 };
        [a, a.map(|x| x + length), std::array::from_fn(|k| a[k] + aside[k])]
    };
    let sticks = Sticks((0..300).map(&mut stick).collect());
    let bounds = |&corners: &[[f32; 3]; 3]| crate::intersect::triangle::bounds(corners);
    let primitives: Vec<_> =
        sticks.0.iter().map(|corners| BuildPrimitive { bounds: bounds(corners), kind: 1 }).collect();
    let mut tree = build(&primitives, Quality::High, &sticks);
    let stats = validate_cut(&tree, &primitives, &sticks).unwrap();
    assert!(stats.mean_primitives * stats.leaves as f64 > 300.5, "some are cut: {stats:?}");
    assert!(validate(&tree, &primitives).is_err(), "what is cut is in no leaf whole");
    let often =
        |tree: &Tree, n: u32| tree.leaves.iter().filter(|leaf| tree.primitives(leaf).contains(&n)).count();
    let cut = (0..300).find(|&n| often(&tree, n) > 1).unwrap();
    let holds = |leaf: &Leaf| {
        leaf.len > 1 && tree.order[leaf.first as usize..][..usize::from(leaf.len)].contains(&cut)
    };
    let at = tree.leaves.iter().position(holds).unwrap();
    let leaf = tree.leaves[at];
    let stretch = &mut tree.order[leaf.first as usize..][..usize::from(leaf.len)];
    let place = stretch.iter().position(|&n| n == cut).unwrap();
    stretch[place..].rotate_left(1);
    tree.leaves[at].len -= 1;
    let fault = validate_cut(&tree, &primitives, &sticks).unwrap_err();
    assert_eq!(fault, TreeFault::Gap { primitive: cut as usize });
}
