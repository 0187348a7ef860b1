//! Triangles that rays under way may hit.

use wide::u32x8;

use super::SLOTS;
use crate::accel::order::ascending;
use crate::math::WIDTH;

/// The slot of a ray, and the lane of a triangle in the leaf that the ray is at.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Candidate(u32);

impl Candidate {
    #[inline(always)]
    pub(super) fn slot(self) -> usize {
        self.0 as usize / WIDTH
    }
    #[inline(always)]
    pub(super) fn lane(self) -> usize {
        self.0 as usize % WIDTH
    }
}

/// All of them; eight are written at a time.
const ROOM: usize = (SLOTS + 1) * WIDTH;

/// A list of candidates.
#[derive(Debug)]
pub(super) struct Candidates {
    list: [u32; ROOM],
    len: usize,
}

impl Default for Candidates {
    fn default() -> Self {
        Self { list: [0; ROOM], len: 0 }
    }
}

impl Candidates {
    #[inline(always)]
    pub(super) fn len(&self) -> usize {
        self.len
    }
    #[inline(always)]
    pub(super) fn clear(&mut self) {
        self.len = 0;
    }

    /// Appends the lanes given as bits, without a branch on how many they are.
    #[inline(always)]
    pub(super) fn push(&mut self, slot: usize, lanes: u32) {
        let first = u32x8::splat((slot * WIDTH) as u32);
        let eight = first | (ascending(lanes) & u32x8::splat(WIDTH as u32 - 1));
        self.list[self.len..][..WIDTH].copy_from_slice(&eight.to_array());
        self.len += lanes.count_ones() as usize;
    }

    /// Eight candidates from `first` on and how many of them count; the last stands in for those that are not there.
    #[inline(always)]
    pub(super) fn eight(&self, first: usize) -> ([Candidate; WIDTH], usize) {
        let count = WIDTH.min(self.len - first);
        let at = |i: usize| Candidate(self.list[first + i.min(count - 1)]);
        (crate::math::eight(at), count)
    }
}
