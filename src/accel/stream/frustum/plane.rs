//! What the plane of a triangle tells of rays that certainly pass inside its edges: where they meet it.
//!
//! Plainly: the primitive test finds `t` in `f64`, a quotient of two heights above the plane. Departures: a shadow ray needs
//! only to know whether that lies between its ends, so the heights are compared; and other rays need it of the nearest hit
//! alone, so bounds will do. What rounding could make in the heights is left to the primitive test. The triangle that is asked
//! most is the one that rays left.

use crate::intersect::RayLanes;
use crate::intersect::triangle::Glimpse;
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
        let [height, climb] = self.heights(rays);
        let is_behind = (height * climb).lt(zero);
        let (height, climb) = (height.abs(), climb.abs());
        let off = height * wide(OFF) + wide(self.height_off());
        let (least, greatest) = (height - off, height + off);
        let [starts, ends] = [rays.t_min, limit].map(|t| climb * t.widen());
        let is_clear = height.gt(wide(self.least_height));
        let hits = is_clear & !is_behind & least.gt(starts) & greatest.lt(ends);
        let misses = is_clear & (is_behind | least.gt(ends));
        [hits, misses].map(L::narrow_mask)
    }

    /// Bounds on where rays that pass inside the edges meet the triangle, before their start or after.
    #[inline(always)]
    pub(in super::super) fn meeting<L: Lane>(&self, lanes: L::Mask, rays: &RayLanes<L>) -> Glimpse<L> {
        let wide = <L::Double as Lane>::splat;
        let [height, climb] = self.heights(rays);
        let per_height = <L::Double as Lane>::one() / climb;
        let t = height * per_height;
        let off = height.abs() * wide(OFF) + wide(self.height_off());
        let apart = off * per_height.abs() + wide(f64::from(f32::MIN_POSITIVE));
        let is_clear = L::narrow_mask(height.abs().gt(wide(self.least_height)));
        let unknown = L::constant(f64::INFINITY);
        let near = L::select(is_clear, L::narrow(t - apart), -unknown);
        let far = L::select(is_clear, L::narrow(t + apart), unknown);
        Glimpse::between(lanes, near, far)
    }

    /// What a height may be off by, the primitive test's too.
    fn height_off(&self) -> f64 {
        0.125 * self.least_height
    }

    /// How far the plane is above where rays start, and by how much they rise, scaled.
    #[inline(always)]
    fn heights<L: Lane>(&self, rays: &RayLanes<L>) -> [L::Double; 2] {
        let normal = Vec3::splat(self.normal);
        let height = (Vec3::splat(self.corner) - rays.origin.widen()).dot(normal);
        [height, rays.direction.widen().dot(normal)]
    }
}
