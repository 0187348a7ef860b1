//! Families of hard cases, each a function of a seed.

mod aim;
mod boxes;
mod closed;
mod cylinders;
mod mixed;
mod spheres;
mod triangles;

use super::bounds::Promise;
use super::trial::Trial;
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
    make: fn(&mut Dice) -> Trial,
}

impl Family {
    /// All families of rays.
    pub fn all() -> impl Iterator<Item = &'static Self> {
        let tables =
            [closed::FAMILIES, triangles::FAMILIES, spheres::FAMILIES, cylinders::FAMILIES, boxes::FAMILIES];
        tables.into_iter().chain([mixed::FAMILIES]).flatten()
    }

    /// The family of a name.
    pub fn named(name: &str) -> Option<&'static Self> {
        Self::all().find(|family| family.name == name)
    }

    /// Trial `number` of a seed: always the same.
    pub fn trial(&self, seed: u64, number: u64) -> Trial {
        let words = self.name.bytes().map(u64::from).chain([seed, number]);
        let start = words.fold(0, |state, word| Dice(state ^ word).word());
        (self.make)(&mut Dice(start))
    }

    /// The trials of a seed, one after the other.
    pub fn trials(&self, seed: u64) -> impl Iterator<Item = Trial> + use<'_> {
        (0..).map(move |number| self.trial(seed, number))
    }
}
