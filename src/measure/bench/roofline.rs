//! The roof: box tests a second with everything in the nearest cache.

use std::hint::black_box;

use wide::f32x8;

use super::timing::{Spread, seconds};
use crate::accel::node::Node8;
use crate::intersect::aabb::CullRay;
use crate::math::{Lane, Mask, Vec3, WIDTH};

/// Nodes in the loop: 16 KiB.
const NODES: usize = 64;
/// Times that all nodes are tested in a run.
const ROUNDS: usize = 20_000;
const RUNS: usize = 15;

/// Tests of one ray against one box that this thread can do in a second: six fused slabs for the eight boxes of a node and
/// the mask of those that are met, with neither a stack nor a branch.
pub fn box_tests_a_second() -> f64 {
    let nodes: Vec<Node8> = (0..NODES).map(node).collect();
    let ray = CullRay::new(Vec3::splat([-1.0; 3]), Vec3::splat([1.0, 1.1, 0.9]), f32x8::splat(NODES as f32));
    let run = |_| {
        seconds(1, || {
            black_box(rounds(black_box(&nodes), black_box(&ray)));
        })
    };
    let spread = Spread::of(&std::array::from_fn::<f64, RUNS, _>(run));
    (NODES * ROUNDS * WIDTH) as f64 / spread.min
}

/// Eight boxes somewhere along the diagonal.
fn node(i: usize) -> Node8 {
    let at = i as f32;
    let side = |by: f32| [std::array::from_fn(|slot| at + slot as f32 * 0.25 + by); 3];
    Node8 { lo: side(0.0), hi: side(1.0), ..Node8::EMPTY }
}

fn rounds(nodes: &[Node8], ray: &CullRay<f32x8>) -> u32 {
    let mut met = 0u32;
    for round in 0..ROUNDS {
        let t_max = f32x8::splat(1e6 - round as f32);
        for node in nodes {
            let lanes = |c: &[[f32; WIDTH]; 3]| Vec3 { x: c[0].into(), y: c[1].into(), z: c[2].into() };
            let (enter, leave) = ray.interval(lanes(&node.lo), lanes(&node.hi), f32x8::splat(0.0), t_max);
            met = met.wrapping_add(Lane::le(enter, leave).bits());
        }
    }
    met
}
