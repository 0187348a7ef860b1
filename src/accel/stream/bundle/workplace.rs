//! What a worker keeps for bundles.

use super::super::candidates::{Candidates, room_for};
use super::super::frustum::Frustum;
use super::super::{BUNDLE, GROUPS, no_rays};
use super::leaf::Pair;
use crate::accel::leaf::ForTriangles;
use crate::accel::pending::Pending;
use crate::accel::unchecked::Ahead;
use crate::intersect::{RayLanes, Tier, TriangleTest};
use crate::math::WIDTH;

/// What a worker keeps for bundles.
pub(in super::super) struct Workplace<T: Tier> {
    /// Packets prepared for triangles when first tested, as many meet none; which of them are, as bits.
    pub(super) prepared: [ForTriangles<T>; BUNDLE],
    pub(super) is_prepared: u32,
    /// Packets of which distances may wait, as bits.
    pub(super) waits: u32,
    /// What is read next.
    pub(in super::super) ahead: Ahead,
    /// True if the last triangles met cover more than the pyramid in some direction: then edges tell more than boxes do.
    pub(super) meets_wide: bool,
    /// Lanes of packets that still ask whether they hit anything, as bits.
    pub(super) asks: [u32; BUNDLE],
    /// Pairs of a primitive of a block and a packet.
    pub(super) pairs: Candidates<{ room_for(GROUPS * WIDTH) }>,
    /// Those that may hit, with the lanes that may.
    pub(super) likely: [(Pair, u32); room_for(GROUPS * WIDTH)],
    pub(super) pending: [Pending<T>; BUNDLE],
    /// For bundles inside of instances.
    pub(super) inner: Option<Box<Inside<T>>>,
}

/// A bundle inside of an instance.
pub(super) struct Inside<T: Tier> {
    pub(super) rays: [RayLanes<T::Wide>; BUNDLE],
    pub(super) frustum: Frustum,
    pub(super) work: Workplace<T>,
}

impl<T: Tier> Default for Inside<T> {
    fn default() -> Self {
        Self { rays: [no_rays(); BUNDLE], frustum: Frustum::default(), work: Workplace::default() }
    }
}

impl<T: Tier> Default for Workplace<T> {
    fn default() -> Self {
        Self {
            prepared: [T::Triangle::prepare(&no_rays()); BUNDLE],
            is_prepared: 0,
            waits: 0,
            ahead: Ahead::default(),
            meets_wide: false,
            asks: [0; BUNDLE],
            pairs: Candidates::default(),
            likely: [(Pair::default(), 0); room_for(GROUPS * WIDTH)],
            pending: [Pending::default(); BUNDLE],
            inner: None,
        }
    }
}
