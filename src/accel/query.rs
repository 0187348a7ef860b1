//! What is asked of a traversal: the nearest hit, or whether there is one.

use crate::intersect::{LaneHit, RayLanes};
use crate::math::{BitLane, Lane, Mask};

/// A question put to the tree by the rays of a packet, or by one ray splatted over the lanes.
pub trait Query<L: Lane> {
    /// Any hit will do, so the order of visits hardly matters.
    const ANY: bool;
    /// Asks anew, of rays that end at `t_max`.
    fn begin(&mut self, t_max: L);
    /// Lanes need nothing at or beyond this `t`; minus infinity where a lane needs nothing more.
    fn limit(&self) -> L;
    /// Takes note of candidates; true if any was accepted.
    fn accept(&mut self, ray: &RayLanes<L>, hit: &LaneHit<L>, ids: L::Bits) -> bool;
    /// Takes hits of lanes that are certainly nearer than what they hold, at `t` or before.
    fn take(&mut self, lanes: L::Mask, t: L, ids: L::Bits);
    /// Puts the distances of hits so taken in place.
    fn settle(&mut self, lanes: L::Mask, hit: &LaneHit<L>);
    /// True when no lane needs anything more.
    fn is_done(&self) -> bool;
    /// Candidates from now on are seen through this instance; 0 is none.
    fn enter_instance(&mut self, instance: u32);
    /// Lanes hold candidates of one and the same ray: brings all to the nearest limit.
    fn share_limit(&mut self);

    /// True if lane `i` still needs anything.
    fn asks(&self, i: usize) -> bool;
    /// The question of lane `i`, and what it found so far, in all lanes.
    fn splat_lane(&self, i: usize) -> Self;
    /// Takes what the lanes of `found`, all one ray, found together into lane `i`.
    fn take_lane(&mut self, i: usize, found: &Self);
}

/// The nearest hit of each lane.
///
/// `prim` and `instance` mean nothing in lanes where `t` is still the ray's `t_max`.
#[derive(Clone, Copy, Debug)]
pub struct Closest<L: Lane> {
    /// Distance.
    pub t: L,
    /// As in [`crate::intersect::Hit`].
    pub u: L,
    /// As in [`crate::intersect::Hit`].
    pub v: L,
    /// Which primitive.
    pub prim: L::Bits,
    /// Through which instance; 0 is none.
    pub instance: L::Bits,
    current_instance: u32,
    limit: L,
}

impl<L: Lane> Closest<L> {
    /// No hit yet.
    #[inline(always)]
    pub fn new(t_max: L) -> Self {
        let (zero, none) = (L::zero(), L::Bits::splat(0));
        Self { t: t_max, u: zero, v: zero, prim: none, instance: none, current_instance: 0, limit: t_max }
    }

    /// What lane `i` asks, and what it found so far, as a question of its own.
    #[inline(always)]
    pub fn get(&self, i: usize) -> Closest<L::Scalar> {
        Closest {
            t: self.t.get(i),
            u: self.u.get(i),
            v: self.v.get(i),
            prim: self.prim.get(i),
            instance: self.instance.get(i),
            current_instance: 0,
            limit: self.limit.get(i),
        }
    }

    /// Lanes that tie with the hit they hold and win by the lower id.
    #[cold]
    fn winning_ties(&self, ties: L::Mask, ids: L::Bits) -> L::Mask {
        let wins = |i: usize| (ids.get(i), self.current_instance) < (self.prim.get(i), self.instance.get(i));
        let bits = (0..L::WIDTH).map(|i| u32::from(wins(i)) << i).sum();
        ties & L::Mask::from_bits(bits)
    }

    /// The nearest of all lanes, as lane number.
    pub fn nearest_lane(&self) -> usize {
        let key = |i: usize| (self.t.get(i), self.prim.get(i), self.instance.get(i));
        (1..L::WIDTH).fold(0, |best, i| if key(i) < key(best) { i } else { best })
    }
}

impl<L: Lane> Query<L> for Closest<L> {
    const ANY: bool = false;

    #[inline(always)]
    fn begin(&mut self, t_max: L) {
        let (zero, none) = (L::zero(), L::Bits::splat(0));
        (self.t, self.limit) = (t_max, t_max);
        (self.u, self.v, self.prim, self.instance) = (zero, zero, none, none);
        self.current_instance = 0;
    }
    #[inline(always)]
    fn limit(&self) -> L {
        self.limit
    }
    #[inline(always)]
    fn accept(&mut self, ray: &RayLanes<L>, hit: &LaneHit<L>, ids: L::Bits) -> bool {
        let candidates = hit.mask & hit.t.gt(ray.t_min);
        let ties = candidates & hit.t.eq(self.t);
        let mut closer = candidates & hit.t.lt(self.t);
        if ties.any() {
            closer = closer | self.winning_ties(ties, ids);
        }
        if !closer.any() {
            return false;
        }
        self.take(closer, hit.t, ids);
        self.settle(closer, hit);
        true
    }
    #[inline(always)]
    fn take(&mut self, lanes: L::Mask, t: L, ids: L::Bits) {
        self.t.put(lanes, t);
        self.prim = L::select_bits(lanes, ids, self.prim);
        self.instance = L::select_bits(lanes, L::Bits::splat(self.current_instance), self.instance);
        self.limit = self.t;
    }
    #[inline(always)]
    fn settle(&mut self, lanes: L::Mask, hit: &LaneHit<L>) {
        self.t.put(lanes, hit.t);
        self.u.put(lanes, hit.u);
        self.v.put(lanes, hit.v);
        self.limit = self.t;
    }
    #[inline(always)]
    fn is_done(&self) -> bool {
        false
    }
    #[inline(always)]
    fn enter_instance(&mut self, instance: u32) {
        self.current_instance = instance;
    }
    #[inline(always)]
    fn share_limit(&mut self) {
        let nearest = (1..L::WIDTH).fold(self.t.get(0), |t, i| t.min(self.t.get(i)));
        self.limit = L::splat(nearest);
    }

    #[inline(always)]
    fn asks(&self, i: usize) -> bool {
        self.limit.get(i) > <L::Scalar as Lane>::constant(f64::NEG_INFINITY)
    }
    #[inline(always)]
    fn splat_lane(&self, i: usize) -> Self {
        Self {
            u: L::splat(self.u.get(i)),
            v: L::splat(self.v.get(i)),
            prim: L::Bits::splat(self.prim.get(i)),
            instance: L::Bits::splat(self.instance.get(i)),
            ..Self::new(L::splat(self.t.get(i)))
        }
    }
    #[inline(always)]
    fn take_lane(&mut self, i: usize, found: &Self) {
        let (best, lane) = (found.nearest_lane(), L::Mask::from_bits(1 << i));
        let take = |from: L, to: L| L::select(lane, L::splat(from.get(best)), to);
        let take_bits = |from: L::Bits, to| L::select_bits(lane, L::Bits::splat(from.get(best)), to);
        self.t = take(found.t, self.t);
        self.u = take(found.u, self.u);
        self.v = take(found.v, self.v);
        self.prim = take_bits(found.prim, self.prim);
        self.instance = take_bits(found.instance, self.instance);
        self.limit = self.t;
    }
}

/// Whether each lane hits anything.
#[derive(Clone, Copy, Debug)]
pub struct AnyHit<L: Lane> {
    limit: L,
    asked: L::Mask,
    hit: L::Mask,
}

impl<L: Lane> AnyHit<L> {
    /// Nothing hit yet; lanes whose `t_max` is minus infinity are not asked.
    #[inline(always)]
    pub fn new(t_max: L) -> Self {
        let asked = t_max.gt(L::constant(f64::NEG_INFINITY));
        Self { limit: t_max, asked, hit: L::Mask::splat(false) }
    }
    /// What lane `i` asks as a question of its own.
    #[inline(always)]
    pub fn get(&self, i: usize) -> AnyHit<L::Scalar> {
        let bit = |mask: L::Mask| mask.bits() >> i & 1 != 0;
        AnyHit { limit: self.limit.get(i), asked: bit(self.asked), hit: bit(self.hit) }
    }
    /// Lanes that hit something.
    #[inline(always)]
    pub fn hits(&self) -> u32 {
        self.hit.bits()
    }
}

impl<L: Lane> Query<L> for AnyHit<L> {
    const ANY: bool = true;

    #[inline(always)]
    fn begin(&mut self, t_max: L) {
        *self = Self::new(t_max);
    }
    #[inline(always)]
    fn limit(&self) -> L {
        self.limit
    }
    #[inline(always)]
    fn accept(&mut self, ray: &RayLanes<L>, hit: &LaneHit<L>, ids: L::Bits) -> bool {
        let found = hit.mask & hit.t.gt(ray.t_min) & hit.t.lt(self.limit);
        if !found.any() {
            return false;
        }
        self.take(found, hit.t, ids);
        true
    }
    #[inline(always)]
    fn take(&mut self, lanes: L::Mask, _: L, _: L::Bits) {
        self.hit = self.hit | lanes;
        self.limit.put(lanes, L::constant(f64::NEG_INFINITY));
    }
    #[inline(always)]
    fn settle(&mut self, _: L::Mask, _: &LaneHit<L>) {}
    #[inline(always)]
    fn is_done(&self) -> bool {
        !(self.asked & !self.hit).any()
    }
    #[inline(always)]
    fn enter_instance(&mut self, _: u32) {}
    #[inline(always)]
    fn share_limit(&mut self) {
        // One hit ends the ray in all lanes.
        self.hit = L::Mask::splat(true);
    }

    #[inline(always)]
    fn asks(&self, i: usize) -> bool {
        self.limit.get(i) > <L::Scalar as Lane>::constant(f64::NEG_INFINITY)
    }
    #[inline(always)]
    fn splat_lane(&self, i: usize) -> Self {
        Self::new(L::splat(self.limit.get(i)))
    }
    #[inline(always)]
    fn take_lane(&mut self, i: usize, found: &Self) {
        if found.hit.any() {
            let lane = L::Mask::from_bits(1 << i);
            self.hit = self.hit | lane;
            self.limit = L::select(lane, L::constant(f64::NEG_INFINITY), self.limit);
        }
    }
}
