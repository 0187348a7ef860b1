use proptest::prelude::*;

use super::super::binary::grow;
use super::super::item::{Extent, Item};
use super::super::tests::{cube, unit};
use super::super::{BuildPrimitive, MAX_DEPTH, Quality};
use super::*;
use crate::math::Aabb;

/// A hall: long beams in bundles among small things, which splitting parts late.
fn hall(count: u32) -> Vec<BuildPrimitive> {
    let beam = |i: u32| {
        let bundle = i / 8;
        let place = |k: u32| unit(3 * bundle + k) + 0.01 * unit(3 * i + k + 77);
        let half = |k: u32| if k == bundle % 3 { 0.5 } else { 0.01 };
        let face = |sign: f32| [0, 1, 2].map(|k| place(k) + sign * half(k));
        BuildPrimitive { bounds: Aabb { min: face(-1.0), max: face(1.0) }, kind: 1 }
    };
    let thing = |i: u32| cube([unit(7 * i), unit(7 * i + 1), unit(7 * i + 2)], 0.003, 1);
    (0..count / 8).map(beam).chain((0..count - count / 8).map(thing)).collect()
}

fn items(primitives: &[BuildPrimitive]) -> Vec<Item> {
    primitives.iter().enumerate().map(|(i, primitive)| Item::new(i as u32, primitive)).collect()
}

fn grown(primitives: &[BuildPrimitive]) -> (Vec<BinaryNode>, Vec<Item>) {
    let mut items = items(primitives);
    let extent = Extent::of(&items);
    (grow(&mut items, &extent, Quality::Balanced), items)
}

/// What holds of a binary tree in depth-first order; gives the depth.
fn check(nodes: &[BinaryNode], items: &[Item], at: usize) -> u32 {
    let node = &nodes[at];
    let range = &items[node.first as usize..][..node.len as usize];
    let around = range.iter().fold(Box8::EMPTY, |all, item| all.join(item.bounds)).to_aabb();
    assert_eq!(around, node.bounds);
    if node.right == 0 {
        return 0;
    }
    let (left, right) = (at + 1, at + node.right as usize);
    assert_eq!(nodes[left].first, node.first);
    assert_eq!(nodes[right].first, node.first + nodes[left].len);
    assert_eq!(node.len, nodes[left].len + nodes[right].len);
    1 + check(nodes, items, left).max(check(nodes, items, right))
}

fn numbers(items: &[Item]) -> Vec<u32> {
    let mut numbers: Vec<u32> = items.iter().map(Item::number).collect();
    numbers.sort_unstable();
    numbers
}

#[test]
fn a_tree_without_moves_is_laid_out_as_it_came() {
    let (nodes, items) = grown(&hall(500));
    let (same, order) = Linked::of(&nodes).unwrap().laid_out(&nodes, &items).unwrap();
    assert!(nodes.iter().zip(&same).all(|(a, b)| format!("{a:?}") == format!("{b:?}")));
    assert!(items.iter().zip(&order).all(|(a, b)| a.number() == b.number()));
    assert!(Linked::of(&[]).is_none());
}

#[test]
fn a_hall_gains_and_stays_a_tree() {
    let (nodes, items) = grown(&hall(4_000));
    let area = |tree: &Linked| largest(tree, 0).1;
    let before = area(&Linked::of(&nodes).unwrap());
    let tree = improved(&nodes).unwrap();
    assert!(area(&tree) < 0.95 * before, "{} of {before}", area(&tree));
    let (moved, order) = tree.laid_out(&nodes, &items).unwrap();
    assert!(check(&moved, &order, 0) <= MAX_DEPTH && moved.len() == nodes.len());
    assert!(numbers(&order).into_iter().eq(0..4_000));
}

#[test]
fn a_tree_that_gains_nothing_stays_as_it_is() {
    let even: Vec<_> =
        (0..4_096).map(|i| cube([i % 16, i / 16 % 16, i / 256].map(|x| x as f32), 0.4, 1)).collect();
    assert!(improved(&grown(&even).0).is_none());
    let everywhere = Aabb { min: [f32::NEG_INFINITY; 3], max: [f32::INFINITY; 3] };
    assert!(improved(&grown(&vec![BuildPrimitive { bounds: everywhere, kind: 1 }; 99]).0).is_none());
    assert!(improved(&[]).is_none());
}

#[test]
fn threads_leave_no_trace() {
    let (nodes, items) = grown(&hall(20_000));
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let (nodes, items) = pool.install(|| reinsert(nodes.clone(), items.clone()));
        (format!("{nodes:?}"), items.iter().map(Item::number).collect::<Vec<_>>())
    };
    let one = with(1);
    assert!(one == with(3) && one.1 != items.iter().map(Item::number).collect::<Vec<_>>());
}

prop_compose! {
    /// From points to boxes as large as all.
    fn primitive()(a in prop::array::uniform3(-4_i8..4), size in prop::array::uniform3(0_u8..6)) -> BuildPrimitive {
        let min = a.map(f32::from);
        let max = std::array::from_fn(|k| min[k] + f32::from(size[k] * size[k]));
        BuildPrimitive { bounds: Aabb { min, max }, kind: 1 }
    }
}

proptest! {
    /// Boxes that overlap as they like look for each other's places: no move puts a subtree below itself.
    #[test]
    fn any_moves_keep_a_tree(primitives in prop::collection::vec(primitive(), 1..300)) {
        let (nodes, items) = grown(&primitives);
        let mut tree = Linked::of(&nodes).unwrap();
        for _ in 0..4 {
            moving_pays(&mut tree, nodes.len(), 0.0);
            let (moved, order) = tree.laid_out(&nodes, &items).unwrap();
            check(&moved, &order, 0);
            prop_assert!(moved.len() == nodes.len() && numbers(&order) == numbers(&items));
        }
    }
}
