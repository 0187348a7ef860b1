//! What may hit, gathered so that the loops over it have nothing to guess.

use wide::u32x8;

use crate::accel::order::ascending;
use crate::math::WIDTH;

/// A row and one of its eight lanes: a ray under way and a triangle of its leaf, a primitive of a leaf and a packet.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Candidate(u32);

impl Candidate {
    #[inline(always)]
    pub(super) fn new(row: usize, lane: usize) -> Self {
        Self((row * WIDTH + lane) as u32)
    }
    #[inline(always)]
    pub(super) fn row(self) -> usize {
        self.0 as usize / WIDTH
    }
    #[inline(always)]
    pub(super) fn lane(self) -> usize {
        self.0 as usize % WIDTH
    }
}

/// Candidates of so many rows, eight of them each. Eight are written at a time: one row more.
pub(super) const fn room_for(rows: usize) -> usize {
    (rows + 1) * WIDTH
}

/// A list of candidates.
#[derive(Debug)]
pub(super) struct Candidates<const ROOM: usize> {
    list: [u32; ROOM],
    len: usize,
}

impl<const ROOM: usize> Default for Candidates<ROOM> {
    fn default() -> Self {
        Self { list: [0; ROOM], len: 0 }
    }
}

impl<const ROOM: usize> Candidates<ROOM> {
    #[inline(always)]
    pub(super) fn len(&self) -> usize {
        self.len
    }
    #[inline(always)]
    pub(super) fn clear(&mut self) {
        self.len = 0;
    }
    #[inline(always)]
    pub(super) fn get(&self, i: usize) -> Candidate {
        Candidate(self.list[i])
    }

    /// Appends the lanes given as bits, without a branch on how many they are.
    #[inline(always)]
    pub(super) fn push(&mut self, row: usize, lanes: u32) {
        let first = u32x8::splat((row * WIDTH) as u32);
        let eight = first | (ascending(lanes) & u32x8::splat(WIDTH as u32 - 1));
        self.list[self.len..][..WIDTH].copy_from_slice(&eight.to_array());
        self.len += lanes.count_ones() as usize;
    }

    /// Eight candidates from `first` on and how many of them count; the last stands in for those that are not there.
    #[inline(always)]
    pub(super) fn eight(&self, first: usize) -> ([Candidate; WIDTH], usize) {
        let count = WIDTH.min(self.len - first);
        (crate::math::eight(|i| self.get(first + i.min(count - 1))), count)
    }
}
