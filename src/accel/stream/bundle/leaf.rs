//! The primitives of a leaf against the packets of a bundle.
//!
//! Plainly: each packet is tested against each primitive. Departures:
//! - the pyramid of all is tested against eight primitives at once, then the box of a primitive against the pyramids of
//!   eight packets at once;
//! - what the pairs that are left have in common, the apex, makes the edge functions of a triangle two products a ray
//!   ([`Edges`]): they sort out most of what misses, and what is met behind the apex;
//! - what may hit then runs the primitive test: loops that overlap from pair to pair and have little to guess.

use wide::f32x8;

use super::super::frustum::{Edges, Sight};
use super::Bundle;
use crate::accel::block::RaysByPrimitive;
use crate::accel::leaf::{BlockVisitor, TestRays, Testable};
use crate::accel::query::Query;
use crate::intersect::{Tier, TriangleTest};
use crate::math::{Mask, three};

impl<T: Tier, Q: Query<T::Wide>> BlockVisitor for Bundle<'_, T, Q> {
    #[inline(always)]
    fn visit<B: Testable>(&mut self, block: &B) -> bool {
        let (frustum, there) = (&*self.frustum, (1 << block.count()) - 1);
        let Some(corners) = block.corners_of_triangles() else {
            let extent = three(|k| block.extent(k));
            let sight = frustum.sight(&frustum.view().boxes(|k| extent[k][0], |k| extent[k][1]));
            return self.visit_primitives(block, &sight, None, frustum.sees(&sight) & there);
        };
        let corners = three(|v| frustum.view().point(|k| f32x8::new(corners[v][k])));
        let [a, b, c] = corners;
        let sight = frustum.sight(&[a.min(b).min(c), a.max(b).max(c)]);
        let mut met = frustum.sees(&sight) & there;
        if met == 0 {
            return false;
        }
        let edges = frustum.edges(corners);
        if met & frustum.wide(&sight) != 0 {
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
        self.find_pairs(sight, met);
        let (count, packets) = self.find_likely(block, edges);
        if edges.is_some() {
            self.prepare(packets);
        }
        let accepted = self.ask_likely(block, count);
        let mut left = accepted;
        while left != 0 {
            self.look(left.trailing_zeros() as usize & 7);
            left &= left - 1;
        }
        if accepted != 0 {
            self.frustum.update_reach();
        }
        accepted != 0
    }

    /// Notes the packets that may meet each of the primitives that the pyramid meets.
    #[inline(always)]
    fn find_pairs(&mut self, sight: &Sight, met: u32) {
        let (mut left, all) = (met, (1 << self.rays.len()) - 1);
        self.met += met.count_ones() as usize;
        self.work.pairs.clear();
        while left != 0 {
            let i = left.trailing_zeros() as usize & 7;
            left &= left - 1;
            self.work.pairs.push(i, self.frustum.packets(sight, i) & all);
        }
    }

    /// Sorts out the pairs that may hit; gives how many, and of which packets.
    #[inline(always)]
    fn find_likely<B: Testable>(&mut self, block: &B, edges: Option<&Edges>) -> (usize, u32) {
        let work = &mut *self.work;
        let (mut count, mut packets) = (0, 0);
        for k in 0..work.pairs.len() {
            let pair = work.pairs.get(k);
            let (i, j) = (pair.row(), pair.lane());
            let asks = if Q::ANY { work.asks[j] } else { 0xff };
            let lanes = match edges {
                Some(edges) => edges.may_hit(i, self.frustum.slopes_of(j)),
                // Prepared for nothing: that means nothing but to triangles.
                None => {
                    let rays = TestRays { ray: &self.rays[j], triangle: &work.prepared[j] };
                    block.may_hit::<T, RaysByPrimitive>(i, &rays).bits()
                }
            };
            work.likely[count] = (pair, lanes & asks);
            let is_likely = lanes & asks != 0;
            count += usize::from(is_likely);
            packets |= u32::from(is_likely) << j;
        }
        (count, packets)
    }

    /// Puts so many of the likely pairs to the queries; gives the packets that accepted a hit.
    #[inline(always)]
    fn ask_likely<B: Testable>(&mut self, block: &B, count: usize) -> u32 {
        let (is_triangles, mut accepted) = (block.corners_of_triangles().is_some(), 0);
        for k in 0..count {
            let (pair, lanes) = self.work.likely[k];
            let (i, j) = (pair.row(), pair.lane());
            let rays = TestRays { ray: &self.rays[j], triangle: &self.work.prepared[j] };
            let mut lanes = Mask::from_bits(lanes);
            if is_triangles && !T::Triangle::GLIMPSES {
                lanes = lanes & block.may_hit::<T, RaysByPrimitive>(i, &rays);
            }
            let accepts = self.work.pending[j].ask((block, i), lanes, &rays, &mut self.queries[j]);
            accepted |= u32::from(accepts) << j;
        }
        accepted
    }

    /// Prepares packets for triangles.
    #[inline(always)]
    fn prepare(&mut self, packets: u32) {
        let mut left = packets & !self.work.is_prepared;
        self.work.is_prepared |= packets;
        while left != 0 {
            let j = left.trailing_zeros() as usize & 7;
            left &= left - 1;
            self.work.prepared[j] = T::Triangle::prepare(&self.rays[j]);
        }
    }
}
