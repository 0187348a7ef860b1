//! One ray through the tree: eight child boxes, then eight primitives, at a time.
//!
//! Plainly: visit the children that the ray meets, nearest octant first (slots as in [`super::packet`]). The ray is
//! splatted over the lanes, each lane keeps the best of the primitives it sees, and the lanes share one limit.

use super::Accel;
use super::block::PrimitivesByRay;
use super::leaf::{PreparedRays, visit_leaf};
use super::node::{ChildRef, Node8};
use super::query::Query;
use crate::intersect::Tier;
use crate::intersect::aabb::CullRay;
use crate::math::{Lane, Mask, Vec3, WIDTH};
use wide::f32x8;

/// A child to visit, and where the ray enters it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    near: f32,
    child: ChildRef,
}

/// Puts everything below `root` that the ray may hit to the query. **Needs:** all lanes of `rays` equal.
pub(super) fn traverse<T: Tier, Q: Query<T::Wide>>(
    accel: &Accel,
    root: u32,
    rays: &PreparedRays<T>,
    query: &mut Q,
    stack: &mut Vec<Entry>,
) {
    let base = stack.len();
    let t_min = T::below_f32(rays.ray.t_min);
    let octant = rays.cull.backward().iter().enumerate().map(|(k, m)| (m.bits() as usize & 1) << k).sum();
    stack.push(Entry { near: f32::NEG_INFINITY, child: ChildRef::node(root) });
    while stack.len() > base && !query.is_done() {
        let Some(entry) = stack.pop() else { break };
        let limit = T::above_f32(query.limit());
        if !(entry.near <= Lane::get(limit, 0)) {
            continue;
        }
        if entry.child.is_node() {
            push_children(
                &accel.nodes[entry.child.index() as usize],
                &rays.cull,
                octant,
                (t_min, limit),
                stack,
            );
        } else if entry.child.kind() == Accel::INSTANCE {
            accel.visit_instances::<T, Q>(entry.child, rays, query, |root, local, query| {
                traverse::<T, Q>(accel, root, local, query, stack)
            });
        } else if visit_leaf::<T, PrimitivesByRay, Q>(accel, entry.child, rays, query) {
            query.share_limit();
        }
    }
    stack.truncate(base);
}

/// Pushes the children that the ray meets within its range, the last to visit first.
#[inline(always)]
fn push_children(
    node: &Node8,
    cull: &CullRay<f32x8>,
    octant: usize,
    (t_min, t_max): (f32x8, f32x8),
    stack: &mut Vec<Entry>,
) {
    let planes = |k: usize, far: bool| {
        let side = if (octant >> k & 1 != 0) ^ far { &node.hi[k] } else { &node.lo[k] };
        f32x8::new(*side)
    };
    let near = Vec3 { x: planes(0, false), y: planes(1, false), z: planes(2, false) };
    let far = Vec3 { x: planes(0, true), y: planes(1, true), z: planes(2, true) };
    let (enter, leave) = cull.interval(near, far, t_min, t_max);
    let meets = Lane::le(enter, leave).bits();
    if meets == 0 {
        return;
    }
    let enter = enter.to_array();
    for i in (0..WIDTH).rev() {
        let slot = i ^ octant;
        // Where the slabs of huge scenes overflow, a ray may seem to meet even the box of a free slot.
        if meets >> slot & 1 != 0 && !node.child[slot].is_empty() {
            stack.push(Entry { near: enter[slot], child: node.child[slot] });
        }
    }
}
