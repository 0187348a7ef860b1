//! The primitives of a leaf against the packets of a bundle.
//!
//! Plainly: each packet is tested against each primitive. Departures:
//! - the pyramid of all is tested against eight primitives at once, then the box of a primitive against the pyramids of
//!   eight packets at once;
//! - what the pairs that are left have in common, the apex, makes the edge functions of a triangle two products a ray
//!   ([`Edges`]): they sort out most of what misses, and what is met behind the apex;
//! - edges also tell of most rays from a camera that they certainly hit, and where within bounds; the others run the
//!   primitive test: loops that overlap from pair to pair and have little to guess;
//! - of other rays that certainly pass inside the edges of a large triangle its plane tells, most of all of what they left;
//! - where triangles cover more than the pyramid their boxes tell little, so edges come first;
//! - of how far rays pass by spheres and cylinders most is the same for all, too (`frustum::rounds`).

use wide::f32x8;

use super::super::candidates::Candidate;
use super::super::frustum::{Edges, Sight};
use super::super::{GROUPS, numbers};
use super::{Bundle, TRIANGLE_FOR_ANY};
use crate::accel::block::{RaysByPrimitive, Round};
use crate::accel::leaf::{BlockVisitor, Lanes, TestRays, Testable};
use crate::accel::query::Query;
use crate::intersect::triangle::Glimpse;
use crate::intersect::{Tier, TriangleTest};
use crate::math::{Lane, Mask, WIDTH, three};

/// Pairs of packets and round primitives from which it pays to look at what the rays have in common: camera rays, and those for
/// which any hit will do, as their own tests tell more of what is behind.
const MANY_PAIRS: [usize; 2] = [6, 24];

/// A primitive of a block and a packet.
#[derive(Clone, Copy, Default)]
pub(super) struct Pair(Candidate);

impl Pair {
    #[inline(always)]
    pub(super) fn new(primitive: usize, packet: usize) -> Self {
        Self(Candidate::new(primitive * GROUPS + packet / WIDTH, packet % WIDTH))
    }
    #[inline(always)]
    fn primitive(self) -> usize {
        self.0.row() / GROUPS % WIDTH
    }
    #[inline(always)]
    fn packet(self) -> usize {
        self.0.row() % GROUPS * WIDTH + self.0.lane()
    }
}

impl<T: Tier, Q: Query<T::Wide>> BlockVisitor for Bundle<'_, T, Q> {
    #[inline(always)]
    fn visit<B: Testable>(&mut self, block: &B) -> bool {
        let (frustum, there) = (&*self.frustum, (1 << block.count()) - 1);
        let Some(corners) = block.corners_of_triangles() else {
            let extent = three(|k| block.extent(k));
            let sight = frustum.sight(&frustum.view().boxes(|k| extent[k][0], |k| extent[k][1]));
            let met = frustum.sees(&sight) & there;
            return met != 0 && self.visit_primitives(block, &sight, None, met);
        };
        let corners = three(|v| frustum.view().point(|k| f32x8::new(corners[v][k])));
        let [a, b, c] = corners;
        let boxes = [a.min(b).min(c), a.max(b).max(c)];
        if self.work.meets_wide {
            let edges = frustum.edges(None, corners);
            let met = frustum.triangles(&edges) & there;
            if met == 0 {
                return false;
            }
            let sight = frustum.sight(&boxes);
            let met = met & frustum.sees(&sight);
            self.work.meets_wide = met & !frustum.wide(&sight) == 0;
            return self.visit_primitives(block, &sight, Some(&edges), met);
        }
        let sight = frustum.sight(&boxes);
        let mut met = frustum.sees(&sight) & there;
        if met == 0 {
            return false;
        }
        let edges = frustum.edges(Some(&sight), corners);
        let wide = frustum.wide(&sight);
        self.work.meets_wide = met & !wide == 0;
        if met & wide != 0 {
            met &= frustum.triangles(&edges);
        }
        self.visit_primitives(block, &sight, Some(&edges), met)
    }
}

impl<T: Tier, Q: Query<T::Wide>> Bundle<'_, T, Q> {
    /// Tests the primitives of a block that the pyramid meets, each against the packets that may meet it.
    #[inline(always)]
    fn visit_primitives<B: Testable>(
        &mut self,
        block: &B,
        sight: &Sight,
        edges: Option<&Edges>,
        met: u32,
    ) -> bool {
        let each = if Q::ANY && edges.is_some() { TRIANGLE_FOR_ANY } else { 1 };
        self.met += each * met.count_ones() as usize;
        let (mut met, mut count, mut accepted) = (met, 0, 0);
        if let Some(edges) = edges.filter(|_| self.planes_tell()) {
            (count, accepted) = self.ask_planes(block, (sight, edges), met & edges.large);
            met &= !edges.large;
        }
        self.find_pairs(sight, met);
        let count = self.find_likely(block, edges, count);
        accepted |= self.ask_likely(block, (sight, edges), count);
        numbers(accepted).for_each(|j| self.look(j));
        if accepted != 0 {
            self.frustum.update_reach();
        }
        accepted != 0
    }

    /// Notes the packets that may meet each of the primitives that the pyramid meets.
    #[inline(always)]
    fn find_pairs(&mut self, sight: &Sight, met: u32) {
        let all = self.all();
        self.work.pairs.clear();
        for group in 0..self.frustum.groups() {
            let all = all >> (group * WIDTH);
            for i in numbers(met & self.frustum.meets_group(group, sight)).map(|i| i % WIDTH) {
                self.work.pairs.push(i * GROUPS + group, self.frustum.packets_of(group, sight, i) & all);
            }
        }
    }

    /// Sorts out the pairs that may hit; gives how many.
    #[inline(always)]
    fn find_likely<B: Testable>(&mut self, block: &B, edges: Option<&Edges>, mut count: usize) -> usize {
        let work = &mut *self.work;
        let sifts = work.pairs.len() >= MANY_PAIRS[usize::from(Q::ANY)];
        let rounds = block.round().filter(|_| sifts).map(|round| self.frustum.rounds(round));
        for k in 0..work.pairs.len() {
            let pair = Pair(work.pairs.get(k));
            let (i, j) = (pair.primitive(), pair.packet());
            let asks = if Q::ANY { work.asks[j] } else { 0xff };
            let lanes = match (edges, &rounds) {
                (Some(edges), _) => edges.may_hit(i, self.frustum.eight(j)),
                (_, Some(rounds)) => self.frustum.may_hit(rounds, i, j),
                // Prepared for nothing: that means nothing but to triangles.
                _ => {
                    let rays = TestRays { ray: &self.rays[j], triangle: Some(&work.prepared[j]) };
                    block.may_hit::<T, RaysByPrimitive>(i, &rays).bits()
                }
            };
            work.likely[count] = (pair, lanes & asks);
            count += usize::from(lanes & asks != 0);
        }
        count
    }

    /// Puts so many of the likely pairs to the queries; gives the packets that accepted a hit.
    #[inline(always)]
    fn ask_likely<B: Testable>(
        &mut self,
        block: &B,
        (sight, edges): (&Sight, Option<&Edges>),
        count: usize,
    ) -> u32 {
        let edges_tell = edges.filter(|_| T::Triangle::GLIMPSES && self.frustum.tells_meetings);
        let mut accepted = 0;
        for k in 0..count {
            let (pair, lanes) = self.work.likely[k];
            let (i, j) = (pair.primitive(), pair.packet());
            let accepts = match edges_tell {
                Some(edges) if edges.large >> i & 1 != 0 => {
                    self.ask_by_edges((block, i), edges, j, Mask::from_bits(lanes))
                }
                None if !Q::ANY => self.ask_round((block, i), sight, j, lanes),
                _ => self.ask((block, i), j, Mask::from_bits(lanes)),
            };
            accepted |= u32::from(accepts) << j;
        }
        accepted
    }

    /// Puts lanes of packet `j` that may hit primitive `i` of a block to the query; those of which edges tell enough are not
    /// tested. True if any was accepted.
    #[inline(always)]
    fn ask_by_edges<B: Testable>(
        &mut self,
        (block, i): (&B, usize),
        edges: &Edges,
        j: usize,
        lanes: Lanes<T>,
    ) -> bool {
        let seen = edges.meeting(i, self.frustum.eight(j));
        let [near, far] = [seen.near, seen.far].map(|t| T::Wide::load_f32(&t.to_array()));
        let seen = Glimpse::between(lanes, near, far);
        let (t_min, limit) = (self.rays[j].t_min, self.queries[j].limit());
        let (certain, unclear) = self.work.pending[j].sort(&seen, t_min, limit);
        let accepts = unclear.any() && self.ask((block, i), j, unclear);
        self.work.waits |= 1 << j;
        self.work.pending[j].take((block, i), certain, &seen, &mut self.queries[j]) | accepts
    }

    /// The same for a round primitive; lanes as bits. Of a sphere its box tells well enough which lanes have found something
    /// nearer.
    #[inline(always)]
    fn ask_round<B: Testable>(
        &mut self,
        (block, i): (&B, usize),
        sight: &Sight,
        j: usize,
        mut lanes: u32,
    ) -> bool {
        let Some(Round::Spheres { .. }) = block.round() else {
            return self.ask((block, i), j, Mask::from_bits(lanes));
        };
        lanes &= self.frustum.reaching(sight, i, j, T::above_f32(self.queries[j].limit()));
        let rays = TestRays { ray: &self.rays[j], triangle: Some(&self.work.prepared[j]) };
        lanes != 0
            && self.work.pending[j].meet((block, i), Mask::from_bits(lanes), &rays, &mut self.queries[j])
    }

    /// The same by the primitive test.
    #[inline(always)]
    fn ask<B: Testable>(&mut self, (block, i): (&B, usize), j: usize, mut lanes: Lanes<T>) -> bool {
        let is_triangles = block.corners_of_triangles().is_some();
        if is_triangles && self.work.is_prepared >> j & 1 == 0 {
            self.work.is_prepared |= 1 << j;
            self.work.prepared[j] = T::Triangle::prepare(&self.rays[j]);
        }
        let rays = TestRays { ray: &self.rays[j], triangle: Some(&self.work.prepared[j]) };
        if is_triangles && !T::Triangle::GLIMPSES {
            lanes = lanes & block.may_hit::<T, RaysByPrimitive>(i, &rays);
        }
        self.work.waits |= 1 << j;
        self.work.pending[j].ask((block, i), lanes, &rays, &mut self.queries[j])
    }
}
