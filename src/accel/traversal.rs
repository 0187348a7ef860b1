//! The door to the tree: eight rays of a tier, together or one by one.

use super::block::{PrimitivesByRay, RaysByPrimitive};
use super::descend::descend;
use super::entry::Entry;
use super::query::{AnyHit, Closest, Query};
use super::region::Region;
use super::{Accel, leaf::PreparedRays, packet, single};
use crate::intersect::{LaneHit, PrimId, PrimKind, RayLanes, Tier, plane};
use crate::math::{BitLane, Lane, Mask, Vec3, WIDTH, three};

/// How the rays of a packet lie to each other. It changes time, never results.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Hint {
    /// Goes by how rays before fared.
    #[default]
    Auto,
    /// Neighbouring rays go nearly the same way: they traverse together.
    Coherent,
    /// Rays go anywhere: each traverses alone.
    Incoherent,
}

/// Nodes of a tree that packets of any rays go through together.
const SMALL_TREE: usize = 8;

/// Most packets that go alone before one is tried together again.
pub(super) const LONGEST_PAUSE: u32 = 64;

/// Whether going together pays, as those before tell: where it does not, the more seldom it is tried.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pace {
    /// Packets or bundles to come that are not tried.
    rest: u32,
    /// How many were not tried after the last that did not pay.
    pause: u32,
}

impl Pace {
    /// True if the next is to be tried.
    #[inline(always)]
    pub(super) fn tries(&mut self) -> bool {
        let tries = self.rest == 0;
        self.rest -= u32::from(!tries);
        tries
    }
    /// True if the next is not to be tried.
    #[inline(always)]
    pub(super) fn is_resting(&self) -> bool {
        self.rest != 0
    }
    /// The next is not to be tried, whatever the last one saved.
    #[inline(always)]
    pub(super) fn skip_next(&mut self) {
        self.rest = self.rest.max(1);
    }
    /// True if none of so many packets is to go together; they count as rest.
    #[inline(always)]
    fn rests(&mut self, packets: u32) -> bool {
        let rests = self.rest >= packets;
        self.rest -= if rests { packets } else { 0 };
        rests
    }
    /// Takes note of what the last one saved by going together.
    #[inline(always)]
    pub(super) fn learn(&mut self, saved: i32) {
        self.learn_within(saved, LONGEST_PAUSE);
    }
    /// Takes note that the last one paid where the next one may not.
    #[inline(always)]
    pub(super) fn trust_more(&mut self) {
        self.pause /= 2;
        self.rest = self.pause;
    }
    /// The same, with a longest pause of its own.
    #[inline(always)]
    pub(super) fn learn_within(&mut self, saved: i32, longest: u32) {
        self.pause = if saved >= 0 { 0 } else { (2 * self.pause + 1).min(longest) };
        self.rest = self.pause;
    }
}

/// Scratch of one worker for traversals: stacks as deep as the tree needs.
#[derive(Debug)]
pub struct Traversal<'a> {
    accel: &'a Accel,
    pub(super) packet_stack: Vec<packet::Entry>,
    pub(super) single_stack: Vec<single::Entry>,
    pace: Pace,
}

impl<'a> Traversal<'a> {
    /// Scratch for a tree.
    pub fn new(accel: &'a Accel) -> Self {
        let bound = accel.stack_bound;
        Self {
            accel,
            packet_stack: Vec::with_capacity(bound),
            single_stack: Vec::with_capacity(bound),
            pace: Pace::default(),
        }
    }

    /// The nearest hit of each of eight rays; a lane whose `t` is still the ray's `t_max` has none.
    #[inline]
    pub fn closest<T: Tier>(&mut self, ray: &RayLanes<T::Wide>, hint: Hint) -> Closest<T::Wide> {
        let mut query = Closest::new(ray.t_max);
        ask_planes(self.accel, ray, &mut query);
        self.ask_tree::<T, _>(ray, hint, &mut query);
        query
    }

    /// Which of eight rays hit anything, as bits; lanes whose `t_max` is minus infinity are not asked.
    #[inline]
    pub fn any<T: Tier>(&mut self, ray: &RayLanes<T::Wide>, hint: Hint) -> u32 {
        let mut query = AnyHit::new(ray.t_max);
        ask_planes(self.accel, ray, &mut query);
        self.ask_tree::<T, _>(ray, hint, &mut query);
        query.hits()
    }

    /// Puts what is in the tree to the query of eight rays.
    #[inline]
    fn ask_tree<T: Tier, Q: Query<T::Wide>>(&mut self, ray: &RayLanes<T::Wide>, hint: Hint, query: &mut Q) {
        if self.together::<T, Q>(ray, hint) {
            return self.ask_together::<T, Q>(ray, None, query);
        }
        let (accel, world) = (self.accel, self.accel.world);
        for lane in 0..WIDTH {
            if !query.asks(lane) {
                continue;
            }
            let rays = PreparedRays::<T>::new(RayLanes::splat(&ray.get(lane)), world);
            let mut alone = query.splat_lane(lane);
            descend::<T, PrimitivesByRay, _>(accel, world, None, &rays, &mut alone, &mut self.single_stack);
            query.take_lane(lane, &alone);
        }
    }

    /// [`Self::ask_tree`] for rays that traverse together, from the root or, within a region, from an entry.
    #[inline]
    pub(super) fn ask_together<T: Tier, Q: Query<T::Wide>>(
        &mut self,
        ray: &RayLanes<T::Wide>,
        entry: Option<&(Entry, Option<Region>)>,
        query: &mut Q,
    ) {
        let (accel, world) = (self.accel, self.accel.world);
        let rays = PreparedRays::<T>::new(*ray, world);
        let entry = entry.map(|(entry, region)| (&entry.node, *region));
        let stack = &mut self.packet_stack;
        let saved = descend::<T, RaysByPrimitive, _>(accel, world, entry, &rays, query, stack);
        self.pace.learn(saved);
    }

    /// True if rays share most of the tree wherever they go.
    #[inline(always)]
    pub(super) fn is_small(&self) -> bool {
        self.accel.nodes.len() <= SMALL_TREE
    }

    /// False if none of so many packets would traverse together.
    #[inline(always)]
    pub(super) fn may_go_together(&mut self, hint: Hint, packets: usize) -> bool {
        match hint {
            Hint::Coherent => true,
            Hint::Incoherent => false,
            Hint::Auto if self.is_small() => true,
            Hint::Auto => !self.pace.rests(packets as u32),
        }
    }

    /// Whether a packet traverses together: when told so, when the tree is so small that rays share most of it wherever
    /// they go, or when it paid lately and the rays agree on the order of visits, if that matters.
    #[inline(always)]
    pub(super) fn together<T: Tier, Q: Query<T::Wide>>(
        &mut self,
        ray: &RayLanes<T::Wide>,
        hint: Hint,
    ) -> bool {
        match hint {
            Hint::Coherent => true,
            Hint::Incoherent => false,
            Hint::Auto if self.is_small() => true,
            Hint::Auto => (Q::ANY || one_octant(ray.direction)) && self.pace.tries(),
        }
    }
}

/// True if all directions go into the same octant.
#[inline(always)]
fn one_octant<L: Lane>(d: Vec3<L>) -> bool {
    let (zero, all) = (L::zero(), L::Mask::splat(true).bits());
    three(|k| [d.x, d.y, d.z][k].lt(zero).bits()).into_iter().all(|backward| backward == 0 || backward == all)
}

/// Planes reach everywhere, so they stand before the tree and not in it.
#[inline(always)]
pub(super) fn ask_planes<L: Lane>(accel: &Accel, ray: &RayLanes<L>, query: &mut impl Query<L>) {
    for (row, &[point, normal]) in accel.planes.iter().enumerate() {
        let lanes = plane::Lanes { point: Vec3::splat_f32(point), normal: Vec3::splat_f32(normal) };
        let hit: LaneHit<L> = plane::solve(ray, &lanes);
        query.accept(ray, &hit, BitLane::splat(PrimId::new(PrimKind::Plane, row).0));
    }
}
