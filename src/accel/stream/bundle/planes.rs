//! Large triangles against the packets of a bundle, by their planes.
//!
//! Plainly: of each packet that may meet a triangle the primitive test is asked. Departure: what certainly passes inside the
//! edges asks its plane ([`crate::accel::stream::frustum`]), which leaves less to the test.

use super::super::frustum::{Edges, Sight};
use super::super::{BUNDLE, numbers};
use super::Bundle;
use super::leaf::Pair;
use crate::accel::leaf::Testable;
use crate::accel::query::Query;
use crate::intersect::{Tier, TriangleTest};
use crate::math::{BitLane, Lane, Mask, WIDTH, three};

impl<T: Tier, Q: Query<T::Wide>> Bundle<'_, T, Q> {
    /// True if planes tell what is met: of shadow rays, and of those that a mirror throws back.
    #[inline(always)]
    pub(super) fn planes_tell(&self) -> bool {
        let apex = self.frustum.apex();
        T::Triangle::GLIMPSES && if Q::ANY { apex.is_target() } else { apex.is_behind() }
    }

    /// Asks the planes of large triangles, given as bits; notes pairs with lanes of which those tell too little as likely, and gives how
    /// many, and the packets that found a hit.
    #[inline(always)]
    pub(super) fn ask_planes<B: Testable>(
        &mut self,
        block: &B,
        (sight, edges): (&Sight, &Edges),
        large: u32,
    ) -> (usize, u32) {
        let (mut count, mut accepted) = (0, 0);
        for i in numbers(large).map(|i| i % WIDTH) {
            let (lanes, likely) = self.find_inside(i, sight, edges);
            if likely != 0 {
                accepted |= self.ask_plane((block, i), &lanes, likely, &mut count);
            }
        }
        (count, accepted)
    }

    /// By packet, the lanes that may pass inside the edges of triangle `i` and those that certainly do; and the packets that have
    /// any.
    #[inline(always)]
    fn find_inside(&self, i: usize, sight: &Sight, edges: &Edges) -> ([(u32, u32); BUNDLE], u32) {
        let (mut lanes, mut likely) = ([(0, 0); BUNDLE], 0);
        for j in numbers(self.frustum.packets(sight, i) & self.all()) {
            let asks = if Q::ANY { self.work.asks[j] } else { 0xff };
            let (may, must) = edges.may_and_must_pass(i, self.frustum.eight(j));
            lanes[j] = (may & asks, must & asks);
            likely |= u32::from(may & asks != 0) << j;
        }
        (lanes, likely)
    }

    /// Asks the plane of triangle `i` for those lanes of packets.
    #[inline(always)]
    fn ask_plane<B: Testable>(
        &mut self,
        (block, i): (&B, usize),
        lanes: &[(u32, u32); BUNDLE],
        likely: u32,
        count: &mut usize,
    ) -> u32 {
        let Some(corners) = block.corners_of_triangles() else { return 0 };
        let plane = self.frustum.plane(three(|v| three(|k| corners[v][k][i])));
        let mut accepted = 0;
        for j in numbers(likely) {
            let ((may, must), rays, query) = (lanes[j], &self.rays[j], &mut self.queries[j]);
            let (hits, left) = if Q::ANY {
                let [hits, misses] = plane.sides(rays, query.limit()).map(|lanes| lanes.bits() & must);
                query.take(Mask::from_bits(hits), T::Wide::zero(), BitLane::splat(block.ids()[i]));
                (hits, may & !(hits | misses))
            } else {
                let seen = plane.meeting(Mask::from_bits(must), rays);
                let pending = &mut self.work.pending[j];
                let (certain, unclear) = pending.sort(&seen, rays.t_min, query.limit());
                pending.take((block, i), certain, &seen, query);
                self.work.waits |= 1 << j;
                (certain.bits(), may & !must | unclear.bits())
            };
            accepted |= u32::from(hits != 0) << j;
            self.work.likely[*count] = (Pair::new(i, j), left);
            *count += usize::from(left != 0);
        }
        accepted
    }
}
