//! Triangles against pyramids, by their edges.

use wide::f32x8;

use super::slopes::Slopes;
use crate::math::{Lane, Mask, Vec3, fused_cross, fused_dot, three};

/// Edge functions of eight triangles: the ray of slopes `a` and `b` about the middle passes edge `i` on the side that the
/// sign of `normal[i] . (a, b, 1)` tells, if it is farther from zero than the pad.
///
/// Coordinates are sheared by the middle slopes, so that they are small for triangles that rays may meet, and so are
/// the errors of their products.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Edges {
    pub(super) normal: [Vec3<f32x8>; 3],
    pub(super) pad: f32x8,
    /// Greatest `z`, either way.
    pub(super) farthest: f32x8,
    /// Six times the volume between the apex and the triangle: `z` is this over `sum of normal . (a, b, 1)`.
    pub(super) volume: f32x8,
}

impl Edges {
    #[inline(always)]
    pub(super) fn of(corners: [Vec3<f32x8>; 3], middle: [f32x8; 2], spread: f32x8, pad: f32x8) -> Self {
        let shear = |p: Vec3<f32x8>| Vec3::new(p.x - middle[0] * p.z, p.y - middle[1] * p.z, p.z);
        let [a, b, c] = three(|v| shear(corners[v]));
        let size = a.abs().max(b.abs()).max(c.abs());
        let across = Lane::max(size.x, size.y) + spread * size.z;
        let normal = [fused_cross(b, c), fused_cross(c, a), fused_cross(a, b)];
        Self { normal, pad: pad * across, farthest: size.z, volume: fused_dot(normal[0], a) }
    }

    /// Lanes where not all rays pass on the outer side of one edge, and not all meet the plane of the triangle beyond their
    /// reach.
    #[inline(always)]
    pub(super) fn met(&self, slopes: &Slopes, reach: f32x8) -> u32 {
        let ([n0, n1, n2], pad) = (self.normal, self.pad);
        let range = |n: Vec3<f32x8>| {
            let (a0, a1) = (slopes.a[0] * n.x, slopes.a[1] * n.x);
            let (b0, b1) = (slopes.b[0] * n.y, slopes.b[1] * n.y);
            let least = n.z + Lane::min(a0, a1) + Lane::min(b0, b1);
            (least, n.z + Lane::max(a0, a1) + Lane::max(b0, b1))
        };
        let (r0, r1, r2, whole) = (range(n0), range(n1), range(n2), range(n0 + n1 + n2));
        // Seen by all from the front, or by all from the back: only then does a sign tell the side.
        let front = whole.0.gt(pad * f32x8::splat(4.0));
        let back = whole.1.lt(pad * f32x8::splat(-4.0));
        let least_of_greatest = Lane::min(Lane::min(r0.1, r1.1), r2.1);
        let greatest_of_least = Lane::max(Lane::max(r0.0, r1.0), r2.0);
        let missed = (front & least_of_greatest.lt(-pad)) | (back & greatest_of_least.gt(pad));
        // The volume is off by less than the pad at the farthest corner.
        let slack = pad * self.farthest;
        let beyond = (front & (self.volume - slack).gt(reach * (whole.1 + pad)))
            | (back & (-self.volume - slack).gt(reach * (pad - whole.0)));
        (!(missed | beyond)).bits()
    }
}
