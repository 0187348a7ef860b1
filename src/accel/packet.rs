//! Eight rays through the tree together: each child box against all eight.
//!
//! Plainly: visit the nodes that any ray of the packet meets, nearest octant first. Departures: children stand in slots
//! such that `slot ^ octant` visits them roughly front to back for rays of that octant (Ylitie et al., Efficient
//! Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs, 2017), so nothing is sorted; an entry on the stack
//! keeps the distance of each ray, so that popping it needs one comparison.

use super::Accel;
use super::block::RaysByPrimitive;
use super::leaf::{PreparedRays, visit_leaf};
use super::node::{ChildRef, Node8};
use super::query::Query;
use crate::intersect::Tier;
use crate::intersect::aabb::CullRay;
use crate::math::{Lane, Mask, Vec3, WIDTH};
use wide::f32x8;

/// A child to visit, and where each ray enters it; infinity where one does not.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    near: f32x8,
    child: ChildRef,
}

/// Puts everything below `root` that the rays may hit to the query.
pub(super) fn traverse<T: Tier, Q: Query<T::Wide>>(
    accel: &Accel,
    root: u32,
    rays: &PreparedRays<T>,
    query: &mut Q,
    stack: &mut Vec<Entry>,
) {
    let base = stack.len();
    let t_min = T::below_f32(rays.ray.t_min);
    let order = Octant::of(&rays.cull);
    stack.push(Entry { near: f32x8::splat(f32::NEG_INFINITY), child: ChildRef::node(root) });
    while stack.len() > base && !query.is_done() {
        let Some(entry) = stack.pop() else { break };
        let limit = T::above_f32(query.limit());
        if !Lane::le(entry.near, limit).any() {
            continue;
        }
        if entry.child.is_node() {
            push_children(
                &accel.nodes[entry.child.index() as usize],
                &rays.cull,
                order,
                (t_min, limit),
                stack,
            );
        } else if entry.child.kind() == Accel::INSTANCE {
            accel.visit_instances::<T, Q>(entry.child, rays, query, |root, local, query| {
                traverse::<T, Q>(accel, root, local, query, stack)
            });
        } else {
            visit_leaf::<T, RaysByPrimitive, Q>(accel, entry.child, rays, query);
        }
    }
    stack.truncate(base);
}

/// The octant of the first ray, and whether all rays share it.
#[derive(Clone, Copy)]
struct Octant {
    bits: usize,
    shared: bool,
}

impl Octant {
    #[inline(always)]
    fn of(cull: &CullRay<f32x8>) -> Self {
        let axes = cull.backward().map(|m| m.bits());
        let bits = axes.iter().enumerate().map(|(k, m)| (*m as usize & 1) << k).sum();
        Self { bits, shared: axes.iter().all(|&m| m == 0 || m == 0xff) }
    }
}

/// Pushes the children that any ray meets within its range, the last to visit first.
#[inline(always)]
fn push_children(
    node: &Node8,
    cull: &CullRay<f32x8>,
    octant: Octant,
    (t_min, t_max): (f32x8, f32x8),
    stack: &mut Vec<Entry>,
) {
    for i in (0..WIDTH).rev() {
        let slot = i ^ octant.bits;
        let child = node.child[slot];
        if child.is_empty() {
            continue;
        }
        let corner = |far: bool| {
            let side = |k: usize| {
                if (octant.bits >> k & 1 != 0) ^ far { node.hi[k][slot] } else { node.lo[k][slot] }
            };
            Vec3::splat([side(0), side(1), side(2)])
        };
        let (enter, leave) = if octant.shared {
            cull.interval(corner(false), corner(true), t_min, t_max)
        } else {
            let splat = |c: &[[f32; WIDTH]; 3]| Vec3::splat([c[0][slot], c[1][slot], c[2][slot]]);
            cull.interval_any(splat(&node.lo), splat(&node.hi), t_min, t_max)
        };
        let meets = Lane::le(enter, leave);
        if meets.any() {
            let near = <f32x8 as Lane>::select(meets, enter, f32x8::splat(f32::INFINITY));
            stack.push(Entry { near, child });
        }
    }
}
