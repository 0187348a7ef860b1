//! Packets of a stream, up to eight of them at a time: which go as a bundle, which by themselves, and which not as packets.

use super::answers::Answers;
use super::bundle::{Bundle, Stacks, Workplace};
use super::columns::RayColumns;
use super::flight::Alone;
use super::frustum::{Apex, Frustum, focus};
use super::{BUNDLE, no_rays};
use crate::accel::Accel;
use crate::accel::entry::{Entry, enter};
use crate::accel::query::Query;
use crate::accel::region::Region;
use crate::accel::traversal::{Hint, Pace, Traversal, ask_planes};
use crate::intersect::{RayLanes, Tier};
use crate::math::{Stored, WIDTH};

/// Most bundles that are not tried after one whose rays seem to come from nowhere in common: to see that costs little.
const GUESS_PAUSE: u32 = 7;

/// Nodes that rays must be spared for a common entry to pay.
const SPARED: usize = 3;

/// What is tried with packets before each goes its way.
#[derive(Clone, Copy, Default, PartialEq)]
struct Tries {
    /// To go as a bundle with this apex.
    apex: Option<Apex>,
    /// To go as a bundle with an apex that has to be found.
    guesses: bool,
    /// To enter the tree far from its root.
    enters: bool,
}

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

/// Where rays enter the tree, and the region that they stay in if that is known.
type Entrance = (Entry, Option<Region>);

/// Packets, up to eight of them at a time.
pub(super) struct Packets<'a, T: Tier> {
    pub(super) accel: &'a Accel,
    traversal: Traversal<'a>,
    rays: Box<[RayLanes<T::Wide>; BUNDLE]>,
    frustum: Box<Frustum>,
    work: Box<Workplace<T>>,
    /// Where a bundle does not pay, its neighbours hardly would: those whose apex is known, and those whose is guessed.
    pace: Pace,
    guess: Pace,
    /// The same for short rays, which may enter the tree far from its root.
    entries: Pace,
}

impl<'a, T: Tier> Packets<'a, T> {
    pub(super) fn new(accel: &'a Accel) -> Self {
        Self {
            accel,
            traversal: Traversal::new(accel),
            rays: Box::new([no_rays(); BUNDLE]),
            frustum: Box::default(),
            work: Box::default(),
            pace: Pace::default(),
            guess: Pace::default(),
            entries: Pace::default(),
        }
    }

    /// Answers the packets from row `first` on, or notes the rows of rays that had better go alone.
    pub(super) fn trace<A: Answers<T>, S: Stored<T::Wide>>(
        &mut self,
        rays: &RayColumns<S>,
        first: usize,
        (apex, hint): (Option<Apex>, Hint),
        queries: &mut [A::Query; BUNDLE],
        answers: &mut A,
        alone: &mut Alone,
    ) {
        let end = rays.len.min(first + BUNDLE * WIDTH);
        let packets = (first..end).step_by(WIDTH);
        let tries = self.tries(apex, hint, rays.ends(first));
        // Bundles are not tried where rays were too far apart for one. Alone they would go through instances one by one.
        let apart = hint == Hint::Auto
            && (apex.is_some() && tries.apex.is_none())
            && !(self.traversal.is_small() || self.accel.has_instances());
        if tries == Tries::default() && !apart && !self.traversal.may_go_together(hint, end - first) {
            packets.for_each(|at| alone.push(at, None));
            return;
        }
        for (j, at) in packets.clone().enumerate() {
            rays.load_to(at, &mut self.rays[j]);
            queries[j].begin(self.rays[j].t_max);
            ask_planes(self.accel, &self.rays[j], &mut queries[j]);
        }
        rays.prefetch(first + BUNDLE * WIDTH, BUNDLE * WIDTH);
        let queries = &mut queries[..packets.len()];
        let bundle = if tries.guesses { self.guess_apex(queries.len()) } else { tries.apex };
        let fate = bundle.map_or(Fate::None, |apex| self.trace_bundle(apex, queries));
        if fate == Fate::Answered {
            return packets.enumerate().for_each(|(j, at)| answers.store(at, &queries[j]));
        }
        let entry = match if apart { apex } else { bundle.filter(|_| fate == Fate::GivenUp) } {
            Some(apex) => self.enter_by_apex(apex, fate, queries.len()),
            None if tries.enters => self.enter_by_region(queries.len()),
            None => None,
        };
        let number = entry.map(|(entry, _)| alone.add_entry(entry.node));
        for (j, at) in packets.enumerate() {
            if !apart && self.trace_packet(j, hint, entry.as_ref(), &mut queries[j]) {
                answers.store(at, &queries[j]);
            } else {
                alone.push(at, number);
            }
        }
    }

    /// What is tried with the packets to come, of which the first ray ends or does not.
    #[inline(always)]
    fn tries(&mut self, apex: Option<Apex>, hint: Hint, ends: bool) -> Tries {
        Tries {
            apex: apex.filter(|_| self.pace.tries()),
            guesses: apex.is_none() && hint != Hint::Incoherent && self.guess.tries(),
            enters: apex.is_none() && hint == Hint::Auto && ends && self.entries.tries(),
        }
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

    /// Where so many packets enter the tree that have an apex in common, if their pyramid spares them anything.
    #[inline(never)]
    fn enter_by_apex(&mut self, apex: Apex, fate: Fate, packets: usize) -> Option<Entrance> {
        let (world, frustum) = (self.accel.world, &mut *self.frustum);
        let rays = &self.rays[..packets];
        if fate == Fate::None {
            frustum.surround::<T>(rays, apex, world)?;
        }
        // They start anew, whatever the bundle has found.
        rays.iter().enumerate().for_each(|(j, rays)| frustum.look(j, T::above_f32(rays.t_max)));
        frustum.update_reach();
        let entry = enter(self.accel, world.node, |node| frustum.children(node).0);
        (entry.spared >= SPARED).then_some((entry, None))
    }

    /// The same for rays that all end, and the region that they stay in.
    #[inline(never)]
    fn enter_by_region(&mut self, packets: usize) -> Option<Entrance> {
        let world = self.accel.world;
        let region = Region::around::<T>(&self.rays[..packets], world);
        let entry =
            region.map(|region| (enter(self.accel, world.node, |node| region.children(node)), Some(region)));
        let entry = entry.filter(|(entry, _)| entry.spared >= SPARED);
        self.entries.learn(if entry.is_some() { 0 } else { -1 });
        entry
    }

    /// The apex behind where the rays of so many packets start, if they seem to have one.
    fn guess_apex(&mut self, packets: usize) -> Option<Apex> {
        let point = focus::<T>(&self.rays[..packets], self.accel.world);
        if point.is_none() {
            self.guess.learn_within(-1, GUESS_PAUSE);
        }
        point.map(Apex::Behind)
    }

    /// Traces packets as a bundle.
    #[inline(never)]
    fn trace_bundle<Q: Query<T::Wide>>(&mut self, apex: Apex, queries: &mut [Q]) -> Fate {
        let world = self.accel.world;
        let rays = &self.rays[..queries.len()];
        let pace = if apex.is_behind() { &mut self.guess } else { &mut self.pace };
        let Some(mut bundle) = Bundle::new(rays, apex, world, (&mut self.frustum, &mut self.work), queries)
        else {
            if apex.is_behind() {
                pace.learn_within(-1, GUESS_PAUSE);
            }
            return Fate::None;
        };
        let mut stacks =
            Stacks { bundle: &mut self.traversal.single_stack, packet: &mut self.traversal.packet_stack };
        let done = bundle.descend(self.accel, world.node, &mut stacks);
        pace.learn(if bundle.has_paid() { 0 } else { -1 });
        if done { Fate::Answered } else { Fate::GivenUp }
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
        let (fresh, _) = packets.enter_by_apex(apex, Fate::None, BUNDLE).expect("it spares nodes");
        (0..BUNDLE).for_each(|j| packets.frustum.look(j, f32x8::splat(f32::NEG_INFINITY)));
        packets.frustum.update_reach();
        let given_up = packets.enter_by_apex(apex, Fate::GivenUp, BUNDLE).expect("it spares as many");
        assert_eq!(given_up.0.node, fresh.node);
    }
}
