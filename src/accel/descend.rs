//! Down the tree: one loop for closest and any hit, all tiers, packets and single rays.
//!
//! Plainly: visit every node and leaf whose box the rays meet within their limits. Departure: children stand in slots such
//! that `slot ^ octant` visits them roughly front to back for rays of that octant (Ylitie et al., Efficient Incoherent Ray
//! Traversal on GPUs Through Compressed Wide BVHs, 2017), so nothing is sorted.

use super::Accel;
use super::block::Walk;
use super::leaf::{AllSteps, PreparedRays, with_block};
use super::node::{ChildRef, Node8};
use super::query::Query;
use crate::intersect::Tier;
use crate::intersect::aabb::CullRay;
use crate::math::{Mask, three};
use std::marker::PhantomData;
use wide::f32x8;

/// How rays go down the tree.
pub(super) trait Descend: Walk {
    /// A child to visit, and where the rays enter it.
    type Entry: Copy;
    /// The lanes hold one and the same ray.
    const ONE_RAY: bool;

    /// An entry that every ray reaches.
    fn entry(child: ChildRef) -> Self::Entry;
    /// Where an entry leads.
    fn child(entry: &Self::Entry) -> ChildRef;
    /// True if any ray enters within its limit.
    fn reaches(entry: &Self::Entry, limit: f32x8) -> bool;
    /// Pushes the children that any ray meets within its range, the last to visit first.
    fn push_children(
        node: &Node8,
        cull: &CullRay<f32x8>,
        octant: Octant,
        range: (f32x8, f32x8),
        stack: &mut Vec<Self::Entry>,
    );
}

/// The octant of the first ray, and whether all rays share it.
#[derive(Clone, Copy)]
pub(super) struct Octant {
    /// Bit k set where the ray goes against axis k.
    pub(super) bits: usize,
    pub(super) shared: bool,
}

impl Octant {
    #[inline(always)]
    pub(super) fn of(cull: &CullRay<f32x8>) -> Self {
        let backward = cull.backward();
        let [x, y, z] = three(|k| backward[k].bits());
        let bits = (x & 1 | (y & 1) << 1 | (z & 1) << 2) as usize;
        let agree = |m: u32| m == 0 || m == 0xff;
        Self { bits, shared: agree(x) && agree(y) && agree(z) }
    }
    /// True if rays meet the upper plane of axis `k` first.
    #[inline(always)]
    pub(super) fn upper_first(self, k: usize) -> bool {
        self.bits >> k & 1 != 0
    }
}

/// Puts everything below `root` that the rays may hit to the query. The stack never outgrows its capacity, which the
/// builder bounds by the depth of the tree.
pub(super) fn descend<T: Tier, D: Descend, Q: Query<T::Wide>>(
    accel: &Accel,
    root: u32,
    rays: &PreparedRays<T>,
    query: &mut Q,
    stack: &mut Vec<D::Entry>,
) {
    let base = stack.len();
    let t_min = T::below_f32(rays.test.ray.t_min);
    let octant = Octant::of(&rays.cull);
    stack.push(D::entry(ChildRef::node(root)));
    while stack.len() > base && !query.is_done() {
        let Some(entry) = stack.pop() else { break };
        let limit = T::above_f32(query.limit());
        if !D::reaches(&entry, limit) {
            continue;
        }
        let child = D::child(&entry);
        if child.is_node() {
            let node = &accel.nodes[child.index() as usize];
            D::push_children(node, &rays.cull, octant, (t_min, limit), stack);
        } else if child.kind() == Accel::INSTANCE {
            accel.visit_instance::<T, Q>(child, &rays.test.ray, query, |root, local, query| {
                descend::<T, D, Q>(accel, root, local, query, stack)
            });
        } else if with_block(accel, child, &mut AllSteps { rays: &rays.test, query, walk: PhantomData::<D> })
            && D::ONE_RAY
        {
            query.share_limit();
        }
    }
    stack.truncate(base);
}
