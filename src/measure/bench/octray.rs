//! octray as an engine: the one place where the bench calls the tree.

use std::marker::PhantomData;

use super::engine::Engine;
use super::rays::{HitColumns, NO_HIT, RayColumns};
use crate::accel::stream::{self, Bound, RayStream};
use crate::accel::{Accel, Hint, Traversal};
use crate::intersect::{RayLanes, Tier};
use crate::math::{BitLane, Lane, Real, Vec3, WIDTH};

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

/// Rays that a worker of the renderer takes at a time.
const WAVE: usize = 1024;

/// The columns of some rays, as a stream takes them.
fn columns<'r>(rays: &RayColumns<'r>) -> stream::RayColumns<'r, f32> {
    stream::RayColumns {
        len: rays.len(),
        origin: rays.origin,
        direction: rays.direction,
        t_min: Bound::Each(rays.t_min),
        t_max: Bound::Each(rays.t_max),
    }
}

/// Puts the sign of no hit where `t` is still the ray's `t_max`.
fn mark_misses<R: Real>(t: &[R], t_max: &[f32], prim: &mut [u32]) {
    for ((t, &t_max), prim) in t.iter().zip(t_max).zip(prim) {
        *prim = if *t < R::from_f32(t_max) { *prim } else { NO_HIT };
    }
}

/// Streams of rays, as the renderer sends them.
impl<T: Tier> Octray<'_, T> {
    fn closest_in_streams(&self, rays: &RayColumns<'_>, hits: &mut HitColumns<'_>) {
        let mut stream = RayStream::<T>::new(self.accel);
        let mut room = [[T::Real::default(); WAVE]; 3];
        for first in (0..rays.len()).step_by(WAVE) {
            let part = rays.slice(first..rays.len().min(first + WAVE));
            let (t, prim) = (&mut hits.t[first..][..part.len()], &mut hits.prim[first..][..part.len()]);
            let [wide_t, u, v] = room.each_mut().map(|column| &mut column[..part.len()]);
            let mut ask = |t: &mut [T::Real]| {
                let mut found = stream::HitColumns { t, u, v, prim: &mut *prim, instance: &mut [] };
                stream.closest(&columns(&part), rays.apex, self.hint, &mut found);
            };
            match T::Real::of_f32_mut(t) {
                Some(t) => {
                    ask(t);
                    mark_misses(t, part.t_max, prim);
                }
                None => {
                    ask(wide_t);
                    mark_misses(wide_t, part.t_max, prim);
                    t.iter_mut().zip(wide_t).for_each(|(t, wide)| *t = wide.to_f32());
                }
            }
        }
    }

    fn any_in_streams(&self, rays: &RayColumns<'_>, occluded: &mut [bool]) {
        let mut stream = RayStream::<T>::new(self.accel);
        let mut bits = [0; WAVE / WIDTH];
        for (first, occluded) in (0..rays.len()).step_by(WAVE).zip(occluded.chunks_mut(WAVE)) {
            let part = rays.slice(first..first + occluded.len());
            stream.any(&columns(&part), rays.apex, self.hint, &mut bits);
            for (i, occluded) in occluded.iter_mut().enumerate() {
                *occluded = bits[i / WIDTH] >> (i % WIDTH) & 1 != 0;
            }
        }
    }

    fn closest_one_by_one(&self, rays: &RayColumns<'_>, hits: &mut HitColumns<'_>) {
        let mut traversal = Traversal::new(self.accel);
        for first in (0..rays.len()).step_by(WIDTH) {
            let packet = Self::packet(rays, first);
            let found = traversal.closest::<T>(&packet, self.hint);
            let is_hit = found.t.lt(packet.t_max);
            let prim = T::Wide::select_bits(is_hit, found.prim, BitLane::splat(NO_HIT));
            let ids = std::array::from_fn(|i| prim.get(i));
            hits.put_eight(first, T::nearest_f32(found.t).to_array(), ids);
        }
    }

    fn any_one_by_one(&self, rays: &RayColumns<'_>, occluded: &mut [bool]) {
        let mut traversal = Traversal::new(self.accel);
        for (packet, occluded) in occluded.chunks_mut(WIDTH).enumerate() {
            let bits = traversal.any::<T>(&Self::packet(rays, packet * WIDTH), self.hint);
            for (i, occluded) in occluded.iter_mut().enumerate() {
                *occluded = bits >> i & 1 != 0;
            }
        }
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
        match self.hint {
            Hint::Auto => self.closest_in_streams(&rays, &mut hits),
            _ => self.closest_one_by_one(&rays, &mut hits),
        }
    }
    fn any(&self, rays: RayColumns<'_>, occluded: &mut [bool]) {
        match self.hint {
            Hint::Auto => self.any_in_streams(&rays, occluded),
            _ => self.any_one_by_one(&rays, occluded),
        }
    }
}
