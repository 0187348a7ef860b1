//! Triangles against pyramids, and against their rays, by their edges.

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
    normal: [Vec3<f32x8>; 3],
    pad: f32x8,
    /// Six times the volume between the apex and the triangle: `z` is this over `sum of normal . (a, b, 1)`.
    volume: f32x8,
    /// What it may be off by: the pad at the farthest corner.
    slack: f32x8,
    /// A ray that has an edge function below the first and one above the second does not hit.
    outside: [f32x8; 2],
}

/// What rays of a pyramid have in common, as edges need it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Middle {
    /// Slopes.
    pub(super) slopes: [f32x8; 2],
    /// Largest slope about them.
    pub(super) spread: f32x8,
    /// For edge functions, as a part of how far corners are from the middle.
    pub(super) edge_pad: f32x8,
    /// By how much rays pass the apex; infinite for rays without one.
    pub(super) stray: f32x8,
}

impl Edges {
    #[inline(always)]
    pub(super) fn of(corners: [Vec3<f32x8>; 3], middle: &Middle) -> Self {
        let [x, y] = middle.slopes;
        let shear = |p: Vec3<f32x8>| Vec3::new(p.x - x * p.z, p.y - y * p.z, p.z);
        let [a, b, c] = three(|v| shear(corners[v]));
        let size = a.abs().max(b.abs()).max(c.abs());
        let normal = [fused_cross(b, c), fused_cross(c, a), fused_cross(a, b)];
        // What underflows is less.
        let tiny = f32x8::splat(f32::MIN_POSITIVE);
        let pad = middle.edge_pad * (Lane::max(size.x, size.y) + middle.spread * size.z) + tiny;
        let (volume, slack) = (fused_dot(normal[0], a), pad * size.z + tiny);
        let outside = sides(volume, slack + area(&normal) * middle.stray, pad);
        Self { normal, pad, volume, slack, outside }
    }

    /// Lanes of eight rays, by their slopes about the middle, that do not certainly miss triangle `i`, as bits.
    #[inline(always)]
    pub(in super::super) fn may_hit(&self, i: usize, [a, b]: &[f32x8; 2]) -> u32 {
        let [e0, e1, e2] = three(|k| {
            let n = &self.normal[k];
            let [x, y, z] = [&n.x, &n.y, &n.z].map(|c| f32x8::splat(c.get(i)));
            a.mul_add_fast(x, b.mul_add_fast(y, z))
        });
        let least = Lane::min(Lane::min(e0, e1), e2);
        let greatest = Lane::max(Lane::max(e0, e1), e2);
        let [below, above] = [0, 1].map(|side: usize| f32x8::splat(self.outside[side].get(i)));
        (!(least.lt(below) & greatest.gt(above))).bits()
    }

    /// Lanes where not all rays pass on the outer side of one edge, and not all meet the plane of the triangle behind the
    /// apex or beyond their reach.
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
        let [below, above] = self.outside;
        let missed = (front & least_of_greatest.lt(below)) | (back & greatest_of_least.gt(above));
        let (volume, slack) = (self.volume, self.slack);
        let beyond = (front & (volume - slack).gt(reach * (whole.1 + pad)))
            | (back & (-volume - slack).gt(reach * (pad - whole.0)));
        (!(missed | beyond)).bits()
    }
}

/// Twice the area that triangles show to axes, in all.
#[inline(always)]
fn area(normal: &[Vec3<f32x8>; 3]) -> f32x8 {
    let whole = (normal[0] + normal[1] + normal[2]).abs();
    whole.x + whole.y + whole.z
}

/// Below what, and above what, edge functions tell a miss: both pads where the apex may lie on either side of the triangle,
/// else a pad on one side alone, as rays would have to go backward to meet the other.
#[inline(always)]
fn sides(volume: f32x8, off: f32x8, pad: f32x8) -> [f32x8; 2] {
    let all = f32x8::splat(f32::INFINITY);
    [Lane::select(volume.lt(-off), all, -pad), Lane::select(volume.gt(off), -all, pad)]
}
