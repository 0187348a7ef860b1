//! What the plane of a triangle tells of rays that certainly pass inside its edges: whether they start behind it, and whether
//! they end before it.
//!
//! Plainly: the primitive test finds `t` in `f64`; a ray hits if that lies between its ends. Here `t` is a quotient of two
//! heights above the plane, which are compared instead: a shadow ray needs no more. What rounding could make in either is
//! left to the primitive test. Of most rays the triangle that they left is asked, and is behind them.

use crate::intersect::RayLanes;
use crate::math::{Lane, Vec3};

/// Heights below say nothing, as a part of the product of two edges and what pyramids are widened by, some 1e-5 of the largest
/// coordinate: thousands of roundoffs of `f64`.
const LEAST_HEIGHT: f64 = 1e-7;
/// What `t` of the primitive test may be off by, for the rounding to `f32` and more.
const OFF: f64 = 1e-6;

/// The plane of a triangle, scaled.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Plane {
    corner: [f64; 3],
    normal: [f64; 3],
    least_height: f64,
}

impl Plane {
    /// The plane through three corners; `pad` is what the pyramid of rays that meet it is widened by.
    #[inline(always)]
    pub(super) fn of(corners: [[f32; 3]; 3], pad: f32) -> Self {
        let [a, b, c] = corners.map(|p| Vec3::<f64>::splat(p.map(f64::from)));
        let (u, v) = (b - a, c - a);
        let size = |e: Vec3<f64>| e.x.abs() + e.y.abs() + e.z.abs();
        let least_height = size(u) * size(v) * f64::from(pad) * LEAST_HEIGHT;
        Self { corner: a.get(0), normal: u.cross(v).get(0), least_height }
    }

    /// Of rays that pass inside the edges, those that certainly hit before `limit`, and those that certainly do not.
    ///
    /// **Needs:** no `t_min` below zero.
    #[inline(always)]
    pub(in super::super) fn sides<L: Lane>(&self, rays: &RayLanes<L>, limit: L) -> [L::Mask; 2] {
        let (zero, wide) = (<L::Double as Lane>::zero(), <L::Double as Lane>::splat);
        let normal = Vec3::splat(self.normal);
        let height = (Vec3::splat(self.corner) - rays.origin.widen()).dot(normal);
        let climb = rays.direction.widen().dot(normal);
        let is_behind = (height * climb).lt(zero);
        let (height, climb) = (height.abs(), climb.abs());
        let (least, greatest) = (height * wide(1.0 - OFF), height * wide(1.0 + OFF));
        let [starts, ends] = [rays.t_min, limit].map(|t| climb * t.widen());
        let is_clear = height.gt(wide(self.least_height));
        let hits = is_clear & !is_behind & least.gt(starts) & greatest.lt(ends);
        let misses = is_clear & (is_behind | least.gt(ends));
        [hits, misses].map(L::narrow_mask)
    }
}
