//! A ray under way.

use wide::f32x8;

use super::super::Answers;
use super::seeds::Seeds;
use crate::accel::Accel;
use crate::accel::block::PrimitivesByRay;
use crate::accel::instance::TreeRoot;
use crate::accel::leaf::{BlockVisitor, TestRays, Testable, with_block};
use crate::accel::node::{ChildRef, Node8};
use crate::accel::query::Query;
use crate::accel::unchecked;
use crate::intersect::aabb::CullRay;
use crate::intersect::{LaneHit, PrimKind, RayLanes, Tier, TriangleTest};
use crate::math::{Lane, Mask, Real, Vec3, three};

/// A ray under way; what the node pass needs stands first, in one cache line.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct Slot<T: Tier, Q> {
    cull: CullRay<f32>,
    t_min: f32,
    /// Boxes that the ray enters beyond need no visit.
    pub(super) limit: f32,
    /// The planes that the ray meets first and last, see [`Node8::PLANES`].
    planes: [u8; 6],
    pub(super) octant: u8,
    pub(super) next: ChildRef,
    /// Where on the stacks the last entry of its own stands, or the one at the bottom.
    pub(super) top: u32,
    pub(super) row: u32,
    /// Found something in the leaf that is next.
    pub(super) accepted: bool,
    pub(super) ray: RayLanes<T::Real>,
    triangle: <T::Triangle as TriangleTest>::OneRay<T::Real>,
    pub(super) query: Q,
}

impl<T: Tier, Q: Query<T::Real> + Copy> Slot<T, Q> {
    /// A slot that holds a ray, but has not started it.
    pub(super) fn of<A: Answers<T, One = Q>>(seeds: &Seeds<T, A>, i: usize) -> Self {
        let ray = seeds.rays.get(i);
        Self {
            cull: seeds.cull.get(i),
            t_min: 0.0,
            limit: f32::NEG_INFINITY,
            planes: Node8::PLANES[0],
            octant: 0,
            next: ChildRef::EMPTY,
            top: 0,
            row: 0,
            accepted: false,
            triangle: T::Triangle::one_of(&ray, &seeds.triangle, i),
            ray,
            query: seeds.query(i),
        }
    }

    /// Starts a ray at the root, with its stack at `bottom`.
    #[inline(always)]
    pub(super) fn start<A: Answers<T, One = Q>>(
        &mut self,
        seeds: &Seeds<T, A>,
        i: usize,
        root: u32,
        bottom: usize,
    ) {
        self.cull = seeds.cull.get(i);
        self.look_along(seeds.octant(i));
        self.t_min = Lane::get(&seeds.t_min, i);
        self.limit = Lane::get(&seeds.limit, i);
        self.next = ChildRef::node(root);
        self.top = bottom as u32 + 1;
        self.row = seeds.row(i);
        self.ray = seeds.rays.get(i);
        self.triangle = T::Triangle::one_of(&self.ray, &seeds.triangle, i);
        self.query = seeds.query(i);
    }

    #[inline(always)]
    fn look_along(&mut self, octant: u32) {
        self.octant = octant as u8;
        self.planes = Node8::PLANES[octant as usize & 7];
    }

    /// Turns to another space.
    pub(super) fn aim(&mut self, ray: RayLanes<T::Real>, tree: TreeRoot) {
        self.cull = cull_ray::<T>(&ray, tree);
        let backward = self.cull.backward();
        self.look_along(three(|k| u32::from(backward[k]) << k).into_iter().sum());
        self.triangle = T::Triangle::prepare_one(&ray);
        self.ray = ray;
    }

    /// Where the ray enters the children of a node, and which of them it meets.
    #[inline(always)]
    pub(super) fn children(&self, node: &Node8) -> (f32x8, u32) {
        let plane = |i: usize| unchecked::planes(node, self.planes[i]);
        let near = Vec3 { x: plane(0), y: plane(1), z: plane(2) };
        let far = Vec3 { x: plane(3), y: plane(4), z: plane(5) };
        let (t_min, t_max) = (f32x8::splat(self.t_min), f32x8::splat(self.limit));
        let (enter, leave) = CullRay::<f32x8>::splat(&self.cull).interval(near, far, t_min, t_max);
        (enter, Lane::le(enter, leave).bits())
    }

    /// Triangles of the leaf that is next that the ray may hit, as bits; none for a leaf of anything else.
    #[inline(always)]
    pub(super) fn candidates(&self, accel: &Accel) -> u32 {
        if !self.is_at_triangles() {
            return 0;
        }
        let corners = unchecked::triangles(accel, self.next).corner_columns();
        T::Triangle::candidates::<T::Wide>(&self.ray, &self.triangle, corners)
    }

    #[inline(always)]
    pub(super) fn is_at_triangles(&self) -> bool {
        self.next.kind() == PrimKind::Triangle as u8
    }

    /// Tests all of a leaf of anything but triangles.
    pub(super) fn test_block(&mut self, accel: &Accel) {
        let next = self.next;
        self.accepted = with_block(accel, next, self);
    }
}

fn cull_ray<T: Tier>(ray: &RayLanes<T::Real>, tree: TreeRoot) -> CullRay<f32> {
    let narrow = |x: T::Real| x.to_f32();
    let narrow3 = |v: Vec3<T::Real>| Vec3::new(narrow(v.x), narrow(v.y), narrow(v.z));
    let origin = narrow3(ray.origin);
    CullRay::new(origin, narrow3(ray.direction), tree.scale_for(origin))
}

/// Leaves of anything but triangles: eight at once.
impl<T: Tier, Q: Query<T::Real>> BlockVisitor for Slot<T, Q> {
    #[inline(never)]
    fn visit<B: Testable>(&mut self, block: &B) -> bool {
        let ray = RayLanes::splat(&self.ray);
        let rays = TestRays { triangle: &T::Triangle::prepare(&ray), ray: &ray };
        let limit = T::Wide::splat(self.query.limit());
        let lanes = block.may_hit::<T, PrimitivesByRay>(0, &rays);
        if !lanes.any() {
            return false;
        }
        let hit: LaneHit<T::Wide> = block.hit::<T, PrimitivesByRay>(0, lanes, &rays, limit);
        let (mut left, mut accepted) = (hit.mask.bits(), false);
        while left != 0 {
            let i = left.trailing_zeros() as usize;
            left &= left - 1;
            let one = LaneHit { mask: true, t: hit.t.get(i), u: hit.u.get(i), v: hit.v.get(i) };
            accepted |= self.query.accept(&self.ray, &one, block.ids()[i]);
        }
        accepted
    }
}
