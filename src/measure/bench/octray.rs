//! octray as an engine: the one place where the bench calls the tree.

use std::marker::PhantomData;

use super::engine::Engine;
use super::rays::{HitColumns, NO_HIT, RayColumns};
use crate::accel::{Accel, Hint, Traversal};
use crate::intersect::{RayLanes, Tier};
use crate::math::{BitLane, Lane, Vec3, WIDTH};

/// A tree, asked in a tier.
#[derive(Clone, Copy, Debug)]
pub struct Octray<'a, T> {
    accel: &'a Accel,
    hint: Hint,
    tier: PhantomData<T>,
}

impl<'a, T: Tier> Octray<'a, T> {
    /// As the renderer asks: rays tell by themselves how they lie to each other.
    pub fn new(accel: &'a Accel) -> Self {
        Self { accel, hint: Hint::Auto, tier: PhantomData }
    }
    /// The plain traversal: each ray alone.
    pub fn plain(accel: &'a Accel) -> Self {
        Self { accel, hint: Hint::Incoherent, tier: PhantomData }
    }

    /// Eight rays from `first` on. Lanes beyond the end repeat the last ray but ask nothing.
    #[inline(always)]
    pub(super) fn packet(rays: &RayColumns<'_>, first: usize) -> RayLanes<T::Wide> {
        let load = |column: &[f32]| T::Wide::load_f32(&RayColumns::eight(column, first));
        let vector = |[x, y, z]: [&[f32]; 3]| Vec3 { x: load(x), y: load(y), z: load(z) };
        let mut packet = RayLanes {
            origin: vector(rays.origin),
            direction: vector(rays.direction),
            t_min: load(rays.t_min),
            t_max: load(rays.t_max),
        };
        let left = rays.len() - first;
        if left < WIDTH {
            let t_max = |i| if i < left { rays.t_max[first + i] } else { f32::NEG_INFINITY };
            packet.t_max = T::Wide::load_f32(&std::array::from_fn(t_max));
        }
        packet
    }
}

impl<T: Tier> Engine for Octray<'_, T> {
    fn name(&self) -> &'static str {
        "octray"
    }
    fn mode(&self) -> String {
        match self.hint {
            Hint::Auto => T::NAME.name().to_owned(),
            _ => format!("{}, single rays", T::NAME.name()),
        }
    }

    fn closest(&self, rays: RayColumns<'_>, mut hits: HitColumns<'_>) {
        let mut traversal = Traversal::new(self.accel);
        for first in (0..rays.len()).step_by(WIDTH) {
            let packet = Self::packet(&rays, first);
            let found = traversal.closest::<T>(&packet, self.hint);
            let is_hit = found.t.lt(packet.t_max);
            let prim = T::Wide::select_bits(is_hit, found.prim, BitLane::splat(NO_HIT));
            let ids = std::array::from_fn(|i| prim.get(i));
            hits.put_eight(first, T::nearest_f32(found.t).to_array(), ids);
        }
    }

    fn any(&self, rays: RayColumns<'_>, occluded: &mut [bool]) {
        let mut traversal = Traversal::new(self.accel);
        for (packet, occluded) in occluded.chunks_mut(WIDTH).enumerate() {
            let bits = traversal.any::<T>(&Self::packet(&rays, packet * WIDTH), self.hint);
            for (i, occluded) in occluded.iter_mut().enumerate() {
                *occluded = bits >> i & 1 != 0;
            }
        }
    }
}
