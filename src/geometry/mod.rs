//! Primitives as columns: what trees are built over and surfaces are evaluated from.

mod columns;
mod memory;

pub use columns::{Cylinders, Geometry, Group, Instance, NO_MATERIAL, Planes, Spheres, Triangles};

pub(crate) use columns::{push3, row3};
pub(crate) use memory::{bytes, bytes_of};

use crate::math::{Lane, Real, Vec3, WIDTH, eight};

/// Eight neighbours often ask for the same row: then one look-up serves all.
#[inline(always)]
fn are_same(rows: &[u32; WIDTH]) -> bool {
    *rows == [rows[0]; WIDTH]
}

/// The entries of a column in the rows named.
#[inline(always)]
pub(crate) fn entries<T: Copy>(column: &[T], rows: &[u32; WIDTH]) -> [T; WIDTH] {
    if are_same(rows) { [column[rows[0] as usize]; WIDTH] } else { each_entry(column, rows) }
}

/// The rows of a column named by lanes.
#[inline(always)]
pub(crate) fn gather<L: Lane>(column: &[f32], rows: &[u32; WIDTH]) -> L {
    if are_same(rows) {
        return L::splat(<L::Scalar as Real>::from_f32(column[rows[0] as usize]));
    }
    gather_each(column, rows)
}

/// The rows of three columns named by lanes.
#[inline(always)]
pub(crate) fn gather3<L: Lane>(columns: &[Vec<f32>; 3], rows: &[u32; WIDTH]) -> Vec3<L> {
    if are_same(rows) {
        return Vec3::splat_f32(row3(columns, rows[0] as usize));
    }
    gather3_each(columns, rows)
}

// Kept out of line: merged with the short way, they would take that one apart into single lanes, too.

#[inline(never)]
fn each_entry<T: Copy>(column: &[T], rows: &[u32; WIDTH]) -> [T; WIDTH] {
    eight(|i| column[rows[i] as usize])
}

#[inline(never)]
fn gather_each<L: Lane>(column: &[f32], rows: &[u32; WIDTH]) -> L {
    L::load_f32(&eight(|i| column[rows[i] as usize]))
}

#[inline(never)]
fn gather3_each<L: Lane>(columns: &[Vec<f32>; 3], rows: &[u32; WIDTH]) -> Vec3<L> {
    let [x, y, z] = columns.each_ref().map(|column| L::load_f32(&eight(|i| column[rows[i] as usize])));
    Vec3 { x, y, z }
}
