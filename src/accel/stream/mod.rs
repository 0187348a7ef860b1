//! Many rays at a time: columns of rays in, columns of hits out, each ray by the way that suits it.
//!
//! 1. Rays with a common point, eight packets at a time: `bundle`, behind the pyramid of `frustum`.
//! 2. Packets whose rays visit much the same: together, see [`super::packet`].
//! 3. All others: one by one, many at a time.
//!
//! Short rays that start near each other enter the tree below the nodes that all of them would go through, see
//! [`super::entry`].
//!
//! Which way a ray takes changes no result.

mod bundle;
mod candidates;
mod columns;
mod flight;
mod frustum;

use super::Accel;
use super::entry::{Entry, enter};
use super::query::{AnyHit, Closest, Query};
use super::region::Region;
use super::traversal::{Hint, Pace, Traversal, ask_planes};
use crate::intersect::{RayLanes, Tier};
use crate::math::{Lane, Stored, Vec3, WIDTH};
use bundle::{Bundle, Stacks, Workplace};
use flight::{Alone, Flight};

pub use columns::{Bound, HitColumns, RayColumns};
pub use frustum::Apex;
use frustum::{Frustum, focus};

/// Packets in a bundle.
const BUNDLE: usize = WIDTH;

/// Most bundles that are not tried after one whose rays seem to come from nowhere in common: to see that costs little.
const GUESS_PAUSE: u32 = 7;

/// Nodes that rays must be spared for a common entry to pay.
const SPARED: usize = 3;

/// Where the answers of a stream go.
trait Answers<T: Tier> {
    /// What packets ask.
    type Query: Query<T::Wide> + Copy;
    /// What single rays ask.
    type One: Query<T::Real> + Copy;
    /// The question of eight rays.
    fn ask(rays: &RayLanes<T::Wide>) -> Self::Query;
    /// What one of the eight asks.
    fn one(query: &Self::Query, i: usize) -> Self::One;
    /// Writes the answers of eight rays from row `at` on.
    fn store(&mut self, at: usize, query: &Self::Query);
    /// Writes the answer of one.
    fn store_one(&mut self, row: usize, query: &Self::One);
    /// The scratch for these questions.
    fn scratch(scratch: &mut Scratch<T>) -> &mut Asked<T, Self::Query, Self::One>;
}

impl<T: Tier> Answers<T> for HitColumns<'_, T::Real> {
    type Query = Closest<T::Wide>;
    type One = Closest<T::Real>;

    #[inline(always)]
    fn ask(rays: &RayLanes<T::Wide>) -> Self::Query {
        Closest::new(rays.t_max)
    }
    #[inline(always)]
    fn one(query: &Self::Query, i: usize) -> Self::One {
        query.get(i)
    }
    #[inline(always)]
    fn store(&mut self, at: usize, query: &Self::Query) {
        HitColumns::store(self, at, query);
    }
    #[inline(always)]
    fn store_one(&mut self, row: usize, query: &Self::One) {
        HitColumns::store_one(self, row, query);
    }
    fn scratch(scratch: &mut Scratch<T>) -> &mut Asked<T, Self::Query, Self::One> {
        &mut scratch.closest
    }
}

/// Bit `i` of byte `k`: whether ray `8 k + i` hits anything.
struct Occluded<'a>(&'a mut [u8]);

impl<T: Tier> Answers<T> for Occluded<'_> {
    type Query = AnyHit<T::Wide>;
    type One = AnyHit<T::Real>;

    #[inline(always)]
    fn ask(rays: &RayLanes<T::Wide>) -> Self::Query {
        AnyHit::new(rays.t_max)
    }
    #[inline(always)]
    fn one(query: &Self::Query, i: usize) -> Self::One {
        query.get(i)
    }
    #[inline(always)]
    fn store(&mut self, at: usize, query: &Self::Query) {
        self.0[at / WIDTH] = query.hits() as u8;
    }
    #[inline(always)]
    fn store_one(&mut self, row: usize, query: &Self::One) {
        let bit = 1 << (row % WIDTH);
        let byte = &mut self.0[row / WIDTH];
        *byte = if query.hits() != 0 { *byte | bit } else { *byte & !bit };
    }
    fn scratch(scratch: &mut Scratch<T>) -> &mut Asked<T, Self::Query, Self::One> {
        &mut scratch.any
    }
}

/// What is asked of a stream, by packets and by single rays.
struct Asked<T: Tier, Q, O> {
    queries: Box<[Q; BUNDLE]>,
    flight: Flight<T, O>,
}

impl<T: Tier, Q: Copy, O: Query<T::Real> + Copy> Asked<T, Q, O> {
    fn new(accel: &Accel, ask: impl Fn(&RayLanes<T::Wide>) -> Q) -> Self {
        Self { queries: Box::new([ask(&no_rays()); BUNDLE]), flight: Flight::new(accel) }
    }
}

/// Rays that ask nothing.
fn no_rays<L: Lane>() -> RayLanes<L> {
    let (zero, off) = (Vec3::zero(), L::constant(f64::NEG_INFINITY));
    RayLanes { origin: zero, direction: zero, t_min: L::zero(), t_max: off }
}

/// Room for each of the questions.
struct Scratch<T: Tier> {
    closest: Asked<T, Closest<T::Wide>, Closest<T::Real>>,
    any: Asked<T, AnyHit<T::Wide>, AnyHit<T::Real>>,
}

/// Streams of rays into a tree, with the scratch of one worker.
pub struct RayStream<'a, T: Tier> {
    bundles: Bundles<'a, T>,
    scratch: Scratch<T>,
    alone: Alone,
}

impl<'a, T: Tier> RayStream<'a, T> {
    /// Scratch for a tree.
    pub fn new(accel: &'a Accel) -> Self {
        Self {
            bundles: Bundles::new(accel),
            scratch: Scratch {
                closest: Asked::new(accel, |rays| Closest::new(rays.t_max)),
                any: Asked::new(accel, |rays| AnyHit::new(rays.t_max)),
            },
            alone: Alone::default(),
        }
    }

    /// The nearest hit of each ray; a row whose `t` is still the ray's `t_max` has none.
    pub fn closest<S: Stored<T::Wide>>(
        &mut self,
        rays: &RayColumns<S>,
        apex: Option<Apex>,
        hint: Hint,
        hits: &mut HitColumns<T::Real>,
    ) {
        self.trace(rays, apex, hint, hits);
    }

    /// Whether each ray hits anything: bit `i` of byte `k` for ray `8 k + i`.
    pub fn any<S: Stored<T::Wide>>(
        &mut self,
        rays: &RayColumns<S>,
        apex: Option<Apex>,
        hint: Hint,
        occluded: &mut [u8],
    ) {
        self.trace(rays, apex, hint, &mut Occluded(occluded));
    }

    fn trace<A: Answers<T>, S: Stored<T::Wide>>(
        &mut self,
        rays: &RayColumns<S>,
        apex: Option<Apex>,
        hint: Hint,
        answers: &mut A,
    ) {
        let asked = A::scratch(&mut self.scratch);
        self.alone.clear();
        for first in (0..rays.len).step_by(BUNDLE * WIDTH) {
            self.bundles.trace(rays, first, (apex, hint), &mut asked.queries, answers, &mut self.alone);
        }
        if !self.alone.is_empty() {
            asked.flight.trace(self.bundles.accel, rays, &self.alone, answers);
        }
    }
}

/// Packets, up to eight of them at a time.
struct Bundles<'a, T: Tier> {
    accel: &'a Accel,
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

impl<'a, T: Tier> Bundles<'a, T> {
    fn new(accel: &'a Accel) -> Self {
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
    fn trace<A: Answers<T>, S: Stored<T::Wide>>(
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
        let known = apex.filter(|_| self.pace.tries());
        let guesses = apex.is_none() && hint != Hint::Incoherent && self.guess.tries();
        let short = apex.is_none() && hint == Hint::Auto && rays.ends(first) && self.entries.tries();
        if known.is_none() && !guesses && !short && !self.traversal.may_go_together(hint, end - first) {
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
        let apex = if guesses { self.guess_apex(queries.len()) } else { known };
        let whole = apex.is_some_and(|apex| self.trace_bundle(apex, queries));
        let entry = if short && !whole { self.find_entry(queries.len()) } else { None };
        let way_in = entry.map(|entry| alone.add_entry(entry.node));
        for (j, at) in packets.enumerate() {
            if whole || self.trace_packet(j, hint, entry.as_ref(), &mut queries[j]) {
                answers.store(at, &queries[j]);
            } else {
                alone.push(at, way_in);
            }
        }
    }

    /// False if the rays of a packet had better go alone.
    fn trace_packet<Q: Query<T::Wide>>(
        &mut self,
        j: usize,
        hint: Hint,
        entry: Option<&Entry>,
        query: &mut Q,
    ) -> bool {
        let together = self.traversal.together::<T, Q>(&self.rays[j], hint);
        if together {
            self.traversal.ask_together::<T, _>(&self.rays[j], entry, query);
        }
        together
    }

    /// Where the rays of so many packets may enter the tree, if that spares them anything.
    fn find_entry(&mut self, packets: usize) -> Option<Entry> {
        let world = self.accel.world;
        let region = Region::around::<T>(&self.rays[..packets], world);
        let entry = region.map(|region| enter(self.accel, world.node, region));
        let entry = entry.filter(|entry| entry.spared >= SPARED);
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

    /// False if the packets do not make a bundle, or not a good one.
    #[inline(never)]
    fn trace_bundle<Q: Query<T::Wide>>(&mut self, apex: Apex, queries: &mut [Q]) -> bool {
        let world = self.accel.world;
        let rays = &self.rays[..queries.len()];
        let pace = if apex.is_behind() { &mut self.guess } else { &mut self.pace };
        let Some(mut bundle) = Bundle::new(rays, apex, world, (&mut self.frustum, &mut self.work), queries)
        else {
            if apex.is_behind() {
                pace.learn_within(-1, GUESS_PAUSE);
            }
            return false;
        };
        let mut stacks =
            Stacks { bundle: &mut self.traversal.single_stack, packet: &mut self.traversal.packet_stack };
        let done = bundle.descend(self.accel, world.node, &mut stacks);
        pace.learn(if bundle.has_paid() { 0 } else { -1 });
        done
    }
}
