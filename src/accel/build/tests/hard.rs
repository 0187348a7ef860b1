//! A million triangles that leave a builder nothing to go by: trees of all qualities are sound, shallow and soon built.

use std::time::{Duration, Instant};

use super::*;
use crate::intersect::triangle;

const MILLION: u32 = 1_000_000;

/// Far more than a build needs on any machine, far less than one whose time grows with the square.
const LONGEST: Duration = Duration::from_secs(120);

/// Triangles by number.
struct Numbered<F>(F);

impl<F: Fn(u32) -> [[f32; 3]; 3] + Sync> Cuttable for Numbered<F> {
    fn corners(&self, primitive: u32) -> Option<[[f32; 3]; 3]> {
        Some((self.0)(primitive))
    }
}

/// The greatest depth of the trees over so many triangles.
fn depth(count: u32, corners: impl Fn(u32) -> [[f32; 3]; 3] + Sync) -> u32 {
    let bounds = |i| BuildPrimitive { bounds: triangle::bounds(corners(i)), kind: 1 };
    let primitives: Vec<_> = (0..count).map(bounds).collect();
    let begun = Instant::now();
    let trees = sound_trees(&primitives, &Numbered(&corners));
    assert!(begun.elapsed() < LONGEST, "{:?}", begun.elapsed());
    let references = |stats: &TreeStats| stats.mean_primitives * stats.leaves as f64;
    assert!(trees.iter().all(|(_, stats)| references(stats) <= 1.5 * f64::from(count) + 1.0));
    trees.iter().map(|(tree, _)| tree.max_depth).max().unwrap_or(0)
}

#[test]
fn coincident_triangles() {
    let one = [[0.0, 0.0, 0.0], [1.0, 0.5, 0.0], [0.0, 1.0, 1.0]];
    assert!(depth(MILLION, |_| one) <= 20);
}

#[test]
fn one_centre_for_triangles_of_all_sizes() {
    let sized = |i: u32| {
        let s = 1.0 + i as f32;
        [[-s, -s, -s], [s, s, -s], [0.0, 0.0, s]]
    };
    assert!(depth(MILLION, sized) <= 20);
}

#[test]
fn collinear_points() {
    assert!(depth(MILLION, |i| [[i as f32, 0.0, 0.0]; 3]) <= 20);
    assert!(depth(100_000, |i| [[i as f32, i as f32, i as f32]; 3]) <= 20);
}

#[test]
fn one_huge_with_many_tiny() {
    let tiny = |i: u32| {
        let at = [unit(3 * i), unit(3 * i + 1), unit(3 * i + 2)];
        [at, [at[0] + 1e-3, at[1], at[2]], [at[0], at[1] + 1e-3, at[2] + 1e-3]]
    };
    let huge = [[-1e30, 0.0, 0.0], [1e30, 1e30, 0.0], [0.0, -1e30, 1e30]];
    assert!(depth(MILLION, |i| if i == 77 { huge } else { tiny(i) }) <= 24);
}

/// Every triangle crosses every other: cutting them all could go on for ever.
#[test]
fn long_triangles_through_one_another() {
    let long = |i: u32| {
        let [a, b] = [0, 3].map(|k| [unit(6 * i + k), unit(6 * i + k + 1), unit(6 * i + k + 2)]);
        [a, b, [b[0], b[1] + 1e-3, b[2]]]
    };
    assert!(depth(100_000, long) <= 30);
}

#[test]
fn coordinates_up_to_the_largest_number() {
    let far = |i: u32| {
        let x = |k: u32| (2.0 * unit(9 * i + k) - 1.0) * f32::MAX;
        [[x(0), x(1), x(2)], [x(3), x(4), x(5)], [x(6), x(7), x(8)]]
    };
    assert!(depth(20_000, far) <= 40);
}
