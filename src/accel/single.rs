//! One ray down the tree: eight child boxes, then eight primitives, at a time.
//!
//! The ray is splatted over the lanes, each lane keeps the best of the primitives it sees, and the lanes share one limit.

use super::Accel;
use super::block::PrimitivesByRay;
use super::descend::{Descend, Heading};
use super::instance::TreeRoot;
use super::leaf::{AllPrimitives, PreparedRays, with_block};
use super::node::{ChildRef, Node8};
use super::query::Query;
use crate::intersect::aabb::CullRay;
use crate::intersect::{RayLanes, Tier};
use crate::math::{Lane, Mask, Vec3, WIDTH};
use wide::f32x8;

/// A child to visit, and where the ray enters it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    pub(super) near: f32,
    pub(super) child: ChildRef,
}

impl Entry {
    #[inline(always)]
    pub(super) fn new(near: f32, child: ChildRef) -> Self {
        Self { near, child }
    }
}

impl Descend for PrimitivesByRay {
    type Entry = Entry;
    type Kept<T: Tier> = ();
    type Region = ();

    #[inline(always)]
    fn region<T: Tier>(_: &RayLanes<T::Wide>, _: TreeRoot) {}

    #[inline(always)]
    fn entry(child: ChildRef) -> Entry {
        Entry { near: f32::NEG_INFINITY, child }
    }
    #[inline(always)]
    fn child(entry: &Entry) -> ChildRef {
        entry.child
    }
    #[inline(always)]
    fn reaching(entry: &Entry, limit: f32x8) -> u32 {
        u32::from(entry.near <= Lane::get(&limit, 0))
    }

    #[inline(always)]
    fn push_children(
        _: &Accel,
        node: &Node8,
        cull: &CullRay<f32x8>,
        heading: &Heading<()>,
        (t_min, t_max): (f32x8, f32x8),
        stack: &mut Vec<Entry>,
    ) {
        let planes = |k: usize, upper: bool| f32x8::new(if upper { node.hi[k] } else { node.lo[k] });
        let side = |far: bool| {
            let axis = |k: usize| planes(k, heading.octant.upper_first(k) ^ far);
            Vec3 { x: axis(0), y: axis(1), z: axis(2) }
        };
        let (enter, leave) = cull.interval(side(false), side(true), t_min, t_max);
        let meets = Lane::le(enter, leave).bits();
        if meets == 0 {
            return;
        }
        let enter = enter.to_array();
        for slot in (0..WIDTH).rev().map(|i| i ^ heading.octant.bits) {
            // Where the slabs of huge scenes overflow, a ray may seem to meet even the box of a free slot.
            if meets >> slot & 1 != 0 && !node.child[slot].is_empty() {
                stack.push(Entry { near: enter[slot], child: node.child[slot] });
            }
        }
    }

    #[inline(always)]
    fn visit_leaf<T: Tier, Q: Query<T::Wide>>(
        accel: &Accel,
        leaf: ChildRef,
        rays: &PreparedRays<T>,
        _: &Heading<()>,
        query: &mut Q,
        (): &mut (),
    ) {
        if with_block(accel, leaf, &mut AllPrimitives { rays, query }) {
            query.share_limit();
        }
    }
    #[inline(always)]
    fn settle<T: Tier, Q: Query<T::Wide>>(_: &RayLanes<T::Wide>, _: &mut Q, (): &mut ()) {}
}
