//! Ray against triangle.

mod exact;
mod filtered;
mod glimpse;
mod moller_trumbore;
mod near;
pub mod oracle;
mod woop;

pub use exact::ExactVolumes;
pub use filtered::FilteredVolumes;
pub use glimpse::Glimpse;
pub use moller_trumbore::MollerTrumbore;
pub use woop::Woop;

use crate::math::{Aabb, Lane, Vec3, three};

/// Where the line of a ray meets the plane of a triangle: `(t, u, v)`, not finite where it does not.
///
/// Cramer's rule on `o + t d = v0 + u e1 + v e2` with the triple products shared.
///
/// **Source:** Moeller and Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997.
#[inline(always)]
fn plane_coordinates<L: Lane>(origin: Vec3<L>, direction: Vec3<L>, [v0, v1, v2]: [Vec3<L>; 3]) -> (L, L, L) {
    let (e1, e2, s) = (v1 - v0, v2 - v0, origin - v0);
    let (p, q) = (direction.cross(e2), s.cross(e1));
    let scale = L::one() / e1.dot(p);
    (e2.dot(q) * scale, s.dot(p) * scale, direction.dot(q) * scale)
}

/// The box of a triangle, exact.
#[inline]
pub fn bounds([a, b, c]: [[f32; 3]; 3]) -> Aabb {
    Aabb { min: three(|k| a[k].min(b[k]).min(c[k])), max: three(|k| a[k].max(b[k]).max(c[k])) }
}

#[cfg(test)]
mod tests;
