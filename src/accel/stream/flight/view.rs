//! Rays as a space sees them: prepared eight at a time, taken one by one.

use wide::f32x8;

use crate::accel::node::Node8;
use crate::intersect::aabb::{CullRay, OneCullRay};
use crate::intersect::{RayLanes, Tier, TriangleTest};
use crate::math::{Mask, WIDTH, Wide, eight};

/// What the boxes of a tree need to know of a ray.
#[derive(Clone, Copy)]
pub(super) struct Aim {
    pub(super) cull: OneCullRay,
    pub(super) side: Side,
}

/// Which way a ray goes, in one word: by axis a byte that is 0 where it goes along it, else [`Node8::ACROSS`]; last the octant.
#[derive(Clone, Copy)]
pub(super) struct Side(u32);

impl Side {
    #[inline(always)]
    fn new([x, y, z]: [u32; 3]) -> Self {
        let (backward, octant) = (x | y << 8 | z << 16, x | y << 1 | z << 2);
        Self((backward * u32::from(Node8::ACROSS)) | (octant << 24))
    }
    #[inline(always)]
    pub(super) fn backward(self) -> [u8; 3] {
        [self.0 as u8, (self.0 >> 8) as u8, (self.0 >> 16) as u8]
    }
    #[inline(always)]
    pub(super) fn octant(self) -> u32 {
        self.0 >> 24
    }
}

/// What the primitives of a tree need to know of a ray.
#[derive(Clone, Copy)]
pub(super) struct TestRay<T: Tier> {
    /// As a row of [`RayLanes::of_rows`].
    pub(super) ray: [T::Real; WIDTH],
    pub(super) triangle: <T::Triangle as TriangleTest>::OneRay<T::Real>,
}

/// A ray in one space.
#[derive(Clone, Copy)]
pub(super) struct View<T: Tier> {
    pub(super) aim: Aim,
    pub(super) test: TestRay<T>,
}

/// Eight rays, each in a space of its own or all in one.
pub(super) struct Views<T: Tier> {
    rays: [[T::Real; WIDTH]; WIDTH],
    triangle: [<T::Triangle as TriangleTest>::OneRay<T::Real>; WIDTH],
    cull: [OneCullRay; WIDTH],
    /// By axis, lanes that go against it.
    backward: [u32; 3],
}

impl<T: Tier> Views<T> {
    /// Rays, and the same for boxes.
    #[inline(always)]
    pub(super) fn new(rays: RayLanes<T::Wide>, cull: CullRay<f32x8>) -> Self {
        let rows = rays.to_rows();
        Self {
            triangle: T::Triangle::each_of(&rays, &T::Triangle::prepare(&rays)),
            rays: eight(|i| rows[i].to_lanes()),
            cull: cull.each(),
            backward: cull.backward().map(Mask::bits),
        }
    }

    /// Ray `i`.
    #[inline(always)]
    pub(super) fn get(&self, i: usize) -> View<T> {
        let side = Side::new(self.backward.map(|lanes| lanes >> i & 1));
        View {
            aim: Aim { cull: self.cull[i], side },
            test: TestRay { ray: self.rays[i], triangle: self.triangle[i] },
        }
    }

    /// [`Views::get`] to where it is kept, piece by piece: put together first and copied in wider pieces, it would wait for
    /// the stores to be done.
    #[inline(always)]
    pub(super) fn put(&self, i: usize, aim: &mut Aim, test: &mut TestRay<T>) {
        aim.cull = self.cull[i];
        aim.side = Side::new(self.backward.map(|lanes| lanes >> i & 1));
        test.ray = self.rays[i];
        test.triangle = self.triangle[i];
    }
}
