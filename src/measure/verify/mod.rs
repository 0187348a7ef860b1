//! `verify`: every kernel and every way of asking it, over families of hard cases, against exact arithmetic.
//!
//! A [`Family`] makes [`Trial`]s from a seed; the exact oracle says what is true of each ray; an intersector answers; what
//! differs is counted in a [`Report`] beside the documented [`Bounds`].

mod bounds;
mod families;
mod octray;
mod report;
mod run;
mod table;
mod tally;
#[cfg(test)]
mod tests;
mod trial;
mod truth;

pub use bounds::{Bounds, Promise};
pub use families::Family;
pub use report::{FamilyReport, Rate, Report, Ulps};
pub use run::{Effort, verify_family};
pub use table::table;
pub use trial::{Claim, Shape, Trial};
pub use truth::EXCUSED_ROUNDOFFS;
