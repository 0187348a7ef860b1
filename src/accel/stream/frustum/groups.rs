//! The packets of a bundle, eight in a group: which of them may meet a primitive.

use wide::f32x8;

use super::slopes::Slopes;
use super::{Frustum, Sight};
use crate::accel::stream::GROUPS;
use crate::math::{Lane, Mask, WIDTH};

/// Packets of a bundle, a lane each.
#[derive(Clone, Copy, Debug)]
pub(super) struct Group {
    pub(super) slopes: Slopes,
    /// Of all packets, in each lane.
    pub(super) all: Slopes,
    /// How far along `z` each still looks.
    pub(super) reach: [f32; WIDTH],
}

/// Around nothing.
impl Default for Group {
    fn default() -> Self {
        let none = Slopes { a: [f32x8::ZERO; 2], b: [f32x8::ZERO; 2] };
        Self { slopes: none, all: none, reach: [f32::NEG_INFINITY; WIDTH] }
    }
}

impl Frustum {
    /// Packets that may meet primitive `i`.
    #[inline(always)]
    pub(in super::super) fn packets(&self, sight: &Sight, i: usize) -> u32 {
        (0..self.count).fold(0, |all, group| all | self.packets_of(group, sight, i) << (group * WIDTH))
    }

    /// How many groups the packets make.
    #[inline(always)]
    pub(in super::super) fn groups(&self) -> usize {
        self.count
    }

    /// Of eight primitives that some packets may meet, those that packets of a group may meet.
    #[inline(always)]
    pub(in super::super) fn meets_group(&self, group: usize, sight: &Sight) -> u32 {
        if self.count == 1 { 0xff } else { sight.slopes.overlap(&self.groups[group].all).bits() }
    }

    /// Packets of a group that may meet primitive `i`.
    #[inline(always)]
    pub(in super::super) fn packets_of(&self, group: usize, sight: &Sight, i: usize) -> u32 {
        let group = &self.groups[group % GROUPS];
        let reach = f32x8::new(group.reach) + self.side_pad;
        let nearest = f32x8::splat(sight.nearest.get(i));
        (sight.slopes.splat(i).overlap(&group.slopes) & nearest.le(reach)).bits()
    }
}
