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

/// Hair: strands across all axes, of sixteen thin triangles each. The box of two of them has four times the area of one, so
/// without a bound every triangle has a leaf of its own.
fn hair(count: u32, length: f32) -> Vec<[[f32; 3]; 3]> {
    let triangle = |i: u32| {
        let (strand, step) = (i / 16, (i % 16) as f32);
        let at = |step: f32| {
            let along = |k: u32| length * (unit(6 * strand + k + 3) + 0.5) * step / 16.0;
            [0, 1, 2].map(|k| unit(6 * strand + k) + along(k))
        };
        let (from, to) = (at(step), at(step + 1.0));
        [from, to, [to[0], to[1] + 1e-4, to[2]]]
    };
    (0..count).map(triangle).collect()
}

#[test]
fn hair_takes_no_more_than_is_promised() {
    for length in [0.01, 0.1, 0.5] {
        let bytes = bytes_a_triangle(hair(32_000, length));
        assert!(bytes.iter().all(|&bytes| bytes <= PROMISED), "{length}: {bytes:?}");
    }
}

/// A floor that dwarfs the hair: the price is found whatever the scale.
#[test]
fn hair_over_a_vast_floor_takes_no_more_than_is_promised() {
    let mut triangles = hair(32_000, 0.1);
    triangles.push([[-1e6, -1.0, -1e6], [1e6, -1.0, -1e6], [0.0, -1.0, 1e6]]);
    let bytes = bytes_a_triangle(triangles);
    assert!(bytes.iter().all(|&bytes| bytes <= PROMISED), "{bytes:?}");
}

/// Within near caches no ray pays for memory: the tree is the one of least cost.
#[test]
fn small_trees_may_take_what_they_like() {
    let few = bytes_a_triangle(hair(600, 0.5));
    assert!(few[1] > PROMISED, "{few:?}");
}
