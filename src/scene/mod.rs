//! The scene as compiled: columns, and what they require.

mod camera;
mod geometry;
mod material;

pub use camera::{Camera, CameraRays, Projection};
pub use geometry::{Cylinders, Geometry, Group, Instance, NO_MATERIAL, Planes, Spheres, Triangles};
pub use material::{MaterialRow, Materials, NO_TEXTURE, Scatter};

use crate::math::{Lane, Real, Vec3};

pub(crate) use geometry::{push3, row3};

/// The rows of a column named by lanes.
#[inline(always)]
pub(crate) fn gather<L: Lane>(column: &[f32], rows: &[u32; 8]) -> L {
    L::from_fn(|i| <L::Scalar as Real>::from_f32(column[rows[i] as usize]))
}

/// The rows of three columns named by lanes.
#[inline(always)]
pub(crate) fn gather3<L: Lane>(columns: &[Vec<f32>; 3], rows: &[u32; 8]) -> Vec3<L> {
    let [x, y, z] = columns;
    Vec3::new(gather(x, rows), gather(y, rows), gather(z, rows))
}
