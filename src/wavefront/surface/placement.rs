//! Surfaces through instances: from the space of what is shown to the world.

use super::{Double, SurfaceLanes, roundoffs};
use crate::geometry::Geometry;
use crate::math::{Lane, Real, Transform, Vec3, WIDTH, gamma_of};

/// Rows of eight affine maps.
pub(super) struct Maps<D>([[D; 4]; 3]);

impl<D: Double> Maps<D> {
    fn gather(maps: &[Transform; WIDTH], rows: impl Fn(&Transform) -> [[f64; 4]; 3]) -> Self {
        let all = maps.each_ref().map(rows);
        Self(std::array::from_fn(|r| std::array::from_fn(|c| D::from_fn(|i| all[i][r][c]))))
    }

    pub(super) fn direction(&self, d: Vec3<D>) -> Vec3<D> {
        let row = |r: &[D; 4]| r[0] * d.x + r[1] * d.y + r[2] * d.z;
        Vec3 { x: row(&self.0[0]), y: row(&self.0[1]), z: row(&self.0[2]) }
    }

    pub(super) fn point(&self, p: Vec3<D>) -> Vec3<D> {
        let [x, y, z] = self.0.each_ref().map(|r| r[3]);
        self.direction(p) + Vec3 { x, y, z }
    }

    /// The largest sum of magnitudes that makes a coordinate of the image of `p`: what its rounding is relative to.
    fn sizes(&self, p: Vec3<D>) -> D {
        let row = |r: &[D; 4]| (r[0] * p.x).abs() + (r[1] * p.y).abs() + (r[2] * p.z).abs() + r[3].abs();
        let [x, y, z] = self.0.each_ref().map(row);
        x.max(y).max(z)
    }

    /// The transposed linear part applied to `n`.
    fn transposed(&self, n: Vec3<D>) -> Vec3<D> {
        let m = &self.0;
        let column = |c: usize| m[0][c] * n.x + m[1][c] * n.y + m[2][c] * n.z;
        Vec3 { x: column(0), y: column(1), z: column(2) }
    }

    /// How far the longest error a coordinate may have is stretched.
    fn stretch(&self) -> D {
        let [x, y, z] = self.0.each_ref().map(|r| r[0].abs() + r[1].abs() + r[2].abs());
        x.max(y).max(z)
    }
}

/// The transforms of eight instances; the identity where a lane has none.
pub(super) struct Placement<D> {
    to_world: Maps<D>,
    pub(super) to_local: Maps<D>,
}

impl<D: Double> Placement<D> {
    pub(super) fn gather(geometry: &Geometry, instance: &[u32; WIDTH]) -> Self {
        let placed = instance.map(|n| match n {
            0 => Transform::IDENTITY,
            n => geometry.instances[n as usize - 1].to_world,
        });
        Self {
            to_world: Maps::gather(&placed, Transform::rows),
            to_local: Maps::gather(&placed, Transform::inverse_rows),
        }
    }

    /// Points by the transform, normals by its transposed inverse.
    ///
    /// The bound grows by the stretch, and so does what is lost between the spaces: on the way out and on the next ray's way
    /// back in to sums of products that may cancel, and where that ray becomes numbers `L`. Its origin loses 1 roundoff of
    /// `size` by that, the largest coordinate of the primitive, and its direction 2 over the primitive's length; 1 is slack.
    pub(super) fn to_world<L: Lane<Double = D>>(&self, s: &SurfaceLanes<D>, size: D) -> SurfaceLanes<D> {
        let point = self.to_world.point(s.point);
        let sums = (self.to_local.sizes(point) + size) * roundoffs(8);
        let narrowed = size * D::constant(gamma_of(4, <L::Scalar as Real>::ROUNDOFF));
        SurfaceLanes {
            point,
            error: (s.error + sums + narrowed) * self.to_world.stretch(),
            geometric_normal: self.to_local.transposed(s.geometric_normal).normalize(),
            shading_normal: self.to_local.transposed(s.shading_normal).normalize(),
            uv: s.uv,
        }
    }
}
