//! Down the tree: one loop for closest and any hit, all tiers, packets and single rays.
//!
//! Plainly: visit every node and leaf whose box the rays meet within their limits. Departure: children stand in slots such
//! that `slot ^ octant` visits them roughly front to back for rays of that octant (Ylitie et al., Efficient Incoherent Ray
//! Traversal on GPUs Through Compressed Wide BVHs, 2017), so nothing is sorted.

use super::Accel;
use super::block::Walk;
use super::instance::TreeRoot;
use super::leaf::PreparedRays;
use super::node::{ChildRef, Node8};
use super::query::Query;
use crate::intersect::aabb::CullRay;
use crate::intersect::{RayLanes, Tier};
use crate::math::{Mask, three};
use wide::f32x8;

/// How rays go down the tree.
pub(super) trait Descend: Walk {
    /// A child to visit, and where the rays enter it.
    type Entry: Copy;
    /// What is kept on the way down.
    type Kept<T: Tier>: Default;
    /// What is known of where rays go, beside their octant.
    type Region: Copy;

    /// Where rays go in a tree, as far as that is worth knowing.
    fn region<T: Tier>(rays: &RayLanes<T::Wide>, tree: TreeRoot) -> Self::Region;
    /// An entry that every ray reaches.
    fn entry(child: ChildRef) -> Self::Entry;
    /// Where an entry leads.
    fn child(entry: &Self::Entry) -> ChildRef;
    /// How many rays enter within their limits.
    fn reaching(entry: &Self::Entry, limit: f32x8) -> u32;
    /// Pushes the children that any ray meets within its range, the last to visit first.
    fn push_children(
        accel: &Accel,
        node: &Node8,
        cull: &CullRay<f32x8>,
        heading: &Heading<Self::Region>,
        range: (f32x8, f32x8),
        stack: &mut Vec<Self::Entry>,
    );
    /// Puts the primitives of a leaf to the query.
    fn visit_leaf<T: Tier, Q: Query<T::Wide>>(
        accel: &Accel,
        leaf: ChildRef,
        rays: &PreparedRays<T>,
        heading: &Heading<Self::Region>,
        query: &mut Q,
        kept: &mut Self::Kept<T>,
    );
    /// Leaves the query as it would be had nothing been kept.
    fn settle<T: Tier, Q: Query<T::Wide>>(ray: &RayLanes<T::Wide>, query: &mut Q, kept: &mut Self::Kept<T>);
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

/// Where rays go.
#[derive(Clone, Copy)]
pub(super) struct Heading<R> {
    pub(super) octant: Octant,
    pub(super) region: R,
}

/// What it costs rays to visit together, and each of them to visit alone: nanoseconds on one Zen 4 core, from the rates of
/// reflected, diffuse and occlusion rays through two scenes, both ways.
struct Costs {
    /// A node, for all rays of a packet: cheaper where they agree on which planes come first.
    node: i32,
    /// A leaf, for all rays of a packet: cheaper where any hit will do.
    leaf: i32,
}

impl Costs {
    /// A node and a leaf, for a ray alone.
    const ONE_IN_NODE: i32 = 8;
    const ONE_IN_LEAF: i32 = 10;
    /// Starting eight rays, each alone.
    const START: i32 = 130;

    /// What packets wait for more, rays alone having others to go on with, where a tree lies in memory rather than in caches.
    const FAR_NODE: i32 = 20;
    const FAR_LEAF: i32 = 60;
    /// Blocks of triangles, 320 bytes each, from which a tree does.
    const FAR_BLOCKS: usize = 50_000;

    fn of(accel: &Accel, octant: Octant, any: bool) -> Self {
        let node = if octant.shared { 21 } else { 45 };
        let leaf = if any { 70 } else { 150 };
        match accel.triangles.len() < Self::FAR_BLOCKS {
            true => Self { node, leaf },
            false => Self { node: node + Self::FAR_NODE, leaf: leaf + Self::FAR_LEAF },
        }
    }
    /// What so many rays save by visiting together.
    #[inline(always)]
    fn saved(&self, child: ChildRef, rays: u32) -> i32 {
        let rays = rays as i32;
        if child.is_node() {
            Self::ONE_IN_NODE * rays - self.node
        } else {
            Self::ONE_IN_LEAF * rays - self.leaf
        }
    }
}

/// Puts everything in a tree that the rays may hit to the query, from its root or from a node that stands for it. The stack
/// never outgrows its capacity, which the builder bounds by the depth of the tree.
///
/// Gives what a packet saved by going together, as estimated from what it visited.
pub(super) fn descend<T: Tier, D: Descend, Q: Query<T::Wide>>(
    accel: &Accel,
    tree: TreeRoot,
    entry: Option<(&Node8, D::Region)>,
    rays: &PreparedRays<T>,
    query: &mut Q,
    stack: &mut Vec<D::Entry>,
) -> i32 {
    let base = stack.len();
    let t_min = T::below_f32(rays.ray.t_min);
    let region = entry.map_or_else(|| D::region::<T>(&rays.ray, tree), |(_, region)| region);
    let heading = Heading { octant: Octant::of(&rays.cull), region };
    let mut kept = D::Kept::<T>::default();
    let (costs, mut saved) = (Costs::of(accel, heading.octant, Q::ANY), Costs::START);
    match entry {
        Some((node, _)) => {
            let range = (t_min, T::above_f32(query.limit()));
            D::push_children(accel, node, &rays.cull, &heading, range, stack);
        }
        None => stack.push(D::entry(ChildRef::node(tree.node))),
    }
    while stack.len() > base && !query.is_done() {
        let Some(entry) = stack.pop() else { break };
        let limit = T::above_f32(query.limit());
        let rays_in = D::reaching(&entry, limit);
        if rays_in == 0 {
            continue;
        }
        let child = D::child(&entry);
        saved += costs.saved(child, rays_in);
        if child.is_node() {
            let node = &accel.nodes[child.index() as usize];
            D::push_children(accel, node, &rays.cull, &heading, (t_min, limit), stack);
        } else if child.kind() == Accel::INSTANCE {
            D::settle::<T, Q>(&rays.ray, query, &mut kept);
            accel.visit_instance::<T, Q>(child, &rays.ray, query, |tree, local, query| {
                saved += descend::<T, D, Q>(accel, tree, None, local, query, stack);
            });
        } else {
            D::visit_leaf::<T, Q>(accel, child, rays, &heading, query, &mut kept);
        }
    }
    D::settle::<T, Q>(&rays.ray, query, &mut kept);
    stack.truncate(base);
    saved
}
