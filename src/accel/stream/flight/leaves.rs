//! The primitives of the leaves that rays under way are at: first all that may be hit, then those, eight at a time.

use super::{Flight, SlotSet};
use crate::accel::Accel;
use crate::accel::leaf::Testable;
use crate::accel::query::Query;
use crate::intersect::{LaneHit, RayLanes, Tier};
use crate::math::{Lane, Mask, WIDTH, eight};

impl<T: Tier, Q: Query<T::Real> + Copy> Flight<T, Q> {
    /// Finds out which primitives of leaves of a kind may be hit, then tests those.
    #[inline(always)]
    pub(super) fn test_leaves<B: Testable>(&mut self, accel: &Accel, at_leaves: SlotSet) {
        self.candidates.clear();
        for at in at_leaves {
            self.candidates.push(at, self.slots[at].candidates::<B>(accel));
        }
        if self.candidates.len() <= B::FEW {
            return (0..self.candidates.len()).for_each(|i| self.test_candidate::<B>(accel, i));
        }
        for first in (0..self.candidates.len()).step_by(WIDTH) {
            self.test_candidates::<B>(accel, first);
        }
    }

    /// Tests one candidate.
    #[inline(always)]
    fn test_candidate<B: Testable>(&mut self, accel: &Accel, i: usize) {
        let pair = self.candidates.get(i);
        let slot = &mut self.slots[pair.row()];
        self.found.insert_if(slot.test::<B>(accel, pair.lane()), pair.row());
    }

    /// Tests up to eight candidates, whosever they are.
    #[inline(always)]
    fn test_candidates<B: Testable>(&mut self, accel: &Accel, first: usize) {
        let (pairs, count) = self.candidates.eight(first);
        let slots = eight(|i| &self.slots[pairs[i].row()]);
        let (blocks, lanes) = (eight(|i| B::of(accel, slots[i].next)), eight(|i| pairs[i].lane()));
        let rays = RayLanes::<T::Wide>::of_rows(eight(|i| slots[i].row_of_ray()));
        let limit = T::Wide::from_fn(|i| slots[i].query.limit());
        let hits = B::hit_candidates::<T>((&blocks, &lanes), Mask::from_bits((1 << count) - 1), &rays, limit);
        let mut left = hits.mask.bits() & ((1 << count) - 1);
        while left != 0 {
            let i = left.trailing_zeros() as usize & 7;
            left &= left - 1;
            let at = pairs[i].row();
            let id = blocks[i].ids()[pairs[i].lane()];
            let hit = LaneHit { mask: true, t: hits.t.get(i), u: hits.u.get(i), v: hits.v.get(i) };
            self.found.insert_if(self.slots[at].accept(&hit, id), at);
        }
    }
}
