//! A ray under way.

use wide::{f32x8, u32x8};

use super::super::answers::Answers;
use super::seeds::Seeds;
use super::view::{Aim, TestRay, View, Views};
use crate::accel::Accel;
use crate::accel::leaf::Testable;
use crate::accel::node::{ChildRef, Node8};
use crate::accel::order::far_first;
use crate::accel::query::Query;
use crate::accel::unchecked::{self, Stacks};
use crate::intersect::aabb::CullRay;
use crate::intersect::{LaneHit, RayLanes, Tier};
use crate::math::{Lane, Mask, Vec3, Wide, eight, three};

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
        seeds.views.put(i, &mut self.aim, &mut self.test);
        self.t_min = Lane::get(&seeds.t_min, i);
        self.limit = Lane::get(&seeds.limit, i);
        self.next = ChildRef::node(root);
        self.top = bottom as u32 + 1;
        self.row = seeds.row(i);
        self.query = seeds.query(i);
    }

    /// The ray in the space that it is in, as a row of [`RayLanes::of_rows`].
    #[inline(always)]
    pub(super) fn row_of_ray(&self) -> T::Wide {
        T::Wide::of_lanes(self.test.ray)
    }

    #[inline(always)]
    fn ray(&self) -> RayLanes<T::Real> {
        RayLanes::of_columns(self.test.ray)
    }

    /// Takes the ray to the child that stands, or would, at place `top` of the stacks.
    #[inline(always)]
    pub(super) fn go_on(&mut self, next: ChildRef, top: usize, accel: &Accel) {
        (self.next, self.top) = (next, top as u32);
        unchecked::prefetch(accel, next);
    }

    /// Goes through a node: on to the nearest child that the ray meets, the others on its stack, or back to what stands there.
    #[inline(always)]
    pub(super) fn step(&mut self, node: &Node8, accel: &Accel, stacks: &mut Stacks) {
        let (enter, meets) = self.children(node);
        let (order, count) = (far_first(self.octant(), meets), meets.count_ones());
        let top = self.top as usize;
        // Not read back from the stack, which would wait for what is written there.
        let (nearest, below) = (node.child[order.last(count)], stacks.child(top - 1));
        let next = if count == 0 { below } else { nearest };
        let child = u32x8::new(eight(|i| node.child[i].bits())).shuffle_wrapping(order.lanes());
        stacks.write(top, child, enter.shuffle_wrapping(order.lanes()));
        self.go_on(next, top + count as usize - 1, accel);
    }

    /// Puts a hit in the leaf that is next to the query; true if it is accepted.
    #[inline(always)]
    pub(super) fn accept(&mut self, hit: &LaneHit<T::Real>, id: u32) -> bool {
        self.query.accept(&self.ray(), hit, id)
    }

    /// Goes from the world into the space of an instance, where it is ray `i` of eight.
    #[inline(always)]
    pub(super) fn enter(&mut self, views: &Views<T>, i: usize, instance: u32) {
        self.home = View { aim: self.aim, test: self.test };
        views.put(i, &mut self.aim, &mut self.test);
        self.query.enter_instance(instance + 1);
    }

    /// Goes back to the world.
    pub(super) fn leave(&mut self) {
        (self.aim, self.test) = (self.home.aim, self.home.test);
        self.query.enter_instance(0);
    }

    /// Where the ray enters the children of a node, and which of them it meets.
    #[inline(always)]
    pub(super) fn children(&self, node: &Node8) -> (f32x8, u32) {
        let backward = self.aim.side.backward();
        let [x, y, z] = three(|k| unchecked::planes(node, k, backward[k]));
        let [near, far] = [0, 1].map(|i| Vec3 { x: x[i], y: y[i], z: z[i] });
        let (t_min, t_max) = (f32x8::splat(self.t_min), f32x8::splat(self.limit));
        let (enter, leave) = CullRay::<f32x8>::splat(&self.aim.cull).interval(near, far, t_min, t_max);
        (enter, Lane::le(enter, leave).bits())
    }

    /// Octant of the direction.
    #[inline(always)]
    pub(super) fn octant(&self) -> u32 {
        self.aim.side.octant()
    }

    /// Primitives of the leaf that is next that the ray may hit, as bits. **Needs:** a leaf of that kind.
    #[inline(always)]
    pub(super) fn candidates<B: Testable>(&self, accel: &Accel) -> u32 {
        B::of(accel, self.next).candidates::<T>(&self.ray(), &self.test.triangle)
    }

    /// Tests primitive `i` of that leaf, which the ray may hit; true if a hit is accepted.
    #[inline(always)]
    pub(super) fn test<B: Testable>(&mut self, accel: &Accel, i: usize) -> bool {
        let block = B::of(accel, self.next);
        let hit = block.hit_one::<T>(i, &self.ray(), self.query.limit());
        self.accept(&hit, block.ids()[i])
    }
}
