//! Leaving a surface without hitting it.

use crate::math::{Lane, Vec3};

/// A point moved off its surface, to the side of the normal, just beyond what rounding may have done to it.
///
/// A point each of whose coordinates may be off by `error` lies within `error (|nx| + |ny| + |nz|)` of the surface along the
/// unit normal; so that far is certainly on the other side of it. No epsilon: the scale is that of the error.
///
/// **Source:** Pharr, Jakob and Humphreys, 4th ed., 6.8.6.
#[inline(always)]
pub(crate) fn offset_along<L: Lane>(point: Vec3<L>, error: L, normal: Vec3<L>) -> Vec3<L> {
    let size = normal.abs();
    point + normal * (error * (size.x + size.y + size.z))
}
