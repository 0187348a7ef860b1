//! Packets of rays without an apex in common: those thrown back by flat mirrors have one by beams.

use super::super::answers::Answers;
use super::super::columns::RayColumns;
use super::super::flight::Alone;
use super::super::{BUNDLE, GROUP};
use super::beams::{Beams, are_one};
use super::{Fate, Packets};
use crate::accel::query::Query;
use crate::accel::traversal::{Hint, ask_planes};
use crate::intersect::Tier;
use crate::math::{Stored, WIDTH};

/// Of the packets of beams, one in how many has to be answered as part of a bundle for beams to pay.
const ONE_IN: usize = 16;

impl<T: Tier> Packets<'_, T> {
    /// Answers rays, or notes the rows of those that had better go alone.
    #[inline(never)]
    pub(in super::super) fn trace_scattered<A: Answers<T>, S: Stored<T::Wide>>(
        &mut self,
        rays: &RayColumns<S>,
        hint: Hint,
        queries: &mut [A::Query; BUNDLE],
        answers: &mut A,
        alone: &mut Alone,
    ) {
        for first in (0..rays.len).step_by(BUNDLE * WIDTH) {
            let packets = (rays.len - first).div_ceil(WIDTH).min(BUNDLE);
            // Rays that end soon mostly come from no mirror.
            let looks = hint != Hint::Incoherent && !rays.ends(first) && self.paces.looks_for_beams();
            // In a small tree packets go together whatever their rays, and bundles pay that are no beams.
            let is_beam = looks && (self.traversal.is_small() || are_one(rays, first, packets));
            let beams = if looks && !is_beam { Beams::of::<T, S>(rays, first, packets) } else { None };
            let paid = match beams {
                Some(beams) => self.trace_beams(rays, first, &beams, queries, answers, alone),
                None => {
                    self.trace(rays, first, ((None, hint), is_beam), queries, answers, alone);
                    is_beam
                }
            };
            if looks {
                self.paces.learn_beams(paid);
            }
        }
    }

    /// The same for a window, from row `first` on, by its beams; true if that paid.
    #[inline(never)]
    fn trace_beams<A: Answers<T>, S: Stored<T::Wide>>(
        &mut self,
        rays: &RayColumns<S>,
        first: usize,
        beams: &Beams,
        queries: &mut [A::Query; BUNDLE],
        answers: &mut A,
        alone: &mut Alone,
    ) -> bool {
        let (mut answered, mut asked) = (0, 0);
        for (before, rows) in beams.each() {
            self.work.ahead = rays.ahead(first + BUNDLE * WIDTH + before, rows.len());
            let packets = rows.chunks(WIDTH);
            let queries = &mut queries[..packets.len()];
            for ((packet, query), rows) in self.rays.iter_mut().zip(&mut *queries).zip(packets.clone()) {
                *packet = rays.gather(first, rows);
                query.begin(packet.t_max);
                ask_planes(self.accel, packet, query);
            }
            answered += self.ask_beam(queries);
            asked += queries.len();
            for (query, rows) in queries.iter().zip(packets) {
                for (i, row) in rows.iter().enumerate() {
                    answers.store_one(first + usize::from(*row), &A::one(query, i));
                }
            }
        }
        for (j, &lanes) in beams.loose.iter().enumerate().filter(|(_, lanes)| **lanes != 0) {
            alone.push_some(first + j * WIDTH, lanes);
        }
        answered * ONE_IN >= asked
    }

    /// Asks the packets of a beam, which are loaded; gives how many were answered as part of a bundle.
    #[inline(always)]
    fn ask_beam<Q: Query<T::Wide>>(&mut self, queries: &mut [Q]) -> usize {
        let packets = queries.len();
        if self.paces.tries_large(None, true, packets) && self.trace_large(None, queries) {
            return packets;
        }
        let mut answered = 0;
        for start in (0..packets).step_by(GROUP) {
            let part = start..packets.min(start + GROUP);
            let tries = self.paces.tries(None, true, false);
            let apex = if tries.guesses { self.guess_apex(part.clone()) } else { None };
            let fate = apex.map_or(Fate::None, |apex| self.trace_bundle(apex, part.clone(), queries));
            if fate == Fate::Answered {
                answered += part.len();
                continue;
            }
            for j in part {
                self.traversal.ask_together::<T, _>(&self.rays[j], None, &mut queries[j]);
            }
        }
        answered
    }
}

#[cfg(test)]
mod tests {
    use super::super::beams::tests::{of_two_mirrors, rays};
    use super::*;
    use crate::accel::Accel;
    use crate::accel::query::Closest;
    use crate::accel::stream::{HitColumns, no_rays};
    use crate::accel::tests::scenes::scattered_spheres;
    use crate::intersect::testing::dice::Dice;
    use crate::intersect::{RayLanes, Watertight};

    /// Mixed as they are, none of the rays of two mirrors go alone: that is for those of neither.
    #[test]
    fn what_two_mirrors_throw_back_goes_as_bundles() {
        let dice = &mut Dice(41);
        let accel = Accel::build(&scattered_spheres(3_000, dice));
        let mut packets = Packets::<Watertight>::new(&accel);
        let (columns, mirrors) = of_two_mirrors(1_000, dice);
        let mut alone = Alone::default();
        let [mut t, mut u, mut v] = std::array::from_fn(|_| vec![-1.0; 1_000]);
        let (mut prim, mut instance) = (vec![0; 1_000], []);
        let mut hits =
            HitColumns { t: &mut t, u: &mut u, v: &mut v, prim: &mut prim, instance: &mut instance };
        let off: RayLanes<_> = no_rays();
        let mut queries = [Closest::new(off.t_max); BUNDLE];
        packets.trace_scattered(&rays(&columns, 1_000), Hint::Auto, &mut queries, &mut hits, &mut alone);
        let bundled = (0..1_000).filter(|row| t[*row] != -1.0).count();
        let mirrored = (0..1_000).filter(|row| mirrors[*row] < 2 && columns[6][*row] > 0.0).count();
        assert!(bundled + 40 > mirrored && bundled < 900, "{bundled} of {mirrored} mirrored ones");
    }
}
