//! Testing the primitives of a leaf, for every walk, query and tier.

use super::Accel;
use super::block::{Block, Walk};
use super::node::ChildRef;
use super::query::Query;
use crate::intersect::aabb::CullRay;
use crate::intersect::{Curved, LaneHit, PrimKind, RayLanes, Tier, TriangleTest};
use crate::math::{Lane, Real, Vec3};

/// Rays with all that the tests of a tier prepare once a ray.
#[derive(Clone, Copy)]
pub struct PreparedRays<T: Tier> {
    pub ray: RayLanes<T::Wide>,
    pub cull: CullRay<wide::f32x8>,
    pub triangle: <T::Triangle as TriangleTest>::Prepared<T::Wide>,
}

impl<T: Tier> PreparedRays<T> {
    /// Prepares rays for a tree whose coordinates are at most `scale`.
    #[inline(always)]
    pub fn new(ray: RayLanes<T::Wide>, scale: f32) -> Self {
        let cull = CullRay::new(to_f32(ray.origin), to_f32(ray.direction), wide::f32x8::splat(scale));
        Self { cull, triangle: T::Triangle::prepare(&ray), ray }
    }
}

/// Rounded to `f32` lanes.
#[inline(always)]
pub fn to_f32<L: Lane>(v: Vec3<L>) -> Vec3<wide::f32x8> {
    let one = |x: L| wide::f32x8::new(std::array::from_fn(|i| x.get(i).to_f32()));
    Vec3 { x: one(v.x), y: one(v.y), z: one(v.z) }
}

/// A limit of `t` as `f32` lanes, not rounded down: boxes are culled against it.
#[inline(always)]
pub fn limit_f32<L: Lane>(t: L) -> wide::f32x8 {
    if size_of::<L::Scalar>() == size_of::<f32>() {
        wide::f32x8::new(std::array::from_fn(|i| t.get(i).to_f32()))
    } else {
        wide::f32x8::new(std::array::from_fn(|i| t.get(i).to_f32().next_up()))
    }
}

/// The least `t` as `f32` lanes, not rounded up.
#[inline(always)]
pub fn t_min_f32<L: Lane>(t: L) -> wide::f32x8 {
    if size_of::<L::Scalar>() == size_of::<f32>() {
        wide::f32x8::new(std::array::from_fn(|i| t.get(i).to_f32()))
    } else {
        wide::f32x8::new(std::array::from_fn(|i| t.get(i).to_f32().next_down()))
    }
}

/// Puts the primitives of a leaf to the query; true if any was accepted.
#[inline(always)]
pub fn visit_leaf<T: Tier, W: Walk, Q: Query<T::Wide>>(
    accel: &Accel,
    leaf: ChildRef,
    rays: &PreparedRays<T>,
    query: &mut Q,
) -> bool {
    const TRIANGLE: u8 = PrimKind::Triangle as u8;
    const SPHERE: u8 = PrimKind::Sphere as u8;
    let ray = &rays.ray;
    match leaf.kind() {
        TRIANGLE => {
            let block = &accel.triangles[leaf.index() as usize];
            visit_block::<T, W, Q, _>(block, ray, query, |step, limit| {
                T::Triangle::test(ray, &rays.triangle, block.corners::<W, _>(step), limit)
            })
        }
        SPHERE => {
            let block = &accel.spheres[leaf.index() as usize];
            visit_block::<T, W, Q, _>(block, ray, query, |step, _| {
                T::Curved::sphere(ray, &block.spheres::<W, _>(step))
            })
        }
        _ => {
            let block = &accel.cylinders[leaf.index() as usize];
            visit_block::<T, W, Q, _>(block, ray, query, |step, _| {
                T::Curved::cylinder(ray, &block.cylinders::<W, _>(step))
            })
        }
    }
}

#[inline(always)]
fn visit_block<T: Tier, W: Walk, Q: Query<T::Wide>, B: Block>(
    block: &B,
    ray: &RayLanes<T::Wide>,
    query: &mut Q,
    test: impl Fn(usize, T::Wide) -> LaneHit<T::Wide>,
) -> bool {
    let mut accepted = false;
    for step in 0..W::steps(block.len()) {
        let hit = test(step, query.limit());
        accepted |= query.accept(ray, &hit, W::ids(block.ids(), step));
    }
    accepted
}
