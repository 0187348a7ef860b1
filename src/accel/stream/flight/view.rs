//! Rays as a space sees them: prepared eight at a time, taken one by one.

use wide::f32x8;

use crate::accel::leaf::ForTriangles;
use crate::accel::node::Node8;
use crate::intersect::aabb::CullRay;
use crate::intersect::{RayLanes, Tier, TriangleTest};
use crate::math::Mask;

/// What the boxes of a tree need to know of a ray.
#[derive(Clone, Copy)]
#[repr(C)]
pub(super) struct Aim {
    pub(super) cull: CullRay<f32>,
    /// The planes that the ray meets first and last, see [`Node8::PLANES`].
    pub(super) planes: [u8; 6],
    pub(super) octant: u8,
}

/// What the primitives of a tree need to know of a ray.
#[derive(Clone, Copy)]
pub(super) struct TestRay<T: Tier> {
    pub(super) ray: RayLanes<T::Real>,
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
    rays: RayLanes<T::Wide>,
    triangle: ForTriangles<T>,
    cull: CullRay<f32x8>,
    /// By axis, lanes that go against it.
    backward: [u32; 3],
}

impl<T: Tier> Views<T> {
    /// Rays, and the same for boxes.
    #[inline(always)]
    pub(super) fn new(rays: RayLanes<T::Wide>, cull: CullRay<f32x8>) -> Self {
        Self { triangle: T::Triangle::prepare(&rays), rays, backward: cull.backward().map(Mask::bits), cull }
    }

    /// Ray `i`.
    #[inline(always)]
    pub(super) fn get(&self, i: usize) -> View<T> {
        let [x, y, z] = self.backward.map(|lanes| lanes >> i & 1);
        let octant = x | y << 1 | z << 2;
        let ray = self.rays.get(i);
        let triangle = T::Triangle::one_of(&ray, &self.triangle, i);
        let planes = Node8::PLANES[octant as usize];
        View {
            aim: Aim { cull: self.cull.get(i), planes, octant: octant as u8 },
            test: TestRay { ray, triangle },
        }
    }
}
