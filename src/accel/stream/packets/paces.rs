//! What is tried with packets before each goes its way: what paid lately.

use super::super::GROUP;
use super::super::frustum::Apex;
use crate::accel::traversal::{LONGEST_PAUSE, Pace};

/// Most bundles that are not tried after a beam that has no point in common: to see that costs little.
const BEAM_GUESS_PAUSE: u32 = 1;
/// The same in small trees, where rays need not be a beam to be tried.
const GUESS_PAUSE: u32 = 7;

/// Most windows of rays in which no beams are looked for after one that had none, or none that paid.
const BEAM_PAUSE: u32 = 31;

/// What is tried with packets before each goes its way.
#[derive(Clone, Copy, Default, PartialEq)]
pub(super) struct Tries {
    /// To go as a bundle with this apex.
    pub(super) apex: Option<Apex>,
    /// To go as a bundle with an apex that has to be found: they are a beam.
    pub(super) guesses: bool,
    /// To enter the tree far from its root.
    pub(super) enters: bool,
}

/// How a bundle did.
#[derive(Clone, Copy, Default)]
pub(super) struct Outcome {
    /// All rays are answered.
    pub(super) done: bool,
    pub(super) paid: bool,
    /// So little that it had better have been a part of a large one.
    pub(super) met_little: bool,
}

/// Where a bundle does not pay, its neighbours hardly would.
#[derive(Clone, Copy, Debug)]
pub(super) struct Paces {
    /// Small bundles whose apex is known, and those whose is guessed.
    known: Pace,
    guessed: Pace,
    /// Large ones.
    large: Pace,
    large_guessed: Pace,
    /// Beams in windows of rays without an apex.
    beams: Pace,
    /// Short rays, which may enter the tree far from its root.
    pub(super) entries: Pace,
    /// Most bundles not tried after one whose rays have no point in common.
    guess_pause: u32,
}

impl Paces {
    /// Nothing learned yet: small bundles come first, as they tell whether large ones would pay.
    pub(super) fn new(is_small: bool) -> Self {
        let mut paces = Self {
            known: Pace::default(),
            guessed: Pace::default(),
            large: Pace::default(),
            large_guessed: Pace::default(),
            beams: Pace::default(),
            entries: Pace::default(),
            guess_pause: if is_small { GUESS_PAUSE } else { BEAM_GUESS_PAUSE },
        };
        paces.large.skip_next();
        paces.large_guessed.skip_next();
        paces
    }

    /// What is tried with the packets to come, of which the first ray ends or does not.
    #[inline(always)]
    pub(super) fn tries(&mut self, apex: Option<Apex>, is_beam: bool, ends: bool) -> Tries {
        Tries {
            apex: apex.filter(|_| self.known.tries()),
            guesses: is_beam && self.guessed.tries(),
            enters: apex.is_none() && ends && self.entries.tries(),
        }
    }

    /// True if beams are to be looked for among the packets to come.
    #[inline(always)]
    pub(super) fn looks_for_beams(&mut self) -> bool {
        self.beams.tries()
    }
    /// Takes note of whether there were any that paid.
    #[inline(always)]
    pub(super) fn learn_beams(&mut self, found: bool) {
        self.beams.learn_within(if found { 0 } else { -1 }, BEAM_PAUSE);
    }

    /// True if so many packets are to go as one large bundle.
    #[inline(always)]
    pub(super) fn tries_large(&mut self, apex: Option<Apex>, is_beam: bool, packets: usize) -> bool {
        packets > GROUP
            && match apex {
                Some(_) => !self.known.is_resting() && self.large.tries(),
                None => is_beam && self.large_guessed.tries(),
            }
    }

    /// Takes note of how a small bundle did; nothing where its rays were not as the apex says.
    #[inline(always)]
    pub(super) fn learn(&mut self, is_guessed: bool, outcome: Option<Outcome>) {
        let (pace, large) = match is_guessed {
            true => (&mut self.guessed, &mut self.large_guessed),
            false => (&mut self.known, &mut self.large),
        };
        match outcome {
            Some(outcome) => {
                pace.learn(if outcome.paid { 0 } else { -1 });
                if !outcome.met_little {
                    large.skip_next();
                }
            }
            None if is_guessed => pace.learn_within(-1, self.guess_pause),
            None => {}
        }
    }

    /// The same for a large one. One that paid says little of the next: background pays, too.
    #[inline(always)]
    pub(super) fn learn_large(&mut self, is_guessed: bool, paid: bool) {
        let (pace, longest) = match is_guessed {
            true => (&mut self.large_guessed, self.guess_pause),
            false => (&mut self.large, LONGEST_PAUSE),
        };
        if paid { pace.trust_more() } else { pace.learn_within(-1, longest) }
    }
}
