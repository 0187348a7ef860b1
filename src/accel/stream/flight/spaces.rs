//! Rays on their way into the spaces of instances, eight at a time.

use wide::{f32x8, u32x8};

use super::view::Views;
use super::{Flight, LEAVE, SlotSet};
use crate::accel::Accel;
use crate::accel::leaf::cull_rays_by;
use crate::accel::node::ChildRef;
use crate::accel::query::Query;
use crate::intersect::{RayLanes, Tier};
use crate::math::{Lane, WIDTH, eight};

impl<T: Tier, Q: Query<T::Real> + Copy> Flight<T, Q> {
    /// Takes the rays that are at instances into their spaces.
    #[inline(never)]
    pub(super) fn enter_instances(&mut self, accel: &Accel, mut at_instances: SlotSet) {
        while !at_instances.is_empty() {
            let (at, count) = at_instances.take_eight();
            let placed = eight(|i| accel.placed(self.slots[at[i]].next));
            let rays = RayLanes::<T::Wide>::of_rows(eight(|i| self.slots[at[i]].row_of_ray()));
            let local = Accel::local_to_each(&placed, &rays);
            // Groups hold no instances, so nothing beyond their own size counts, wherever rays start.
            let scale = f32x8::from_fn(|i| placed[i].tree.scale);
            let views = Views::<T>::new(local, cull_rays_by::<T>(&local, |_| scale));
            for i in 0..count {
                self.slots[at[i]].enter(&views, i, placed[i].row);
                self.push_root(at[i], placed[i].tree.node);
            }
        }
    }

    /// Puts the root of a group on the stack of a ray, on top of the note that brings it back out.
    fn push_root(&mut self, at: usize, root: u32) {
        let slot = &mut self.slots[at];
        let mut below = [LEAVE.bits(); WIDTH];
        below[1] = ChildRef::node(root).bits();
        let anywhere = f32x8::splat(f32::NEG_INFINITY);
        self.stacks.write(slot.top as usize, u32x8::new(below), anywhere);
        slot.top += 2;
    }
}
