//! Many rays at a time: columns of rays in, columns of hits out, each ray by the way that suits it.
//!
//! 1. Rays with a common point, eight or 32 packets at a time: `bundle`, behind the pyramid of `frustum`. What flat mirrors
//!    throw back has one by beams, which are sorted out first.
//! 2. Packets whose rays visit much the same: together, see [`super::packet`].
//! 3. All others: one by one, many at a time.
//!
//! Short rays that start near each other, and those with a common point that are too far apart for a bundle, enter the tree
//! below the nodes that all of them would go through, see [`super::entry`].
//!
//! Which way a ray takes changes no result.

mod answers;
mod bundle;
mod candidates;
mod columns;
mod flight;
mod frustum;
mod packets;

use super::Accel;
use super::query::{AnyHit, Closest};
use super::traversal::Hint;
use crate::intersect::{RayLanes, Tier};
use crate::math::{Lane, Stored, Vec3, WIDTH};
use answers::{Answers, Asked, Occluded, Scratch};
use flight::Alone;
use packets::Packets;

pub use columns::{Bound, HitColumns, RayColumns};
pub use frustum::Apex;

/// Packets in a bundle, at most: as many as a word has bits.
const BUNDLE: usize = 4 * WIDTH;
/// Packets in a small one, and in a group of packets, each a lane.
const GROUP: usize = WIDTH;
const GROUPS: usize = BUNDLE / GROUP;

/// The first packets of a bundle, as bits.
#[inline(always)]
fn first_packets(count: usize) -> u32 {
    u32::MAX >> (BUNDLE - count)
}

/// The numbers of packets given as bits.
#[inline(always)]
fn numbers(mut packets: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let first = std::num::NonZero::new(packets)?;
        packets &= packets - 1;
        Some(first.trailing_zeros() as usize % BUNDLE)
    })
}

/// Rays that ask nothing.
fn no_rays<L: Lane>() -> RayLanes<L> {
    let (zero, off) = (Vec3::zero(), L::constant(f64::NEG_INFINITY));
    RayLanes { origin: zero, direction: zero, t_min: L::zero(), t_max: off }
}

/// Streams of rays into a tree, with the scratch of one worker.
pub struct RayStream<'a, T: Tier> {
    packets: Packets<'a, T>,
    scratch: Scratch<T>,
    alone: Alone,
}

impl<'a, T: Tier> RayStream<'a, T> {
    /// Scratch for a tree.
    pub fn new(accel: &'a Accel) -> Self {
        Self {
            packets: Packets::new(accel),
            scratch: Scratch {
                closest: Asked::new(accel, |rays| Closest::new(rays.t_max)),
                any: Asked::new(accel, |rays| AnyHit::new(rays.t_max)),
            },
            alone: Alone::default(),
        }
    }

    /// The nearest hit of each ray; a row whose `t` is still the ray's `t_max` has none.
    pub fn closest<S: Stored<T::Wide>>(
        &mut self,
        rays: &RayColumns<S>,
        apex: Option<Apex>,
        hint: Hint,
        hits: &mut HitColumns<T::Real>,
    ) {
        self.trace(rays, apex, hint, hits);
    }

    /// Whether each ray hits anything: bit `i` of byte `k` for ray `8 k + i`.
    pub fn any<S: Stored<T::Wide>>(
        &mut self,
        rays: &RayColumns<S>,
        apex: Option<Apex>,
        hint: Hint,
        occluded: &mut [u8],
    ) {
        self.trace(rays, apex, hint, &mut Occluded(occluded));
    }

    fn trace<A: Answers<T>, S: Stored<T::Wide>>(
        &mut self,
        rays: &RayColumns<S>,
        apex: Option<Apex>,
        hint: Hint,
        answers: &mut A,
    ) {
        let asked = A::scratch(&mut self.scratch);
        self.alone.clear();
        let (queries, alone) = (&mut asked.queries, &mut self.alone);
        match apex {
            Some(_) => {
                for first in (0..rays.len).step_by(BUNDLE * WIDTH) {
                    self.packets.trace(rays, first, ((apex, hint), false), queries, answers, alone);
                }
            }
            None => self.packets.trace_scattered(rays, hint, queries, answers, alone),
        }
        if !self.alone.is_empty() {
            asked.flight.trace(self.packets.accel, rays, &self.alone, answers);
        }
    }
}
