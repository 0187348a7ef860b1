//! Memory for the columns of one depth: handed out in pieces, and kept from wave to wave.
//!
//! Plainly: columns of zeros from an arena. Departures:
//! - nothing is zeroed: in a new column stands whatever stood there before. Rows are written before they are read, and lanes
//!   beyond the last row are masked;
//! - columns begin at cache lines, so that eight rows lie in one;
//! - what does not fit comes from elsewhere, once: the next time there is room for it.

use std::cell::Cell;
use std::ops::Deref;

use bumpalo::Bump;
use bytemuck::Pod;

use crate::math::WIDTH;

/// Words in a cache line.
const LINE: usize = 64 / size_of::<u64>();

/// The least multiple of the packet width that holds `n`.
pub(super) fn padded(n: usize) -> usize {
    n.next_multiple_of(WIDTH)
}

/// Memory of one depth.
#[derive(Default)]
pub(super) struct Arena {
    words: Vec<u64>,
    more: Bump,
    /// Words that did not fit.
    missing: Cell<usize>,
}

impl Arena {
    /// Room for so many bytes, which cost nothing as long as they are not touched.
    pub(super) fn with_capacity(bytes: usize) -> Self {
        Self { words: vec![0; bytes / size_of::<u64>()], ..Self::default() }
    }

    /// All of the memory; nothing of what was handed out before is left.
    pub(super) fn open(&mut self) -> Room<'_> {
        let missing = self.missing.take();
        if missing > 0 {
            self.more = Bump::new();
            self.words = vec![0; self.words.len() + missing + LINE];
        }
        let skipped = self.words.as_ptr().align_offset(64).min(self.words.len());
        let rest = Cell::new(&mut self.words[skipped..]);
        Room { rest, more: &self.more, missing: &self.missing }
    }
}

/// What is left of an arena.
pub(super) struct Room<'a> {
    rest: Cell<&'a mut [u64]>,
    more: &'a Bump,
    missing: &'a Cell<usize>,
}

impl<'a> Room<'a> {
    /// A column of `n` rows, padded, with anything in them.
    pub(super) fn column<T: Pod>(&self, n: usize) -> &'a mut [T] {
        let n = padded(n);
        let words = (n * size_of::<T>()).div_ceil(size_of::<u64>()).next_multiple_of(LINE);
        &mut bytemuck::cast_slice_mut(self.words(words))[..n]
    }

    /// A list for so many rows.
    pub(super) fn list(&self, capacity: usize) -> List<'a> {
        // Eight are written at a time, from any place on.
        List { rows: self.column(if capacity == 0 { 0 } else { capacity + WIDTH }), len: 0 }
    }

    fn words(&self, n: usize) -> &'a mut [u64] {
        let rest = self.rest.take();
        if n <= rest.len() {
            let (words, rest) = rest.split_at_mut(n);
            self.rest.set(rest);
            return words;
        }
        self.rest.set(rest);
        self.missing.set(self.missing.get() + n);
        self.more.alloc_slice_fill_copy(n, 0)
    }
}

/// Rows of columns.
pub(super) struct List<'a> {
    rows: &'a mut [u32],
    len: usize,
}

impl List<'_> {
    /// Appends a row.
    #[inline(always)]
    pub(super) fn push(&mut self, row: u32) {
        self.rows[self.len] = row;
        self.len += 1;
    }
    /// Appends the first `count` of eight rows.
    #[inline(always)]
    pub(super) fn extend(&mut self, rows: &[u32; WIDTH], count: usize) {
        self.rows[self.len..self.len + WIDTH].copy_from_slice(rows);
        self.len += count;
    }
}

impl Deref for List<'_> {
    type Target = [u32];

    #[inline(always)]
    fn deref(&self) -> &[u32] {
        &self.rows[..self.len]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_does_the_next_time() {
        let mut arena = Arena::default();
        for missing in [true, false, false] {
            let room = arena.open();
            let columns = [room.column::<f64>(1000), room.column(3)];
            assert_eq!(columns.map(|column| column.len()), [1000, 8]);
            assert_eq!(room.missing.get() > 0, missing);
        }
    }

    #[test]
    fn columns_do_not_overlap_and_begin_at_cache_lines() {
        let mut arena = Arena::with_capacity(1 << 12);
        let room = arena.open();
        let (bytes, words, numbers) = (room.column::<u8>(3), room.column::<u32>(20), room.column::<f64>(9));
        bytes.fill(1);
        words.fill(2);
        numbers.fill(3.0);
        assert_eq!((bytes.len(), words.len(), numbers.len()), (8, 24, 16));
        assert!(bytes.iter().all(|&x| x == 1) && words.iter().all(|&x| x == 2));
        assert!([words.as_ptr().align_offset(64), numbers.as_ptr().align_offset(64)] == [0, 0]);
    }

    #[test]
    fn lists_hold_what_was_pushed() {
        let mut arena = Arena::default();
        let room = arena.open();
        let mut list = room.list(5);
        list.push(7);
        list.extend(&[1, 2, 3, 4, 5, 6, 7, 8], 3);
        list.push(9);
        assert_eq!(*list, [7, 1, 2, 3, 9]);
    }
}
