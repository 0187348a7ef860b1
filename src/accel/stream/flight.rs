//! Rays that go anywhere: one by one, but many at a time.
//!
//! Plainly: a ray pops the nearest child off its stack and tests eight boxes or eight primitives, until its stack is empty.
//! Alone it waits for memory and for branches that nobody can predict. So many rays are under way, and the loops go over
//! them by kind of work instead of along one ray:
//! - the *node pass* moves each ray whose next child is a node one step, without a branch;
//! - the *leaf pass* tests the leaves that have gathered;
//! - the *refill* hands out answers and starts waiting rays.
//!
//! Each ray visits what it would visit alone, in the same order. On its way into an instance it leaves a note on its stack
//! that brings it back out.

use wide::{f32x8, u32x8};

use super::Answers;
use super::columns::RayColumns;
use crate::accel::Accel;
use crate::accel::block::{Block, PrimitivesByRay};
use crate::accel::instance::TreeRoot;
use crate::accel::leaf::{BlockVisitor, TestRays, Testable, with_block};
use crate::accel::node::{ChildRef, Node8};
use crate::accel::order::far_first;
use crate::accel::query::Query;
use crate::accel::traversal::ask_planes;
use crate::accel::unchecked::{self, Slots, Stacks};
use crate::intersect::aabb::CullRay;
use crate::intersect::{LaneHit, PrimKind, RayLanes, Tier, TriangleTest};
use crate::math::{Lane, Mask, Real, Vec3, WIDTH, three};

/// Rays under way.
const SLOTS: usize = 48;
/// Room in the lists: one more than slots, as a list is written before it is known whether the slot belongs there.
const LIST: usize = SLOTS + 1;
/// Leaves that gather before they are tested.
const LEAVES: usize = 24;
/// Rays in nodes below which leaves are tested however few.
const FEW: usize = 12;
/// Rays that are done before others start in their place.
const DONE: usize = 8;

/// What lies on the stack below what a ray visits in the space of an instance.
const LEAVE: ChildRef = ChildRef::leaf(ChildRef::LAST_KIND, 0);

/// A ray under way; what the node pass needs stands first, in one cache line.
#[repr(C, align(64))]
struct Slot<T: Tier, Q> {
    cull: CullRay<f32>,
    t_min: f32,
    /// Boxes that the ray enters beyond need no visit.
    limit: f32,
    octant: u32,
    next: ChildRef,
    /// Entries on the stack, with the one at the bottom that says it is empty.
    top: u32,
    row: u32,
    /// Lanes of the leaf that is next.
    candidates: u32,
    ray: RayLanes<T::Real>,
    triangle: <T::Triangle as TriangleTest>::OneRay<T::Real>,
    query: Q,
}

/// Scratch for rays under way.
pub(super) struct Flight<T: Tier, Q> {
    slots: Vec<Slot<T, Q>>,
    in_nodes: Slots<LIST>,
    in_leaves: Slots<LIST>,
    candidates: Slots<LIST>,
    done: Slots<LIST>,
    stacks: Stacks,
}

impl<T: Tier, Q: Query<T::Real> + Copy> Flight<T, Q> {
    pub(super) fn new(accel: &Accel) -> Self {
        Self {
            slots: Vec::new(),
            in_nodes: Slots::new(),
            in_leaves: Slots::new(),
            candidates: Slots::new(),
            done: Slots::new(),
            stacks: Stacks::new(accel.stack_bound),
        }
    }

    /// Answers the rays of the rows.
    pub(super) fn trace<A: Answers<T, One = Q>>(
        &mut self,
        accel: &Accel,
        rays: &RayColumns<T::Real>,
        rows: &[u32],
        answers: &mut A,
    ) {
        let mut waiting = rows.iter();
        self.stacks.make(SLOTS);
        self.slots.clear();
        for &row in waiting.by_ref().take(SLOTS) {
            let slot = Slot::new(accel, rays, row, A::ask_one);
            self.in_nodes.push_if(true, self.slots.len());
            self.slots.push(slot);
        }
        loop {
            self.node_pass(accel);
            if self.in_leaves.len() >= LEAVES || self.in_nodes.len() < FEW {
                self.leaf_pass(accel, rays);
            }
            if self.done.len() >= DONE || self.in_nodes.len() == 0 {
                self.refill(accel, rays, &mut waiting, answers);
                if self.in_nodes.len() + self.in_leaves.len() == 0 {
                    return;
                }
            }
        }
    }

    /// Moves each ray that is in a node one step.
    #[inline(always)]
    fn node_pass(&mut self, accel: &Accel) {
        let count = self.in_nodes.len();
        self.in_nodes.clear();
        for i in 0..count {
            let at = self.in_nodes.get(i);
            let slot = &mut self.slots[at];
            let node = unchecked::node(accel, slot.next);
            let (enter, meets) = slot.children(node);
            let order = far_first(slot.octant, meets);
            let child = u32x8::new(node.child.map(ChildRef::bits)).shuffle_wrapping(order);
            let near = enter.shuffle_wrapping(order);
            let top = slot.top as usize;
            self.stacks.write(at, top, child, near);
            let top = top + meets.count_ones() as usize - 1;
            self.go_on(at, top, accel);
        }
    }

    /// Takes a ray to the child at place `top` of its stack.
    #[inline(always)]
    fn go_on(&mut self, at: usize, top: usize, accel: &Accel) {
        let slot = &mut self.slots[at];
        let next = self.stacks.child(at, top);
        slot.top = top as u32;
        slot.next = next;
        unchecked::prefetch(accel, next);
        self.in_nodes.push_if(next.is_node(), at);
        self.in_leaves.push_if(!next.is_node() && next != Stacks::END, at);
        self.done.push_if(next == Stacks::END, at);
    }

    /// Tests the leaves that have gathered: first all for lanes that may be hit, then those lanes.
    #[inline(always)]
    fn leaf_pass(&mut self, accel: &Accel, rays: &RayColumns<T::Real>) {
        self.candidates.clear();
        for i in 0..self.in_leaves.len() {
            let at = self.in_leaves.get(i);
            let slot = &mut self.slots[at];
            slot.candidates = slot.find_candidates(accel);
            self.candidates.push_if(slot.candidates != 0, at);
        }
        for i in 0..self.candidates.len() {
            let at = self.candidates.get(i);
            let slot = &mut self.slots[at];
            // Where the slabs of huge scenes overflow, a ray may seem to meet even the box of a free slot.
            if slot.next.kind() >= Accel::INSTANCE {
                self.change_space(accel, rays, at);
            } else if slot.test_candidates(accel) {
                slot.limit = T::above_f32(T::Wide::splat(slot.query.limit())).get(0);
                let top = slot.top as usize;
                let kept =
                    if slot.query.is_done() { 1 } else { self.stacks.keep_within(at, top, slot.limit) };
                slot.top = kept as u32;
            }
        }
        let count = self.in_leaves.len();
        self.in_leaves.clear();
        for i in 0..count {
            let at = self.in_leaves.get(i);
            let top = self.slots[at].top as usize;
            self.go_on(at, top - 1, accel);
        }
    }

    /// Takes a ray into the space of an instance, or back.
    #[inline(never)]
    fn change_space(&mut self, accel: &Accel, rays: &RayColumns<T::Real>, at: usize) {
        let slot = &mut self.slots[at];
        if slot.next == LEAVE {
            slot.aim(rays.get(slot.row as usize), accel.world);
            slot.query.enter_instance(0);
        } else if slot.next.kind() == Accel::INSTANCE {
            let placed = accel.placed(slot.next);
            slot.aim(Accel::local_rays(&placed.to_world, &slot.ray), placed.tree);
            slot.query.enter_instance(placed.row + 1);
            let mut below = [LEAVE.bits(); WIDTH];
            below[1] = ChildRef::node(placed.tree.node).bits();
            let anywhere = f32x8::splat(f32::NEG_INFINITY);
            self.stacks.write(at, slot.top as usize, u32x8::new(below), anywhere);
            slot.top += 2;
        }
    }

    /// Hands out the answers of the rays that are done and starts waiting ones.
    fn refill<'r, A: Answers<T, One = Q>>(
        &mut self,
        accel: &Accel,
        rays: &RayColumns<T::Real>,
        waiting: &mut impl Iterator<Item = &'r u32>,
        answers: &mut A,
    ) {
        for i in 0..self.done.len() {
            let at = self.done.get(i);
            let slot = &mut self.slots[at];
            answers.store_one(slot.row as usize, &slot.query);
            if let Some(&row) = waiting.next() {
                *slot = Slot::new(accel, rays, row, A::ask_one);
                self.in_nodes.push_if(true, at);
            }
        }
        self.done.clear();
    }
}

impl<T: Tier, Q: Query<T::Real>> Slot<T, Q> {
    fn new(
        accel: &Accel,
        rays: &RayColumns<T::Real>,
        row: u32,
        ask: impl Fn(&RayLanes<T::Real>) -> Q,
    ) -> Self {
        let ray = rays.get(row as usize);
        let mut query = ask(&ray);
        ask_planes(accel, &ray, &mut query);
        let cull = cull_ray::<T>(&ray, accel.world);
        Self {
            octant: octant(&cull),
            cull,
            t_min: T::below_f32(T::Wide::splat(ray.t_min)).get(0),
            limit: T::above_f32(T::Wide::splat(query.limit())).get(0),
            next: ChildRef::node(accel.world.node),
            top: 1,
            row,
            candidates: 0,
            triangle: T::Triangle::prepare_one(&ray),
            ray,
            query,
        }
    }

    /// Turns to another space.
    fn aim(&mut self, ray: RayLanes<T::Real>, tree: TreeRoot) {
        self.cull = cull_ray::<T>(&ray, tree);
        self.octant = octant(&self.cull);
        self.triangle = T::Triangle::prepare_one(&ray);
        self.ray = ray;
    }

    /// Where the ray enters the children of a node, and which of them it meets.
    #[inline(always)]
    fn children(&self, node: &Node8) -> (f32x8, u32) {
        let planes = |k: usize, far: bool| {
            f32x8::new(if (self.octant >> k & 1 != 0) != far { node.hi[k] } else { node.lo[k] })
        };
        let corner = |far: bool| Vec3 { x: planes(0, far), y: planes(1, far), z: planes(2, far) };
        let (t_min, t_max) = (f32x8::splat(self.t_min), f32x8::splat(self.limit));
        let (enter, leave) =
            CullRay::<f32x8>::splat(&self.cull).interval(corner(false), corner(true), t_min, t_max);
        (enter, Lane::le(enter, leave).bits())
    }

    /// Lanes of the leaf that is next that the ray may hit, as bits; all of them where only the test can tell.
    #[inline(always)]
    fn find_candidates(&self, accel: &Accel) -> u32 {
        if self.next.kind() != PrimKind::Triangle as u8 {
            return 0xff;
        }
        let corners = unchecked::triangles(accel, self.next).corner_columns();
        T::Triangle::candidates::<T::Wide>(&self.ray, &self.triangle, corners)
    }

    /// Tests the candidates; true if a hit was accepted.
    #[inline(always)]
    fn test_candidates(&mut self, accel: &Accel) -> bool {
        if self.next.kind() != PrimKind::Triangle as u8 {
            let next = self.next;
            return with_block(accel, next, self);
        }
        let block = unchecked::triangles(accel, self.next);
        let (mut left, mut accepted) = (self.candidates, false);
        while left != 0 {
            let i = left.trailing_zeros() as usize & 7;
            left &= left - 1;
            let (corners, limit) = (block.corners_of::<T::Real>(i), self.query.limit());
            let hit = T::Triangle::test_candidate(&self.ray, &self.triangle, corners, limit);
            accepted |= self.query.accept(&self.ray, &hit, block.ids()[i]);
        }
        accepted
    }
}

fn cull_ray<T: Tier>(ray: &RayLanes<T::Real>, tree: TreeRoot) -> CullRay<f32> {
    let narrow = |x: T::Real| x.to_f32();
    let narrow3 = |v: Vec3<T::Real>| Vec3::new(narrow(v.x), narrow(v.y), narrow(v.z));
    let origin = narrow3(ray.origin);
    CullRay::new(origin, narrow3(ray.direction), tree.scale_for(origin))
}

fn octant(cull: &CullRay<f32>) -> u32 {
    let backward = cull.backward();
    three(|k| u32::from(backward[k]) << k).into_iter().sum()
}

/// Leaves of anything but triangles: eight at once.
impl<T: Tier, Q: Query<T::Real>> BlockVisitor for Slot<T, Q> {
    #[inline(never)]
    fn visit<B: Testable>(&mut self, block: &B) -> bool {
        let rays = TestRays::new(RayLanes::splat(&self.ray));
        let limit = T::Wide::splat(self.query.limit());
        let hit: LaneHit<T::Wide> = block.test::<T, PrimitivesByRay>(0, &rays, limit);
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
