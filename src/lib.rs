//! octray: a data-oriented CPU ray tracer.

#![deny(unsafe_code)]
#![warn(missing_docs)]

pub mod math;
pub mod sampling;
pub mod film;
pub mod intersect;
pub mod describe;
pub mod load;
pub mod scene;
pub mod accel;
pub mod shading;
pub mod wavefront;
pub mod output;
pub mod cli;
