//! Packets of a stream: which go as a large or a small bundle, which by themselves, and which not as packets.

mod beams;
mod entrance;
mod paces;
mod scattered;

use super::answers::Answers;
use super::bundle::{Bundle, Stacks, Workplace};
use super::columns::RayColumns;
use super::flight::Alone;
use super::frustum::{Apex, Frustum, focus};
use super::{BUNDLE, GROUP, no_rays};
use crate::accel::Accel;
use crate::accel::query::Query;
use crate::accel::traversal::{Hint, Traversal, ask_planes};
use crate::intersect::{RayLanes, Tier};
use crate::math::{Stored, WIDTH};
use entrance::Entrance;
use paces::{Outcome, Paces, Tries};
use std::ops::Range;

/// What became of a bundle.
#[derive(Clone, Copy, PartialEq)]
enum Fate {
    /// All rays are answered.
    Answered,
    /// Its rays are too far apart for the size of what they meet.
    GivenUp,
    /// The rays are not as the apex says, or it was not tried.
    None,
}

/// Packets, a bundle at a time.
pub(super) struct Packets<'a, T: Tier> {
    pub(super) accel: &'a Accel,
    traversal: Traversal<'a>,
    rays: Box<[RayLanes<T::Wide>; BUNDLE]>,
    frustum: Box<Frustum>,
    work: Box<Workplace<T>>,
    paces: Paces,
}

impl<'a, T: Tier> Packets<'a, T> {
    pub(super) fn new(accel: &'a Accel) -> Self {
        let traversal = Traversal::new(accel);
        Self {
            accel,
            paces: Paces::new(traversal.is_small()),
            traversal,
            rays: Box::new([no_rays(); BUNDLE]),
            frustum: Box::default(),
            work: Box::default(),
        }
    }

    /// Answers the packets from row `first` on, or notes the rows of rays that had better go alone. Without an apex, one is guessed
    /// where they are a beam.
    #[inline(always)]
    pub(super) fn trace<A: Answers<T>, S: Stored<T::Wide>>(
        &mut self,
        rays: &RayColumns<S>,
        first: usize,
        (asked, is_beam): ((Option<Apex>, Hint), bool),
        queries: &mut [A::Query; BUNDLE],
        answers: &mut A,
        alone: &mut Alone,
    ) {
        let rows = first..rays.len.min(first + BUNDLE * WIDTH);
        let all = 0..rows.len().div_ceil(WIDTH);
        let parts = all.clone().step_by(GROUP).map(|j| j..all.end.min(j + GROUP));
        let is_loaded = self.paces.tries_large(asked.0, is_beam, all.len());
        if is_loaded {
            self.load(rays, first, all.clone(), queries);
            if self.trace_large(asked.0, &mut queries[all.clone()]) {
                let rows = rows.step_by(WIDTH);
                return rows.zip(queries).for_each(|(row, query)| answers.store(row, query));
            }
        }
        for part in parts {
            self.trace_small(rays, (first, part, is_loaded), (asked, is_beam), queries, answers, alone);
        }
    }

    /// The same for some of the packets, which may be loaded already.
    #[inline(always)]
    fn trace_small<A: Answers<T>, S: Stored<T::Wide>>(
        &mut self,
        rays: &RayColumns<S>,
        (first, packets, is_loaded): (usize, Range<usize>, bool),
        ((apex, hint), is_beam): ((Option<Apex>, Hint), bool),
        queries: &mut [A::Query; BUNDLE],
        answers: &mut A,
        alone: &mut Alone,
    ) {
        let row = |j: usize| first + j * WIDTH;
        let ends = hint == Hint::Auto && rays.ends(row(packets.start));
        let tries = self.paces.tries(apex, is_beam, ends);
        // Bundles are not tried where rays were too far apart for one. Alone they would go through instances one by one.
        let apart = hint == Hint::Auto
            && (apex.is_some() && tries.apex.is_none())
            && !(self.traversal.is_small() || self.accel.has_instances());
        if tries == Tries::default() && !apart && !self.traversal.may_go_together(hint, packets.len()) {
            return packets.for_each(|j| alone.push(row(j), None));
        }
        if !is_loaded {
            self.load(rays, first, packets.clone(), queries);
        }
        let bundle = if tries.guesses { self.guess_apex(packets.clone()) } else { tries.apex };
        let fate = bundle.map_or(Fate::None, |apex| self.trace_bundle(apex, packets.clone(), queries));
        if fate == Fate::Answered {
            let rows = (row(packets.start)..row(packets.end)).step_by(WIDTH);
            return rows.zip(&queries[packets]).for_each(|(row, query)| answers.store(row, query));
        }
        let entry = match if apart { apex } else { bundle.filter(|_| fate == Fate::GivenUp) } {
            Some(apex) => self.enter_by_apex(apex, fate, packets.clone()),
            None if tries.enters => self.enter_by_region(packets.clone()),
            None => None,
        };
        let number = entry.map(|(entry, _)| alone.add_entry(entry.node));
        for j in packets {
            if !apart && self.trace_packet(j, hint, entry.as_ref(), &mut queries[j]) {
                answers.store(row(j), &queries[j]);
            } else {
                alone.push(row(j), number);
            }
        }
    }

    /// Loads packets and asks what is not in the tree.
    #[inline(always)]
    fn load<Q: Query<T::Wide>, S: Stored<T::Wide>>(
        &mut self,
        rays: &RayColumns<S>,
        first: usize,
        packets: Range<usize>,
        queries: &mut [Q; BUNDLE],
    ) {
        let rows = packets.len() * WIDTH;
        self.work.ahead = rays.ahead(first + packets.start * WIDTH + rows, rows);
        for j in packets {
            let (packet, query) = (&mut self.rays[j], &mut queries[j]);
            rays.load_to(first + j * WIDTH, packet);
            query.begin(packet.t_max);
            ask_planes(self.accel, packet, query);
        }
    }

    /// True if all packets are answered, as one bundle.
    #[inline(never)]
    fn trace_large<Q: Query<T::Wide>>(&mut self, apex: Option<Apex>, queries: &mut [Q]) -> bool {
        let rays = &self.rays[..queries.len()];
        let guess = || focus::<T>(rays, self.accel.world).map(Apex::Behind);
        let asked = apex.or_else(guess).and_then(|apex| self.ask_bundle(apex, 0, queries));
        let outcome = asked.unwrap_or_default();
        self.paces.learn_large(apex.is_none(), outcome.paid);
        outcome.done
    }

    /// False if the rays of a packet had better go alone.
    fn trace_packet<Q: Query<T::Wide>>(
        &mut self,
        j: usize,
        hint: Hint,
        entry: Option<&Entrance>,
        query: &mut Q,
    ) -> bool {
        let together = self.traversal.together::<T, Q>(&self.rays[j], hint);
        if together {
            self.traversal.ask_together::<T, _>(&self.rays[j], entry, query);
        }
        together
    }

    /// The apex behind where the rays of packets start, if they seem to have one.
    fn guess_apex(&mut self, packets: Range<usize>) -> Option<Apex> {
        let point = focus::<T>(&self.rays[packets], self.accel.world);
        if point.is_none() {
            self.paces.learn(true, None);
        }
        point.map(Apex::Behind)
    }

    /// Traces packets as a small bundle.
    #[inline(never)]
    fn trace_bundle<Q: Query<T::Wide>>(
        &mut self,
        apex: Apex,
        packets: Range<usize>,
        queries: &mut [Q],
    ) -> Fate {
        let asked = self.ask_bundle(apex, packets.start, &mut queries[packets]);
        self.paces.learn(apex.is_behind(), asked);
        match asked {
            Some(Outcome { done: true, .. }) => Fate::Answered,
            Some(_) => Fate::GivenUp,
            None => Fate::None,
        }
    }

    /// Asks packets from the given one on as a bundle.
    fn ask_bundle<Q: Query<T::Wide>>(
        &mut self,
        apex: Apex,
        first: usize,
        queries: &mut [Q],
    ) -> Option<Outcome> {
        let (world, rays) = (self.accel.world, &self.rays[first..][..queries.len()]);
        let mut bundle = Bundle::new(rays, apex, world, (&mut self.frustum, &mut self.work), queries)?;
        let mut stacks =
            Stacks { bundle: &mut self.traversal.single_stack, packet: &mut self.traversal.packet_stack };
        let done = bundle.descend(self.accel, world.node, &mut stacks);
        Some(Outcome { done, paid: bundle.has_paid(), met_little: bundle.has_met_little() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::tests::scenes::scattered_spheres;
    use crate::intersect::testing::dice::Dice;
    use crate::intersect::{Ray, Watertight};
    use wide::f32x8;

    /// What a bundle has answered before it is given up is asked again: its entry is that of rays that found nothing yet.
    #[test]
    fn a_bundle_that_is_given_up_leaves_no_trace_in_where_its_rays_enter() {
        let dice = &mut Dice(23);
        let accel = Accel::build(&scattered_spheres(3_000, dice));
        let (light, mut packets) = ([0.0, 0.0, 6.0], Packets::<Watertight>::new(&accel));
        for rays in packets.rays.iter_mut() {
            let mut one = |_| {
                let [x, y, z] = dice.point().map(|x| 0.02 * x as f32);
                let origin = [x, y, z - 0.9];
                let direction = std::array::from_fn(|k| light[k] - origin[k]);
                RayLanes::from(&Ray { t_max: 1.0, ..Ray::new(origin, direction) })
            };
            let each: [RayLanes<f32>; WIDTH] = std::array::from_fn(&mut one);
            *rays = RayLanes::gather(|i| &each[i]);
        }
        let apex = Apex::Target(light);
        let (fresh, _) = packets.enter_by_apex(apex, Fate::None, 0..GROUP).expect("it spares nodes");
        (0..GROUP).for_each(|j| packets.frustum.look(j, f32x8::splat(f32::NEG_INFINITY)));
        packets.frustum.update_reach();
        let given_up = packets.enter_by_apex(apex, Fate::GivenUp, 0..GROUP).expect("it spares as many");
        assert_eq!(given_up.0.node, fresh.node);
    }
}
