//! Primitives as columns: what trees are built over and surfaces are evaluated from.

mod columns;
mod memory;

pub use columns::{Cylinders, Geometry, Group, Instance, NO_MATERIAL, Planes, Spheres, Triangles};

pub(crate) use columns::{push3, row3};
pub(crate) use memory::{bytes, bytes_of};

use crate::math::{Lane, Real, Vec3, WIDTH};

/// The rows of a column named by lanes. Eight neighbours often ask for the same row: then one look-up serves all.
#[inline(always)]
pub(crate) fn gather<L: Lane>(column: &[f32], rows: &[u32; WIDTH]) -> L {
    let value = |row: u32| <L::Scalar as Real>::from_f32(column[row as usize]);
    if *rows == [rows[0]; WIDTH] {
        return L::splat(value(rows[0]));
    }
    L::from_fn(|i| value(rows[i]))
}

/// The rows of three columns named by lanes.
#[inline(always)]
pub(crate) fn gather3<L: Lane>(columns: &[Vec<f32>; 3], rows: &[u32; WIDTH]) -> Vec3<L> {
    let [x, y, z] = columns;
    Vec3::new(gather(x, rows), gather(y, rows), gather(z, rows))
}
