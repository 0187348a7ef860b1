//! Sets of slots, as bits of a word: loops over them have nothing to look up, and moving between them takes no branch.

use std::num::NonZero;
use std::ops::{BitAnd, BitOr, BitOrAssign, Not};

use crate::math::WIDTH;

/// Rays under way.
pub(super) const SLOTS: usize = u32::BITS as usize;

/// Some of the slots.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct SlotSet(u32);

impl SlotSet {
    pub(super) fn len(self) -> usize {
        self.0.count_ones() as usize
    }
    pub(super) fn is_empty(self) -> bool {
        self.0 == 0
    }
    /// Adds a slot if it is wanted.
    #[inline(always)]
    pub(super) fn insert_if(&mut self, wanted: bool, at: usize) {
        self.0 |= u32::from(wanted) << (at % SLOTS);
    }
    /// Takes out up to eight, and says how many those are; the last stands in for those that are not there.
    pub(super) fn take_eight(&mut self) -> ([usize; WIDTH], usize) {
        let (mut eight, mut count) = ([0; WIDTH], 0);
        for i in 0..WIDTH {
            count += usize::from(!self.is_empty());
            eight[i] = self.next().unwrap_or(eight[i.saturating_sub(1)]);
        }
        (eight, count)
    }
}

/// Takes out the lowest.
impl Iterator for SlotSet {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        let bits = NonZero::new(self.0)?;
        self.0 &= self.0 - 1;
        Some(bits.trailing_zeros() as usize)
    }
}

impl BitOr for SlotSet {
    type Output = Self;
    fn bitor(self, o: Self) -> Self {
        Self(self.0 | o.0)
    }
}

impl BitOrAssign for SlotSet {
    fn bitor_assign(&mut self, o: Self) {
        *self = *self | o;
    }
}

impl BitAnd for SlotSet {
    type Output = Self;
    fn bitand(self, o: Self) -> Self {
        Self(self.0 & o.0)
    }
}

impl Not for SlotSet {
    type Output = Self;
    fn not(self) -> Self {
        Self(!self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(slots: &[usize]) -> SlotSet {
        let mut set = SlotSet::default();
        slots.iter().for_each(|&at| set.insert_if(true, at));
        set
    }

    #[test]
    fn slots_come_out_in_order_and_once() {
        let some = set(&[31, 0, 7, 7, 12]);
        assert_eq!(some.len(), 4);
        assert_eq!(some.collect::<Vec<_>>(), [0, 7, 12, 31]);
        assert_eq!((some & !set(&[0, 31])).collect::<Vec<_>>(), [7, 12]);
        assert_eq!((!SlotSet::default()).collect::<Vec<_>>(), (0..SLOTS).collect::<Vec<_>>());
    }

    #[test]
    fn unwanted_slots_stay_out() {
        let mut some = set(&[3]);
        some.insert_if(false, 4);
        assert_eq!(some, set(&[3]));
    }

    #[test]
    fn eight_at_a_time_until_none_is_left() {
        let mut some = set(&[1, 2, 3, 5, 8, 13, 21, 30, 31, 29]);
        assert_eq!(some.take_eight(), ([1, 2, 3, 5, 8, 13, 21, 29], 8));
        assert_eq!(some.take_eight(), ([30, 31, 31, 31, 31, 31, 31, 31], 2));
        assert!(some.is_empty() && some.take_eight().1 == 0);
    }
}
