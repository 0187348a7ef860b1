//! Eight rays down the tree together: each child box against all eight.
//!
//! Where the rays are short, the boxes of all children are tested first against the box around all rays ([`Region`]).
//!
//! An entry on the stack keeps the distance of each ray, so that popping it needs one comparison.

use super::block::RaysByPrimitive;
use super::descend::{Descend, Heading, Octant};
use super::instance::TreeRoot;
use super::leaf::{EachPrimitive, PreparedRays, with_block};
use super::node::{ChildRef, Node8};
use super::order::far_first;
use super::pending::Pending;
use super::query::Query;
use super::region::Region;
use super::{Accel, unchecked};
use crate::intersect::aabb::CullRay;
use crate::intersect::{RayLanes, Tier};
use crate::math::{Lane, Mask, Vec3, WIDTH, three};
use wide::f32x8;

/// A child to visit, and where each ray enters it; infinity where one does not.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    near: f32x8,
    child: ChildRef,
}

impl Descend for RaysByPrimitive {
    type Entry = Entry;
    type Kept<T: Tier> = Pending<T>;
    type Region = Option<Region>;

    #[inline(always)]
    fn region<T: Tier>(rays: &RayLanes<T::Wide>, tree: TreeRoot) -> Option<Region> {
        Region::around::<T>(std::slice::from_ref(rays), tree)
    }

    #[inline(always)]
    fn entry(child: ChildRef) -> Entry {
        Entry { near: f32x8::splat(f32::NEG_INFINITY), child }
    }
    #[inline(always)]
    fn child(entry: &Entry) -> ChildRef {
        entry.child
    }
    #[inline(always)]
    fn reaching(entry: &Entry, limit: f32x8) -> u32 {
        Lane::le(entry.near, limit).bits().count_ones()
    }

    #[inline(always)]
    fn push_children(
        accel: &Accel,
        node: &Node8,
        cull: &CullRay<f32x8>,
        heading: &Heading<Option<Region>>,
        (t_min, t_max): (f32x8, f32x8),
        stack: &mut Vec<Entry>,
    ) {
        let octant = heading.octant;
        let (mut enters, mut met) = ([f32x8::ZERO; WIDTH], 0);
        let near = heading.region.as_ref().map_or(0xff, |region| region.children(node));
        let mut left = near & node.children();
        // Which of the children are met nobody can predict: first all are tested, then those met go on the stack.
        while left != 0 {
            let slot = left.trailing_zeros() as usize % WIDTH;
            left &= left - 1;
            let (enter, leave) = interval(node, slot, cull, octant, (t_min, t_max));
            let meets = Lane::le(enter, leave);
            enters[slot] = <f32x8 as Lane>::select(meets, enter, f32x8::splat(f32::INFINITY));
            met |= u32::from(meets.any()) << slot;
        }
        for slot in far_first(octant.bits as u32, met).take(met.count_ones()) {
            unchecked::prefetch(accel, node.child[slot]);
            stack.push(Entry { near: enters[slot], child: node.child[slot] });
        }
    }

    #[inline(always)]
    fn visit_leaf<T: Tier, Q: Query<T::Wide>>(
        accel: &Accel,
        leaf: ChildRef,
        rays: &PreparedRays<T>,
        heading: &Heading<Option<Region>>,
        query: &mut Q,
        pending: &mut Pending<T>,
    ) {
        with_block(accel, leaf, &mut EachPrimitive { rays, region: heading.region.as_ref(), query, pending });
    }
    #[inline(always)]
    fn settle<T: Tier, Q: Query<T::Wide>>(ray: &RayLanes<T::Wide>, query: &mut Q, pending: &mut Pending<T>) {
        pending.settle(ray, query);
    }
}

/// Where the rays are inside a child's box; cheaper where they agree on which planes come first.
#[inline(always)]
fn interval(
    node: &Node8,
    slot: usize,
    cull: &CullRay<f32x8>,
    octant: Octant,
    (t_min, t_max): (f32x8, f32x8),
) -> (f32x8, f32x8) {
    if octant.shared {
        let plane = |k: usize, upper: bool| if upper { node.hi[k][slot] } else { node.lo[k][slot] };
        let corner = |far: bool| Vec3::splat(three(|k| plane(k, octant.upper_first(k) ^ far)));
        return cull.interval(corner(false), corner(true), t_min, t_max);
    }
    let splat = |c: &[[f32; WIDTH]; 3]| Vec3::splat([c[0][slot], c[1][slot], c[2][slot]]);
    cull.interval_any(splat(&node.lo), splat(&node.hi), t_min, t_max)
}
