//! Numbers of primitives, leaf by leaf.

use rayon::prelude::*;

use super::item::{GRAIN, Item};
use super::{LEAF_SIZE, Leaf};

/// Bits of a number.
const NUMBER_BITS: u32 = 29;

/// Number and kind of a primitive: all that is left to know when boxes are in the nodes.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(super) struct Member(u32);

impl Member {
    fn of(item: &Item) -> Self {
        Self(u32::from(item.kind()) << NUMBER_BITS | item.number())
    }
    pub(super) fn number(self) -> u32 {
        self.0 & ((1 << NUMBER_BITS) - 1)
    }
    pub(super) fn kind(self) -> u8 {
        (self.0 >> NUMBER_BITS) as u8
    }
}

/// The items in their order, without their boxes.
pub(super) fn members(items: &[Item]) -> Vec<Member> {
    items.par_iter().with_min_len(GRAIN).map(Member::of).collect()
}

/// The numbers in the order of the members, sorted within each leaf. A leaf that got two parts of one triangle keeps one,
/// and what it does not need of its stretch stays unused.
pub(super) fn order(members: Vec<Member>, leaves: &mut [Leaf]) -> Vec<u32> {
    let mut order: Vec<u32> = members.into_iter().map(Member::number).collect();
    for leaf in leaves {
        let numbers = &mut order[leaf.first as usize..][..usize::from(leaf.len)];
        sort(numbers);
        leaf.len = dedup(numbers) as u8;
    }
    order
}

/// Sorts the numbers of a leaf; without a branch, for no two leaves are alike.
///
/// **Source:** Batcher's odd-even merge sort: Knuth, "The Art of Computer Programming", volume 3, section 5.3.4.
fn sort(numbers: &mut [u32]) {
    let mut places = [u32::MAX; LEAF_SIZE];
    for (place, &number) in places.iter_mut().zip(&*numbers) {
        *place = number;
    }
    let pair = |a: u32, b: u32| (a.min(b), a.max(b));
    let [a, b, c, d, e, f, g, h] = places;
    let ((a, e), (b, f), (c, g), (d, h)) = (pair(a, e), pair(b, f), pair(c, g), pair(d, h));
    let ((a, c), (b, d), (e, g), (f, h)) = (pair(a, c), pair(b, d), pair(e, g), pair(f, h));
    let ((c, e), (d, f)) = (pair(c, e), pair(d, f));
    let ((a, b), (c, d), (e, f), (g, h)) = (pair(a, b), pair(c, d), pair(e, f), pair(g, h));
    let ((b, e), (d, g)) = (pair(b, e), pair(d, g));
    let ((b, c), (d, e), (f, g)) = (pair(b, c), pair(d, e), pair(f, g));
    for (number, place) in numbers.iter_mut().zip([a, b, c, d, e, f, g, h]) {
        *number = place;
    }
}

/// Moves the first of each run of equals to the front; gives how many there are.
fn dedup(sorted: &mut [u32]) -> usize {
    if sorted.windows(2).all(|pair| pair[0] != pair[1]) {
        return sorted.len();
    }
    let mut kept = 0;
    for i in 0..sorted.len() {
        if kept == 0 || sorted[i] != sorted[kept - 1] {
            sorted[kept] = sorted[i];
            kept += 1;
        }
    }
    kept
}
