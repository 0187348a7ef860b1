//! Trees over triangles stay within bounded memory where the surface area heuristic alone would not.

use super::super::cut::Cuttable;
use super::*;
use crate::intersect::triangle;

/// Promised for triangles, where there are enough of them that the root counts for nothing.
const PROMISED: usize = 100;

struct Corners(Vec<[[f32; 3]; 3]>);

impl Cuttable for Corners {
    fn corners(&self, primitive: u32) -> Option<[[f32; 3]; 3]> {
        Some(self.0[primitive as usize])
    }
}

/// Bytes a triangle of trees of all qualities, after they proved sound.
fn bytes_a_triangle(triangles: Vec<[[f32; 3]; 3]>) -> [usize; 3] {
    let primitive = |corners: &[[f32; 3]; 3]| BuildPrimitive { bounds: triangle::bounds(*corners), kind: 1 };
    let primitives: Vec<_> = triangles.iter().map(primitive).collect();
    let bytes = |tree: &Tree| tree.nodes.len() * NODE_BYTES + tree.leaves.len() * BLOCK_BYTES[1];
    sound_trees(&primitives, &Corners(triangles)).map(|(tree, _)| bytes(&tree) / primitives.len())
}

/// Long and thin, in all directions: leaves of fewer are always smaller.
fn needles(count: u32, length: f32) -> Vec<[[f32; 3]; 3]> {
    let point = |i: u32, scale: f32| [0, 1, 2].map(|k| scale * unit(3 * i + k));
    let add = |a: [f32; 3], b: [f32; 3]| std::array::from_fn(|k| a[k] + b[k]);
    let needle = |i: u32| {
        let from = point(3 * i, 1.0);
        let to = add(from, point(3 * i + 1, length));
        [from, to, add(to, point(3 * i + 2, 1e-4))]
    };
    (0..count).map(needle).collect()
}

#[test]
fn needles_take_no_more_than_is_promised() {
    for length in [0.01, 0.1, 0.5] {
        let bytes = bytes_a_triangle(needles(30_000, length));
        assert!(bytes.iter().all(|&bytes| bytes <= PROMISED), "{length}: {bytes:?}");
    }
}

/// Sparse specks, each far from the next, inside a box that dwarfs them all: the price is found whatever the scale.
#[test]
fn specks_in_a_vast_box_take_no_more_than_is_promised() {
    let mut triangles = needles(30_000, 0.1);
    triangles.push([[-1e6, -1.0, -1e6], [1e6, -1.0, -1e6], [0.0, -1.0, 1e6]]);
    let bytes = bytes_a_triangle(triangles);
    assert!(bytes.iter().all(|&bytes| bytes <= PROMISED), "{bytes:?}");
}

/// Within near caches no ray pays for memory: the tree is the one of least cost.
#[test]
fn small_trees_may_take_what_they_like() {
    let few = bytes_a_triangle(needles(1_000, 0.5));
    assert!(few[1] > PROMISED, "{few:?}");
}
