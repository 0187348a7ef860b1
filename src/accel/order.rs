//! Orders of up to eight chosen lanes, as lane numbers to shuffle by: a table in place of sorting.

use wide::u32x8;

use crate::math::WIDTH;

/// By octant and by the children that a ray meets: slots of the children in four bits each, the last to visit lowest.
static ORDER: [[u32; 256]; WIDTH] = orders();

const fn orders() -> [[u32; 256]; WIDTH] {
    let mut table = [[0; 256]; WIDTH];
    let mut octant = 0;
    while octant < WIDTH {
        let mut meets = 0;
        while meets < 256 {
            let (mut i, mut count) = (WIDTH, 0);
            while i > 0 {
                i -= 1;
                let slot = i ^ octant;
                if meets >> slot & 1 != 0 {
                    table[octant][meets] |= (slot as u32) << (4 * count);
                    count += 1;
                }
            }
            meets += 1;
        }
        octant += 1;
    }
    table
}

/// An order of up to eight lanes.
#[derive(Clone, Copy)]
pub(super) struct Order(u32);

impl Order {
    /// The lanes from the first on; those beyond the ones chosen mean nothing, and neither do the higher bits of each.
    #[inline(always)]
    pub(super) fn lanes(self) -> u32x8 {
        lanes(self.0)
    }
    /// The first `count` lanes, one after the other.
    #[inline(always)]
    pub(super) fn take(self, count: u32) -> impl Iterator<Item = usize> {
        (0..count).map(move |i| (self.0 >> (4 * i)) as usize & 7)
    }
    /// The last of `count` lanes; any lane if there are none.
    #[inline(always)]
    pub(super) fn last(self, count: u32) -> usize {
        (self.0 >> ((4 * count).wrapping_sub(4) & 31)) as usize & 7
    }
}

#[inline(always)]
fn lanes(order: u32) -> u32x8 {
    u32x8::splat(order) >> u32x8::new([0, 4, 8, 12, 16, 20, 24, 28])
}

/// The chosen children of a node, the last that a ray of an octant visits first. **Needs:** lanes below 256.
#[inline(always)]
pub(super) fn far_first(octant: u32, chosen: u32) -> Order {
    Order(ORDER[octant as usize & 7][chosen as usize & 0xff])
}

/// The chosen lanes, ascending.
#[inline(always)]
pub(super) fn ascending(chosen: u32) -> u32x8 {
    // The last octant's last child stands in the first slot.
    far_first(7, chosen).lanes()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_octant_visits_slot_xor_octant_and_pushes_the_last_first() {
        for octant in 0..WIDTH as u32 {
            for chosen in 0..256u32 {
                let mut expected = (0..8).rev().map(|i| i ^ octant).filter(|slot| chosen >> slot & 1 != 0);
                let order = far_first(octant, chosen);
                let lanes = order.lanes().to_array();
                assert!(
                    expected.clone().zip(lanes).all(|(slot, lane)| slot == lane & 7),
                    "{octant} {chosen:#b}"
                );
                let last = expected.next_back().map(|slot| slot as usize);
                let found = order.last(chosen.count_ones());
                assert!(found < WIDTH && last.is_none_or(|last| last == found), "{octant} {chosen:#b}");
            }
        }
    }

    #[test]
    fn ascending_lanes_ascend() {
        assert_eq!(ascending(0b1010_0110).to_array().map(|lane| lane & 7)[..4], [1, 2, 5, 7]);
    }
}
