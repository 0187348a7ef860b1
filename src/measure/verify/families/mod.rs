//! Families of hard cases, each a function of a seed.

mod aim;
mod boxes;
mod closed;
mod cylinders;
mod glass;
mod leaks;
mod mixed;
mod paths;
mod placed;
mod spheres;
mod starting;
mod triangles;

use super::bounds::Promise;
use super::tally::Tally;
use super::trial::Trial;
use crate::intersect::TierName;
use crate::intersect::testing::dice::Dice;

/// A named set of hard cases, without end.
#[derive(Clone, Copy, Debug)]
pub struct Family {
    /// Name, as chosen on the command line.
    pub name: &'static str,
    /// What is hard about it.
    pub about: &'static str,
    /// Which bounds hold.
    pub promise: Promise,
    make: Make,
}

/// What becomes of a seed.
#[derive(Clone, Copy, Debug)]
enum Make {
    /// Rays for any intersector.
    Rays(fn(&mut Dice) -> Trial),
    /// So many rays that octray walks by itself, tier by tier.
    Walks(usize, [fn(&mut Dice, &mut Tally); 3]),
}

impl Family {
    /// All families.
    pub fn all() -> impl Iterator<Item = &'static Self> {
        let tables = [
            closed::FAMILIES,
            leaks::FAMILIES,
            triangles::FAMILIES,
            spheres::FAMILIES,
            cylinders::FAMILIES,
            starting::FAMILIES,
            boxes::FAMILIES,
        ];
        tables.into_iter().chain([mixed::FAMILIES, paths::FAMILIES]).flatten()
    }

    /// The family of a name.
    pub fn named(name: &str) -> Option<&'static Self> {
        Self::all().find(|family| family.name == name)
    }

    /// Trial `number` of a seed: always the same. Nothing for paths, which start where an intersector's rays hit.
    pub fn trial(&self, seed: u64, number: u64) -> Option<Trial> {
        match self.make {
            Make::Rays(make) => Some(make(&mut self.dice(seed, number))),
            Make::Walks(..) => None,
        }
    }

    /// The trials of a seed, one after the other.
    pub fn trials(&self, seed: u64) -> impl Iterator<Item = Trial> + use<'_> {
        (0..).map_while(move |number| self.trial(seed, number))
    }

    /// Rays of a walk, if this is a family of walks.
    pub(super) fn rays_a_walk(&self) -> Option<usize> {
        match self.make {
            Make::Walks(rays, _) => Some(rays),
            Make::Rays(_) => None,
        }
    }

    /// Walks once in a tier, if this is a family of walks.
    pub(super) fn walk(&self, tier: TierName, seed: u64, number: u64) -> Option<Tally> {
        let Make::Walks(_, walks) = self.make else { return None };
        let mut tally = Tally::default();
        walks[tier as usize](&mut self.dice(seed, number), &mut tally);
        Some(tally)
    }

    fn dice(&self, seed: u64, number: u64) -> Dice {
        let words = self.name.bytes().map(u64::from).chain([seed, number]);
        Dice(words.fold(0, |state, word| Dice(state ^ word).word()))
    }
}
