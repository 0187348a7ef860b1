//! Axes as a bundle of rays sees them: `z` is the one on which they go farthest, forward.

use wide::f32x8;

use crate::math::{Vec3, three};

/// Which stored axes stand for `x`, `y` and `z`, seen from the apex.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct View {
    pub(super) axes: [usize; 3],
    /// Rays go against the stored axis that stands for `z`.
    pub(super) backward: bool,
    pub(super) apex: [f32; 3],
}

/// Least, then greatest coordinates of eight boxes, as a view sees them.
pub(in super::super) type Boxes = [Vec3<f32x8>; 2];

impl View {
    /// The view along the axis on which a direction goes farthest.
    pub(super) fn along(d: [f32; 3], apex: [f32; 3]) -> Self {
        let size = d.map(f32::abs);
        let z = if size[0] >= size[1] && size[0] >= size[2] {
            0
        } else if size[1] >= size[2] {
            1
        } else {
            2
        };
        Self { axes: [(z + 1) % 3, (z + 2) % 3, z], backward: d[z] < 0.0, apex }
    }
    #[inline(always)]
    pub(super) fn direction(&self, d: Vec3<f32x8>) -> Vec3<f32x8> {
        let d = [d.x, d.y, d.z];
        let [x, y, z] = self.axes;
        Vec3::new(d[x], d[y], if self.backward { -d[z] } else { d[z] })
    }
    #[inline(always)]
    pub(in super::super) fn point(&self, p: impl Fn(usize) -> f32x8) -> Vec3<f32x8> {
        let [x, y, z] = three(|i| p(self.axes[i]) - f32x8::splat(self.apex[self.axes[i]]));
        Vec3::new(x, y, if self.backward { -z } else { z })
    }
    /// Boxes from their stored coordinates, by axis.
    #[inline(always)]
    pub(in super::super) fn boxes(&self, lo: impl Fn(usize) -> f32x8, hi: impl Fn(usize) -> f32x8) -> Boxes {
        let (a, b) = (self.point(lo), self.point(hi));
        match self.backward {
            true => [Vec3 { z: b.z, ..a }, Vec3 { z: a.z, ..b }],
            false => [a, b],
        }
    }
}
