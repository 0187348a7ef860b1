//! A ray under way.

use wide::f32x8;

use super::super::Answers;
use super::seeds::Seeds;
use super::view::{Aim, TestRay, View};
use crate::accel::Accel;
use crate::accel::block::PrimitivesByRay;
use crate::accel::leaf::{BlockVisitor, TestRays, Testable, with_block};
use crate::accel::node::{ChildRef, Node8};
use crate::accel::query::Query;
use crate::accel::unchecked;
use crate::intersect::aabb::CullRay;
use crate::intersect::{LaneHit, PrimKind, RayLanes, Tier, TriangleTest};
use crate::math::{Lane, Mask, Vec3};

/// A ray under way; what the node pass needs stands first, in one cache line.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct Slot<T: Tier, Q> {
    aim: Aim,
    t_min: f32,
    /// Boxes that the ray enters beyond need no visit.
    pub(super) limit: f32,
    pub(super) next: ChildRef,
    /// Where on the stacks the last entry of its own stands, or the one at the bottom.
    pub(super) top: u32,
    pub(super) row: u32,
    /// Found something in the leaf that is next.
    pub(super) accepted: bool,
    test: TestRay<T>,
    pub(super) query: Q,
    /// The ray in the world, while it is in the space of an instance.
    home: View<T>,
}

impl<T: Tier, Q: Query<T::Real> + Copy> Slot<T, Q> {
    /// A slot that holds a ray, but has not started it.
    pub(super) fn of<A: Answers<T, One = Q>>(seeds: &Seeds<T, A>, i: usize) -> Self {
        let home = seeds.views.get(i);
        Self {
            aim: home.aim,
            t_min: 0.0,
            limit: f32::NEG_INFINITY,
            next: ChildRef::EMPTY,
            top: 0,
            row: 0,
            accepted: false,
            test: home.test,
            query: seeds.query(i),
            home,
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
        self.turn(&seeds.views.get(i));
        self.t_min = Lane::get(&seeds.t_min, i);
        self.limit = Lane::get(&seeds.limit, i);
        self.next = ChildRef::node(root);
        self.top = bottom as u32 + 1;
        self.row = seeds.row(i);
        self.query = seeds.query(i);
    }

    /// The ray in the space that it is in.
    #[inline(always)]
    pub(super) fn ray(&self) -> &RayLanes<T::Real> {
        &self.test.ray
    }

    /// Puts a hit in the leaf that is next to the query.
    #[inline(always)]
    pub(super) fn accept(&mut self, hit: &LaneHit<T::Real>, id: u32) {
        self.accepted |= self.query.accept(&self.test.ray, hit, id);
    }

    #[inline(always)]
    fn turn(&mut self, view: &View<T>) {
        self.aim = view.aim;
        self.test = view.test;
    }

    /// Goes from the world into the space of an instance.
    #[inline(always)]
    pub(super) fn enter(&mut self, view: &View<T>, instance: u32) {
        self.home = View { aim: self.aim, test: self.test };
        self.turn(view);
        self.query.enter_instance(instance + 1);
    }

    /// Goes back to the world.
    pub(super) fn leave(&mut self) {
        let home = self.home;
        self.turn(&home);
        self.query.enter_instance(0);
    }

    /// Where the ray enters the children of a node, and which of them it meets.
    #[inline(always)]
    pub(super) fn children(&self, node: &Node8) -> (f32x8, u32) {
        let plane = |i: usize| unchecked::planes(node, self.aim.planes[i]);
        let near = Vec3 { x: plane(0), y: plane(1), z: plane(2) };
        let far = Vec3 { x: plane(3), y: plane(4), z: plane(5) };
        let (t_min, t_max) = (f32x8::splat(self.t_min), f32x8::splat(self.limit));
        let (enter, leave) = CullRay::<f32x8>::splat(&self.aim.cull).interval(near, far, t_min, t_max);
        (enter, Lane::le(enter, leave).bits())
    }

    /// Octant of the direction.
    #[inline(always)]
    pub(super) fn octant(&self) -> u32 {
        self.aim.octant.into()
    }

    /// Triangles of the leaf that is next that the ray may hit, as bits; none for a leaf of anything else.
    #[inline(always)]
    pub(super) fn candidates(&self, accel: &Accel) -> u32 {
        if !self.is_at_triangles() {
            return 0;
        }
        let corners = unchecked::triangles(accel, self.next).corner_columns();
        T::Triangle::candidates::<T::Wide>(&self.test.ray, &self.test.triangle, corners)
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

/// Leaves of anything but triangles: eight at once.
impl<T: Tier, Q: Query<T::Real>> BlockVisitor for Slot<T, Q> {
    #[inline(never)]
    fn visit<B: Testable>(&mut self, block: &B) -> bool {
        let ray = RayLanes::splat(&self.test.ray);
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
            accepted |= self.query.accept(&self.test.ray, &one, block.ids()[i]);
        }
        accepted
    }
}
