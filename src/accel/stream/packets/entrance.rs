//! Where packets enter the tree: below the nodes that all of their rays would go through.

use std::ops::Range;

use super::super::frustum::Apex;
use super::{Fate, Packets};
use crate::accel::entry::{Entry, enter};
use crate::accel::region::Region;
use crate::intersect::Tier;

/// Nodes that rays must be spared for a common entry to pay.
const SPARED: usize = 3;

/// Where rays enter the tree, and the region that they stay in if that is known.
pub(super) type Entrance = (Entry, Option<Region>);

impl<T: Tier> Packets<'_, T> {
    /// Where packets enter the tree that have an apex in common, if their pyramid spares them anything.
    #[inline(never)]
    pub(super) fn enter_by_apex(
        &mut self,
        apex: Apex,
        fate: Fate,
        packets: Range<usize>,
    ) -> Option<Entrance> {
        let (world, frustum) = (self.accel.world, &mut *self.frustum);
        let rays = &self.rays[packets];
        if fate == Fate::None {
            frustum.surround::<T>(rays, apex, world)?;
        }
        // They start anew, whatever the bundle has found.
        rays.iter().enumerate().for_each(|(j, rays)| frustum.look(j, T::above_f32(rays.t_max)));
        frustum.update_reach();
        let entry = enter(self.accel, world.node, |node| frustum.children(node).0);
        (entry.spared >= SPARED).then_some((entry, None))
    }

    /// The same for rays that all end, and the region that they stay in.
    #[inline(never)]
    pub(super) fn enter_by_region(&mut self, packets: Range<usize>) -> Option<Entrance> {
        let world = self.accel.world;
        let region = Region::around::<T>(&self.rays[packets], world);
        let entry =
            region.map(|region| (enter(self.accel, world.node, |node| region.children(node)), Some(region)));
        let entry = entry.filter(|(entry, _)| entry.spared >= SPARED);
        self.paces.entries.learn(if entry.is_some() { 0 } else { -1 });
        entry
    }
}
