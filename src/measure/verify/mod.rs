//! `verify`: every kernel and every way of asking it, over families of hard cases, against exact arithmetic.
//!
//! A [`Family`] makes [`Trial`]s from a seed; the exact oracle says what is true of each ray; an intersector answers; what
//! differs is counted in a [`Report`] beside the documented [`Bounds`]. Other intersectors are verified the same way once they
//! implement [`Intersector`]:
//!
//! ```
//! use octray::Ray;
//! use octray::measure::verify::{Bounds, Effort, Family, Intersector, Shape, verify_intersector};
//!
//! /// Spheres by the formula of school.
//! struct School;
//!
//! impl Intersector for School {
//!     type Scene = ([f32; 3], f32);
//!
//!     fn build(&self, shapes: &[Shape]) -> Option<Self::Scene> {
//!         match shapes {
//!             [Shape::Sphere { center, radius }] => Some((*center, *radius)),
//!             _ => None,
//!         }
//!     }
//!
//!     fn nearest(&self, (center, radius): &Self::Scene, ray: &Ray) -> Option<f32> {
//!         let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
//!         let from = [0, 1, 2].map(|k| ray.origin[k] - center[k]);
//!         let (a, b) = (dot(ray.direction, ray.direction), 2.0 * dot(from, ray.direction));
//!         let c = dot(from, from) - radius * radius;
//!         let root = (b * b - 4.0 * a * c).sqrt();
//!         [(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)].into_iter().find(|t| ray.t_min < *t && *t < ray.t_max)
//!     }
//! }
//!
//! let effort = Effort { rays: 500, seed: 1 };
//! let bounds = Bounds { gross: Some(0.0), ..Bounds::default() };
//! let ground = Family::named("ground").ok_or("no such family")?;
//! let report = verify_intersector("school", &School, ground, &bounds, effort).ok_or("no sphere in it")?;
//! // A sphere of radius 1e6 leaves `f32` no digits for a hit some units away.
//! assert!(report.t_ulps.ok_or("no hits")?.p99 > 1e5);
//!
//! let spheres = Family::named("spheres").ok_or("no such family")?;
//! let report = verify_intersector("school", &School, spheres, &bounds, effort).ok_or("no sphere in it")?;
//! assert!(!report.holds, "b squared less 4 a c cancels from far away, and overflows");
//! println!("{}", report.breaches().join("\n"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`peer_scene`] puts such an intersector beside octray in the bench; [`Family::trials`] gives the families as plain iterators,
//! and, with the feature `testkit`, `strategies` gives them to property tests.

mod bounds;
mod families;
mod octray;
mod report;
mod run;
mod table;
mod tally;
mod testkit;
#[cfg(test)]
mod tests;
mod timed;
mod trial;
mod truth;

pub use bounds::{Bounds, Promise};
pub use families::Family;
pub use report::{FamilyReport, Rate, Report, Ulps};
pub use run::{Effort, verify_family, verify_trial};
pub use table::table;
#[cfg(any(test, feature = "testkit"))]
pub use testkit::strategies;
pub use testkit::{Intersector, verify_intersector};
pub use timed::peer_scene;
pub use trial::{Claim, Shape, Trial};
pub use truth::EXCUSED_ROUNDOFFS;
