//! Corners of faces to vertices: equal corners share one.

use super::obj_text::NONE;
use std::collections::HashMap;

/// The vertices of a run of faces. Corners are looked up by position, of which most have one or few vertices; only behind
/// these there is a map.
pub(super) struct Vertices {
    /// Different corners, in the order in which they appear.
    pub(super) all: Vec<[u32; 3]>,
    /// For each position the last vertex there, if `all` agrees: it may be from an earlier run.
    last: Vec<u32>,
    /// For each vertex the one before it at the same position.
    before: Vec<u32>,
    /// Vertices at positions that have many.
    crowded: HashMap<[u32; 3], u32>,
}

/// So many vertices of a position are looked at one by one.
const FEW: usize = 16;

impl Vertices {
    pub(super) fn new(positions: usize) -> Self {
        Self { all: Vec::new(), last: vec![NONE; positions], before: Vec::new(), crowded: HashMap::new() }
    }

    /// The vertex of each corner of a run; those of the run before are forgotten.
    pub(super) fn number(&mut self, corners: &[[u32; 3]]) -> Vec<u32> {
        self.all.clear();
        self.before.clear();
        self.crowded.clear();
        corners.iter().map(|&corner| self.find_or_add(corner)).collect()
    }

    fn find_or_add(&mut self, corner: [u32; 3]) -> u32 {
        let position = corner[0] as usize;
        let last = self.last[position];
        let last = if self.all.get(last as usize).is_some_and(|v| v[0] == corner[0]) { last } else { NONE };
        let added = self.all.len() as u32;
        let mut at = last;
        for _ in 0..FEW {
            match self.all.get(at as usize) {
                Some(vertex) if *vertex == corner => return at,
                Some(_) => at = self.before[at as usize],
                None => {
                    self.last[position] = added;
                    self.push(corner, last);
                    return added;
                }
            }
        }
        let number = *self.crowded.entry(corner).or_insert(added);
        if number == added {
            self.push(corner, NONE);
        }
        number
    }

    fn push(&mut self, corner: [u32; 3], before: u32) {
        self.all.push(corner);
        self.before.push(before);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_numbered_as_by_a_map_run_after_run() {
        let mut vertices = Vertices::new(7);
        for run in 0..20_u32 {
            let corner = |i: u32| [i * i % 7, i * run % 31, i / 3 % (1 + run)];
            let corners: Vec<[u32; 3]> = (run..400).map(corner).collect();
            let mut map = HashMap::new();
            let expected: Vec<u32> = corners
                .iter()
                .map(|&corner| {
                    let next = map.len() as u32;
                    *map.entry(corner).or_insert(next)
                })
                .collect();
            assert_eq!(vertices.number(&corners), expected);
            assert_eq!(vertices.all.len(), map.len());
        }
    }
}
