//! octray: a data-oriented CPU ray tracer.

#![deny(unsafe_code)]
#![warn(missing_docs)]

pub mod accel;
pub mod cli;
pub mod describe;
pub mod film;
pub mod geometry;
pub mod intersect;
pub mod load;
pub mod math;
pub mod output;
pub mod sampling;
pub mod scene;
pub mod shading;
pub mod wavefront;
