//! Axes as a bundle of rays sees them: `z` is the one on which they go farthest, forward.
//!
//! Parallel rays have their apex infinitely far away. They see space leaning, so that all of them go along `z`, and what has
//! coordinates `x` and `y` is seen there at any distance.

use wide::f32x8;

use crate::math::{Lane, Vec3, three};

/// Which stored axes stand for `x`, `y` and `z`, seen from the eye: the apex, or where one of the parallel rays starts.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct View {
    pub(super) axes: [usize; 3],
    /// Rays go against the stored axis that stands for `z`.
    pub(super) backward: bool,
    pub(super) eye: [f32; 3],
    /// The slopes of parallel rays.
    pub(super) lean: Option<[f32; 2]>,
}

/// Least, then greatest coordinates of eight boxes, as a view sees them.
pub(in super::super) type Boxes = [Vec3<f32x8>; 2];

impl View {
    /// The view along the axis on which a direction goes farthest.
    pub(super) fn along(d: [f32; 3], eye: [f32; 3]) -> Self {
        let size = d.map(f32::abs);
        let z = if size[0] >= size[1] && size[0] >= size[2] {
            0
        } else if size[1] >= size[2] {
            1
        } else {
            2
        };
        Self { axes: [(z + 1) % 3, (z + 2) % 3, z], backward: d[z] < 0.0, eye, lean: None }
    }
    /// The view along parallel rays, of which one starts at the eye.
    pub(super) fn along_all(d: [f32; 3], eye: [f32; 3]) -> Self {
        let upright = Self::along(d, eye);
        let d = upright.direction(Vec3::splat(d)).get(0);
        Self { lean: Some([d[0] / d[2], d[1] / d[2]]), ..upright }
    }
    /// How much slopes differ from those of parallel rays.
    #[inline(always)]
    pub(super) fn leans_from(&self, [a, b]: [f32x8; 2]) -> f32x8 {
        let [x, y] = self.lean.unwrap_or_default().map(f32x8::splat);
        Lane::max((a - x).abs(), (b - y).abs())
    }
    #[inline(always)]
    pub(super) fn direction(&self, d: Vec3<f32x8>) -> Vec3<f32x8> {
        let d = [d.x, d.y, d.z];
        let [x, y, z] = self.axes;
        Vec3::new(d[x], d[y], if self.backward { -d[z] } else { d[z] })
    }
    /// A point, given by its stored coordinates.
    #[inline(always)]
    pub(in super::super) fn point(&self, p: impl Fn(usize) -> f32x8) -> Vec3<f32x8> {
        let p = self.upright(p);
        let Some([x, y]) = self.lean else { return p };
        Vec3::new(p.x - f32x8::splat(x) * p.z, p.y - f32x8::splat(y) * p.z, p.z)
    }
    /// Where parallel rays from so far off the eye meet the plane across; nothing for other rays.
    #[inline(always)]
    pub(super) fn across(&self, from: Vec3<f32x8>) -> Option<[f32x8; 2]> {
        let [x, y] = self.lean?.map(f32x8::splat);
        Some([from.x - x * from.z, from.y - y * from.z])
    }
    #[inline(always)]
    fn upright(&self, p: impl Fn(usize) -> f32x8) -> Vec3<f32x8> {
        let [x, y, z] = three(|i| p(self.axes[i]) - f32x8::splat(self.eye[self.axes[i]]));
        Vec3::new(x, y, if self.backward { -z } else { z })
    }
    /// Boxes from their stored coordinates, by axis.
    #[inline(always)]
    pub(in super::super) fn boxes(&self, lo: impl Fn(usize) -> f32x8, hi: impl Fn(usize) -> f32x8) -> Boxes {
        let (a, b) = (self.upright(lo), self.upright(hi));
        let [lo, hi] = match self.backward {
            true => [Vec3 { z: b.z, ..a }, Vec3 { z: a.z, ..b }],
            false => [a, b],
        };
        let Some([x, y]) = self.lean else { return [lo, hi] };
        let across = |slope: f32, least: f32x8, greatest: f32x8| {
            let (near, far) = (f32x8::splat(slope) * lo.z, f32x8::splat(slope) * hi.z);
            [least - Lane::max(near, far), greatest - Lane::min(near, far)]
        };
        let ([x0, x1], [y0, y1]) = (across(x, lo.x, hi.x), across(y, lo.y, hi.y));
        [Vec3::new(x0, y0, lo.z), Vec3::new(x1, y1, hi.z)]
    }
}
