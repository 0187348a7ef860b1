//! Rays, hits and the primitive tests, each written once for every lane width and number type.
//!
//! A test takes rays and primitives as lanes: eight rays against one primitive (the primitive splatted) or one ray
//! against eight primitives (the ray splatted). Beside each kernel stands an independent plain version in `f64`, its
//! `oracle`, that it is property-tested against; above them all stands [`oracle`], which does not round at all.

pub mod aabb;
mod curved;
pub mod cylinder;
mod doubt;
pub mod oracle;
pub mod plane;
mod question;
mod ray;
pub mod sphere;
pub(crate) mod testing;
mod tier;
pub mod triangle;
mod triangle_test;

pub use curved::Curved;
pub use ray::{Hit, LaneHit, PrimId, PrimKind, Ray, RayLanes};
pub use tier::{Exact, Fast, Tier, TierName, Watertight};
pub use triangle_test::TriangleTest;
