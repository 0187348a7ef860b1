//! Triangles against pyramids, and against their rays, by their edges.

use wide::f32x8;

use super::slopes::Slopes;
use crate::intersect::triangle::Glimpse;
use crate::math::{Lane, Mask, Real, Vec3, fused_cross, fused_dot, three};

/// Roundoffs along `z` of what is met, of the largest coordinates: as in [`Glimpse`], and a few more.
const ALONG_ROUNDOFFS: f64 = 24.0;
/// Times the range along `z` and the share of the pad in the sum of edge functions: see [`Edges::meeting`].
const WEIGHTS_OFF: f32 = 4.0;
/// Roundoffs in the products of an edge function, of the square of how far corners and rays are from the middle.
const PRODUCT_ROUNDOFFS: f64 = 64.0;
/// Edge functions below say nothing of what the triangle test makes of them: there products underflow.
const LEAST_EDGE: f32 = 1e-18;

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
    /// Of the corners, and over how much they reach.
    z: [f32x8; 3],
    range: f32x8,
    /// What `z` of where a ray meets the triangle may be off by, however far from its edges.
    z_off: f32x8,
    /// Triangles so large that most rays are clearly beside their edges, as bits.
    pub(in super::super) large: u32,
}

/// Eight rays, as edges need them.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Eight {
    /// About the middle.
    pub(super) slopes: [f32x8; 2],
    /// How much `t` grows along `z`.
    pub(super) per_z: f32x8,
}

/// What rays of a pyramid have in common, as edges need it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Middle {
    /// Slopes.
    pub(super) slopes: [f32x8; 2],
    /// Largest slope about them.
    pub(super) spread: f32x8,
    /// Most that slopes of a packet differ by, either way.
    pub(super) packet_spread: f32x8,
    /// What edge functions may be off by, as a part of how far corners are from the rays: what the corners' distances across
    /// and along count for that, and the rest.
    pub(super) edge_pad: [f32x8; 3],
    /// Rays that start at the apex do so within this.
    pub(super) start_off: f32x8,
    /// By how much rays pass the apex; infinite for rays without one.
    pub(super) stray: f32x8,
    /// Triangles whose edge functions add up to so many pads are large: in smaller ones many rays are not clearly beside the edges.
    pub(super) large: f32x8,
}

impl Edges {
    /// Edge functions for rays of packets that meet the range of slopes over which a triangle is seen, given how wide that is;
    /// for any rays without it.
    #[inline(always)]
    pub(super) fn of(corners: [Vec3<f32x8>; 3], seen_over: Option<f32x8>, middle: &Middle) -> Self {
        let [x, y] = middle.slopes;
        let shear = |p: Vec3<f32x8>| Vec3::new(p.x - x * p.z, p.y - y * p.z, p.z);
        let [a, b, c] = three(|v| shear(corners[v]));
        let size = a.abs().max(b.abs()).max(c.abs());
        let across = Lane::max(size.x, size.y);
        let normal = [fused_cross(b, c), fused_cross(c, a), fused_cross(a, b)];
        // What underflows is less.
        let tiny = f32x8::splat(f32::MIN_POSITIVE);
        let [by_across, by_along, rest] = middle.edge_pad;
        let off = across.mul_add_fast(by_across, size.z.mul_add_fast(by_along, rest));
        let about = across + middle.spread * size.z;
        let near = match seen_over {
            Some(width) => Lane::min(about, (width + middle.packet_spread) * size.z),
            None => about,
        };
        let rounding = about * about * f32x8::splat((PRODUCT_ROUNDOFFS * f32::ROUNDOFF) as f32);
        let pad = off.mul_add_fast(near, rounding + tiny);
        let (volume, slack) = (fused_dot(normal[0], a), pad * size.z + tiny);
        let outside = sides(volume, slack + area(&normal) * middle.stray, pad);
        let z = [a.z, b.z, c.z];
        let range = Lane::max(Lane::max(a.z, b.z), c.z) - Lane::min(Lane::min(a.z, b.z), c.z);
        let roundoffs = f32x8::splat((ALONG_ROUNDOFFS * f32::ROUNDOFF) as f32);
        let z_off = (across + size.z).mul_add_fast(roundoffs, middle.start_off);
        let large = (normal[0].z + normal[1].z + normal[2].z).abs().gt(pad * middle.large).bits();
        Self { normal, pad, volume, slack, outside, z, range, z_off, large }
    }

    /// What is certain of where eight rays from the apex meet triangle `i`: a ray with edge functions of one sign, all beyond the pad,
    /// certainly passes the triangle test.
    ///
    /// With sum `S` of the edge functions, each off by half the pad at most, the weights are off by `3/2 pad / (S / 2)` in
    /// all, and what they weigh, the corners' `z`, by as much of their range.
    #[inline(always)]
    pub(in super::super) fn meeting(&self, i: usize, rays: &Eight) -> Glimpse<f32x8> {
        let at = |v: &f32x8| f32x8::splat(v.get(i));
        let [e0, e1, e2] = self.at(i, &rays.slopes);
        let pad = at(&self.pad);
        let sure = pad + f32x8::splat(LEAST_EDGE);
        let least = Lane::min(Lane::min(e0, e1), e2);
        let greatest = Lane::max(Lane::max(e0, e1), e2);
        let share = f32x8::ONE / (e0 + e1 + e2);
        let [a, b, c] = self.z.each_ref().map(at);
        let z = e0.mul_add_fast(a, e1.mul_add_fast(b, e2 * c)) * share;
        let weights_off = pad * at(&self.range) * f32x8::splat(WEIGHTS_OFF);
        let tiny = f32x8::splat(f32::MIN_POSITIVE);
        let apart =
            (weights_off.mul_add_fast(share.abs(), at(&self.z_off))).mul_add_fast(rays.per_z.abs(), tiny);
        let t = z * rays.per_z;
        let (near, far) = (t - apart, t + apart);
        let in_range = share.abs().ge(tiny) & Lane::is_finite(far - near) & is_moderate(rays.per_z);
        let inside = (least.gt(sure) | greatest.lt(-sure)) & in_range;
        let infinity = f32x8::splat(f32::INFINITY);
        let (near, far) = (Lane::select(inside, near, -infinity), Lane::select(inside, far, infinity));
        Glimpse::between(inside, near, far)
    }

    /// Edge functions of eight rays for triangle `i`.
    #[inline(always)]
    fn at(&self, i: usize, [a, b]: &[f32x8; 2]) -> [f32x8; 3] {
        three(|k| {
            let n = &self.normal[k];
            let [x, y, z] = [&n.x, &n.y, &n.z].map(|c| f32x8::splat(c.get(i)));
            a.mul_add_fast(x, b.mul_add_fast(y, z))
        })
    }

    /// Lanes of eight rays, by their slopes about the middle, that do not certainly miss triangle `i`, as bits.
    #[inline(always)]
    pub(in super::super) fn may_hit(&self, i: usize, rays: &Eight) -> u32 {
        self.may_and_must_pass(i, rays).0
    }

    /// The same, and of those the lanes that certainly pass inside, as far as the triangle test can tell.
    #[inline(always)]
    pub(in super::super) fn may_and_must_pass(&self, i: usize, rays: &Eight) -> (u32, u32) {
        let [e0, e1, e2] = self.at(i, &rays.slopes);
        let least = Lane::min(Lane::min(e0, e1), e2);
        let greatest = Lane::max(Lane::max(e0, e1), e2);
        let [below, above] = [0, 1].map(|side: usize| f32x8::splat(self.outside[side].get(i)));
        let sure = f32x8::splat(self.pad.get(i) + LEAST_EDGE);
        let may = (least.lt(below) & greatest.gt(above)).bits() ^ 0xff;
        (may, may & (least.gt(sure) | greatest.lt(-sure)).bits())
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
        (missed | beyond).bits() ^ 0xff
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

/// True far from where quotients of directions overflow or underflow.
#[inline(always)]
fn is_moderate(x: f32x8) -> <f32x8 as Lane>::Mask {
    x.abs().ge(f32x8::splat(1e-18)) & x.abs().le(f32x8::splat(1e18))
}
