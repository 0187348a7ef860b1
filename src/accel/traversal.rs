//! The door to the tree: eight rays of a tier, together or one by one.

use super::block::{PrimitivesByRay, RaysByPrimitive};
use super::descend::{Octant, descend};
use super::query::{AnyHit, Closest, Query};
use super::{Accel, leaf::PreparedRays, packet, single};
use crate::intersect::aabb::CullRay;
use crate::intersect::{LaneHit, PrimId, PrimKind, RayLanes, Tier, plane};
use crate::math::{BitLane, Lane, Mask, Vec3, WIDTH};

/// How the rays of a packet lie to each other. It changes time, never results.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Hint {
    /// Looks at the directions and decides.
    #[default]
    Auto,
    /// Neighbouring rays go nearly the same way: they traverse together.
    Coherent,
    /// Rays go anywhere: each traverses alone.
    Incoherent,
}

/// Nodes of a tree that packets of any rays go through together.
const SMALL_TREE: usize = 8;

/// Scratch of one worker for traversals: stacks as deep as the tree needs.
#[derive(Debug)]
pub struct Traversal<'a> {
    accel: &'a Accel,
    packet_stack: Vec<packet::Entry>,
    single_stack: Vec<single::Entry>,
}

impl<'a> Traversal<'a> {
    /// Scratch for a tree.
    pub fn new(accel: &'a Accel) -> Self {
        let bound = accel.stack_bound;
        Self { accel, packet_stack: Vec::with_capacity(bound), single_stack: Vec::with_capacity(bound) }
    }

    /// The nearest hit of each of eight rays; a lane whose `t` is still the ray's `t_max` has none.
    #[inline]
    pub fn closest<T: Tier>(&mut self, ray: &RayLanes<T::Wide>, hint: Hint) -> Closest<T::Wide> {
        let mut query = Closest::new(ray.t_max);
        self.ask_planes::<T, _>(ray, &mut query);
        let rays = PreparedRays::<T>::new(*ray, self.accel.world.scale);
        if self.together(&rays.cull, hint) {
            descend::<T, RaysByPrimitive, _>(
                self.accel,
                self.accel.world.node,
                &rays,
                &mut query,
                &mut self.packet_stack,
            );
            return query;
        }
        let after_planes = query;
        for lane in 0..WIDTH {
            if ray.t_max.get(lane) > <T::Real as Lane>::constant(f64::NEG_INFINITY) {
                let found = self.closest_of_lane::<T>(ray, &after_planes, lane);
                set_lane(&mut query, lane, &found);
            }
        }
        query
    }

    fn closest_of_lane<T: Tier>(
        &mut self,
        ray: &RayLanes<T::Wide>,
        start: &Closest<T::Wide>,
        lane: usize,
    ) -> Closest<T::Wide> {
        let rays = self.prepare_lane::<T>(ray, lane);
        let mut query = start.splat_lane(lane);
        descend::<T, PrimitivesByRay, _>(
            self.accel,
            self.accel.world.node,
            &rays,
            &mut query,
            &mut self.single_stack,
        );
        query
    }

    /// Which of eight rays hit anything, as bits; lanes whose `t_max` is minus infinity are not asked.
    #[inline]
    pub fn any<T: Tier>(&mut self, ray: &RayLanes<T::Wide>, hint: Hint) -> u32 {
        let mut query = AnyHit::new(ray.t_max);
        self.ask_planes::<T, _>(ray, &mut query);
        let rays = PreparedRays::<T>::new(*ray, self.accel.world.scale);
        if self.together(&rays.cull, hint) {
            descend::<T, RaysByPrimitive, _>(
                self.accel,
                self.accel.world.node,
                &rays,
                &mut query,
                &mut self.packet_stack,
            );
            return query.hits();
        }
        let after_planes = query.limit();
        let asked = after_planes.gt(Lane::constant(f64::NEG_INFINITY)).bits();
        let alone = (0..WIDTH).filter(|lane| asked >> lane & 1 != 0);
        alone.fold(query.hits(), |hits, lane| hits | u32::from(self.any_of_lane::<T>(ray, lane)) << lane)
    }

    fn any_of_lane<T: Tier>(&mut self, ray: &RayLanes<T::Wide>, lane: usize) -> bool {
        let rays = self.prepare_lane::<T>(ray, lane);
        let mut query = AnyHit::new(rays.ray.t_max);
        descend::<T, PrimitivesByRay, _>(
            self.accel,
            self.accel.world.node,
            &rays,
            &mut query,
            &mut self.single_stack,
        );
        query.hits() != 0
    }

    fn prepare_lane<T: Tier>(&self, ray: &RayLanes<T::Wide>, lane: usize) -> PreparedRays<T> {
        PreparedRays::new(RayLanes::splat(&ray.get(lane)), self.accel.world.scale)
    }

    /// Whether a packet traverses together: when told so, when all rays go into one octant, or when the tree is so small
    /// that rays share most of it wherever they go.
    #[inline(always)]
    fn together(&self, cull: &CullRay<wide::f32x8>, hint: Hint) -> bool {
        match hint {
            Hint::Coherent => true,
            Hint::Incoherent => false,
            Hint::Auto => self.accel.nodes.len() <= SMALL_TREE || Octant::of(cull).shared,
        }
    }

    /// Planes reach everywhere, so they stand before the tree and not in it.
    #[inline(always)]
    fn ask_planes<T: Tier, Q: Query<T::Wide>>(&self, ray: &RayLanes<T::Wide>, query: &mut Q) {
        for (row, &[point, normal]) in self.accel.planes.iter().enumerate() {
            let lanes = plane::Lanes { point: Vec3::splat_f32(point), normal: Vec3::splat_f32(normal) };
            let hit: LaneHit<T::Wide> = plane::solve(ray, &lanes);
            query.accept(ray, &hit, BitLane::splat(PrimId::new(PrimKind::Plane, row).0));
        }
    }
}

impl<L: Lane> Closest<L> {
    /// Lane `i` in all lanes.
    fn splat_lane(&self, i: usize) -> Self {
        let mut query = Closest::new(L::splat(self.t.get(i)));
        query.u = L::splat(self.u.get(i));
        query.v = L::splat(self.v.get(i));
        query.prim = L::Bits::splat(self.prim.get(i));
        query.instance = L::Bits::splat(self.instance.get(i));
        query
    }
}

/// Writes the nearest of `found`'s lanes to lane `i` of `query`.
fn set_lane<L: Lane>(query: &mut Closest<L>, i: usize, found: &Closest<L>) {
    let best = found.nearest_lane();
    let lane = L::Mask::from_bits(1 << i);
    query.t = L::select(lane, L::splat(found.t.get(best)), query.t);
    query.u = L::select(lane, L::splat(found.u.get(best)), query.u);
    query.v = L::select(lane, L::splat(found.v.get(best)), query.v);
    query.prim = L::select_bits(lane, L::Bits::splat(found.prim.get(best)), query.prim);
    query.instance = L::select_bits(lane, L::Bits::splat(found.instance.get(best)), query.instance);
}
