//! Culling boxes of the tree: conservative, in `f32`, fused where the build fuses.

use wide::f32x8;

use super::safe_reciprocal;
use crate::math::{Lane, Vec3, WIDTH, eight};

/// Roundoffs of the largest coordinate by which tree boxes are widened: those that [`super::OwnBox`] allows a triangle
/// plus the roundings in which the fused and the plain slab may differ (at most 6, counted with the subtraction of the
/// origin), plus as many again for origins rounded to `f32` in the `Exact` tier.
const PAD_ROUNDOFFS: f64 = 36.0;

/// A ray of [`CullRay`] by itself.
#[derive(Clone, Copy, Debug)]
pub struct OneCullRay {
    /// Reciprocal and near offset by axis, and the far offset of the first two.
    row: [f32; WIDTH],
    far_offset_z: f32,
}

/// Rays prepared for slab tests against boxes of the tree.
///
/// **Accuracy:** the interval returned holds that of [`super::OwnBox`] of every primitive in the box, as long as no
/// coordinate of the box is larger than `scale`.
#[derive(Clone, Copy, Debug)]
pub struct CullRay<L> {
    reciprocal: Vec3<L>,
    near_offset: Vec3<L>,
    far_offset: Vec3<L>,
}

impl<L: Lane> CullRay<L> {
    /// Prepares rays for boxes whose coordinates are at most `scale`.
    #[inline(always)]
    pub fn new(origin: Vec3<L>, direction: Vec3<L>, scale: L) -> Self {
        let reciprocal = safe_reciprocal(direction);
        let half_roundoffs = L::constant(PAD_ROUNDOFFS * f64::from(f32::EPSILON) / 4.0);
        let size = origin.abs().max_component() + scale;
        // Twice the size first: where any product of the slab could overflow, the width does, and that slab culls nothing.
        let width = reciprocal.abs() * (size + size) * half_roundoffs;
        let start = origin.scale(reciprocal);
        Self { reciprocal, near_offset: -(start + width), far_offset: width - start }
    }

    /// Bit k set in lane i where the ray goes against axis k.
    #[inline(always)]
    pub fn backward(&self) -> [L::Mask; 3] {
        let zero = L::zero();
        [self.reciprocal.x.lt(zero), self.reciprocal.y.lt(zero), self.reciprocal.z.lt(zero)]
    }

    /// Where the rays enter and leave, given for each axis the plane they meet first and the one they meet last.
    #[inline(always)]
    pub fn interval(&self, near: Vec3<L>, far: Vec3<L>, t_min: L, t_max: L) -> (L, L) {
        let (r, n, f) = (self.reciprocal, self.near_offset, self.far_offset);
        let enter = near.x.mul_add_fast(r.x, n.x).max(t_min);
        let enter = near.y.mul_add_fast(r.y, n.y).max(enter);
        let enter = near.z.mul_add_fast(r.z, n.z).max(enter);
        let leave = far.x.mul_add_fast(r.x, f.x).min(t_max);
        let leave = far.y.mul_add_fast(r.y, f.y).min(leave);
        let leave = far.z.mul_add_fast(r.z, f.z).min(leave);
        (enter, leave)
    }

    /// [`CullRay::interval`] for rays of any direction.
    #[inline(always)]
    pub fn interval_any(&self, lo: Vec3<L>, hi: Vec3<L>, t_min: L, t_max: L) -> (L, L) {
        let [bx, by, bz] = self.backward();
        let near = Vec3::new(L::select(bx, hi.x, lo.x), L::select(by, hi.y, lo.y), L::select(bz, hi.z, lo.z));
        let far = Vec3::new(L::select(bx, lo.x, hi.x), L::select(by, lo.y, hi.y), L::select(bz, lo.z, hi.z));
        self.interval(near, far, t_min, t_max)
    }
}

impl CullRay<f32x8> {
    /// Each ray by itself.
    #[inline(always)]
    pub fn each(&self) -> [OneCullRay; WIDTH] {
        let (r, n, f) = (self.reciprocal, self.near_offset, self.far_offset);
        let rows = f32x8::transpose([r.x, r.y, r.z, n.x, n.y, n.z, f.x, f.y]);
        eight(|i| OneCullRay { row: rows[i].to_array(), far_offset_z: f.z.get(i) })
    }

    /// One ray in all lanes.
    #[inline(always)]
    pub fn splat(one: &OneCullRay) -> Self {
        let [rx, ry, rz, nx, ny, nz, fx, fy] = one.row;
        let splat = |x, y, z| Vec3::splat([x, y, z]);
        let far_offset = splat(fx, fy, one.far_offset_z);
        Self { reciprocal: splat(rx, ry, rz), near_offset: splat(nx, ny, nz), far_offset }
    }
}
