//! The pyramid around rays with a common point: what culls for 64 or 256 rays at the price of one.
//!
//! Plainly: a ray may hit a box only if the pyramid of all rays meets it. Seen along the axis `z` on which the rays go
//! farthest, a ray from the apex is `x = a z`, `y = b z` with slopes `a` and `b`; the pyramid is `a0 z <= x <= a1 z`,
//! `b0 z <= y <= b1 z`, `0 <= z <= reach`. It misses a box if all corners lie beyond one of those six planes, and a
//! triangle if all its rays pass on the outer side of one edge. Departures from the plain form:
//! - everything is widened by bounds on what the primitive tests may be off by, so that results do not depend on culling;
//! - the pyramid may stand on its tip: shadow rays towards a light meet in their target;
//! - rays may start beyond the apex, and pass it by: those that a mirror throws back. Then `z` starts where the first does;
//! - rays may be parallel: then the pyramid is a prism, see [`view`], and slopes are coordinates across.
//!
//! **Source:** Reshetov, Soupikov and Hurley, Multi-Level Ray Tracing Algorithm, 2005; Boulos, Wald and Benthin, Adaptive
//! Ray Packet Reordering, 2008. Changed: eight boxes, or the slopes of eight packets, a test; edge functions with bounds.

mod apex;
mod edges;
mod focus;
mod groups;
mod plane;
mod rounds;
mod slopes;
mod surround;
#[cfg(test)]
mod tests;
mod view;

use wide::f32x8;

use super::{BUNDLE, GROUPS};
use crate::accel::node::Node8;
use crate::intersect::{RayLanes, Tier};
use crate::math::{Lane, Mask, Vec3, WIDTH};
pub use apex::Apex;
pub(super) use edges::Edges;
use edges::{Eight, Middle};
pub(super) use focus::focus;
use groups::Group;
use plane::Plane;
use slopes::{Slopes, greatest};
use view::{Boxes, View};

/// Where eight primitives stand, as rays see them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sight {
    slopes: Slopes,
    /// Where along `z` they start.
    nearest: f32x8,
}

/// The pyramid around the packets of a bundle.
#[derive(Clone, Debug)]
pub(super) struct Frustum {
    view: View,
    apex: Apex,
    /// Bit `k` set where rays go against axis `k`: the order of visits.
    pub(super) octant: usize,
    all: Slopes,
    groups: [Group; GROUPS],
    /// Groups that hold packets.
    count: usize,
    /// In the middle of all, and the slopes above relative to it.
    middle: Middle,
    about_middle: Slopes,
    /// Rays, by packet.
    rays: [Eight; BUNDLE],
    /// Where rays start along `z`, by packet; with an apex to come, 0.
    start: [f32x8; BUNDLE],
    /// True if edges tell enough of where rays meet triangles: what they tell is relative to the apex, so rays have to start there.
    pub(super) tells_meetings: bool,
    /// Length of the directions along `z`, by packet.
    along: [f32x8; BUNDLE],
    /// Where along `z` the first ray starts.
    first: f32x8,
    /// How far along `z` any packet still looks.
    pub(super) reach: f32,
    side_pad: f32x8,
}

/// Around nothing.
impl Default for Frustum {
    fn default() -> Self {
        let none = Slopes { a: [f32x8::ZERO; 2], b: [f32x8::ZERO; 2] };
        Self {
            view: View::along([0.0, 0.0, 1.0], [0.0; 3]),
            apex: Apex::Origin([0.0; 3]),
            octant: 0,
            all: none,
            groups: [Group::default(); GROUPS],
            count: 0,
            middle: Middle::default(),
            about_middle: none,
            rays: [Eight { slopes: [f32x8::ZERO; 2], per_z: f32x8::ONE }; BUNDLE],
            tells_meetings: false,
            start: [f32x8::ZERO; BUNDLE],
            along: [f32x8::ONE; BUNDLE],
            first: f32x8::ZERO,
            reach: f32::NEG_INFINITY,
            side_pad: f32x8::ZERO,
        }
    }
}

impl Frustum {
    /// What the rays have in common.
    pub(super) fn apex(&self) -> Apex {
        self.apex
    }

    /// Takes note that the rays of packet `j` need nothing at or beyond `limit`; [`Frustum::update_reach`] must follow.
    #[inline(always)]
    pub(super) fn look(&mut self, j: usize, limit: f32x8) {
        let off = f32x8::splat(f32::NEG_INFINITY);
        let reach = match self.apex.is_target() {
            true => Lane::select(limit.gt(off), self.along[j], off),
            false => self.start[j] + limit * self.along[j],
        };
        self.groups[j / WIDTH].reach[j % WIDTH] = greatest(reach);
    }

    /// Draws the far end in to what any packet still looks for.
    #[inline(always)]
    pub(super) fn update_reach(&mut self) {
        let groups = self.groups[..self.count].iter();
        let reach = groups
            .fold(f32x8::splat(f32::NEG_INFINITY), |reach, group| Lane::max(f32x8::new(group.reach), reach));
        self.reach = greatest(reach) + self.side_pad.get(0);
    }

    /// The children that rays may meet, as bits, and where along `z` they start.
    #[inline(always)]
    pub(super) fn children(&self, node: &Node8) -> (u32, f32x8) {
        let [lo, hi] = self.view.boxes(|k| f32x8::new(node.lo[k]), |k| f32x8::new(node.hi[k]));
        (self.meets(&self.all, &[lo, hi], f32x8::splat(self.reach)), lo.z)
    }

    /// The slopes at which rays may meet eight primitives in their boxes.
    #[inline(always)]
    pub(super) fn sight(&self, [lo, hi]: &Boxes) -> Sight {
        if self.view.lean.is_some() {
            let pad = self.side_pad;
            let slopes = Slopes { a: [lo.x - pad, hi.x + pad], b: [lo.y - pad, hi.y + pad] };
            return Sight { slopes, nearest: lo.z };
        }
        let nearest = Lane::max(lo.z, self.first - self.side_pad);
        let (at_near, at_far) = (f32x8::ONE / nearest, f32x8::ONE / hi.z);
        let infinity = f32x8::splat(f32::INFINITY);
        let in_front = nearest.gt(self.side_pad) & at_near.lt(infinity);
        let pad = self.side_pad * at_near;
        let range = |lo: f32x8, hi: f32x8| {
            let least = Lane::min(lo * at_near, lo * at_far) - pad;
            let greatest = Lane::max(hi * at_near, hi * at_far) + pad;
            [Lane::select(in_front, least, -infinity), Lane::select(in_front, greatest, infinity)]
        };
        Sight { slopes: Slopes { a: range(lo.x, hi.x), b: range(lo.y, hi.y) }, nearest: lo.z }
    }

    /// Of eight primitives, those that rays may meet.
    #[inline(always)]
    pub(super) fn sees(&self, sight: &Sight) -> u32 {
        (sight.slopes.overlap(&self.all) & sight.nearest.le(f32x8::splat(self.reach))).bits()
    }

    /// Of eight primitives, those that cover more than the pyramid in some direction.
    #[inline(always)]
    pub(super) fn wide(&self, sight: &Sight) -> u32 {
        sight.slopes.wider_than(&self.all).bits()
    }

    /// Lanes of packet `j` that look as far as primitive `i`, given their limits.
    #[inline(always)]
    pub(super) fn reaching(&self, sight: &Sight, i: usize, j: usize, limit: f32x8) -> u32 {
        let reach = limit.mul_add_fast(self.along[j], self.start[j]) + self.side_pad;
        let nearest = f32x8::splat(sight.nearest.get(i));
        if self.apex.is_target() { 0xff } else { nearest.le(reach).bits() }
    }

    /// Lanes where no side of the pyramid has the whole box outside.
    #[inline(always)]
    fn meets(&self, slopes: &Slopes, [lo, hi]: &Boxes, reach: f32x8) -> u32 {
        let pad = self.side_pad;
        let beside = if self.view.lean.is_some() {
            slopes.apart([lo.x, hi.x], [lo.y, hi.y])
        } else {
            let above = |x: f32x8, slope: f32x8| x - Lane::max(slope * lo.z, slope * hi.z);
            let below = |x: f32x8, slope: f32x8| Lane::min(slope * lo.z, slope * hi.z) - x;
            let beside_x = Lane::max(above(lo.x, slopes.a[1]), below(hi.x, slopes.a[0]));
            let beside_y = Lane::max(above(lo.y, slopes.b[1]), below(hi.y, slopes.b[0]));
            Lane::max(beside_x, beside_y)
        };
        let outside = Lane::max(beside, self.first - hi.z);
        (outside.le(pad) & lo.z.le(reach)).bits()
    }

    /// Edges of eight triangles, given by their corners; sharper for rays of packets that may meet them ([`Self::packets`]) if
    /// told how they are seen.
    #[inline(always)]
    pub(super) fn edges(&self, sight: Option<&Sight>, corners: [Vec3<f32x8>; 3]) -> Edges {
        // Parallel rays see all at one distance.
        let corners = match self.view.lean {
            Some(_) => corners.map(|corner| Vec3 { z: f32x8::ONE, ..corner }),
            None => corners,
        };
        Edges::of(corners, sight.map(|sight| sight.slopes.width()), &self.middle)
    }

    /// Of eight triangles, those that rays may meet: told by their edges, not by their boxes.
    #[inline(always)]
    pub(super) fn triangles(&self, edges: &Edges) -> u32 {
        // There edges do not tell how far along the rays it is.
        let reach = if self.view.lean.is_some() { f32::INFINITY } else { self.reach };
        edges.met(&self.about_middle, f32x8::splat(reach))
    }

    /// The plane of a triangle.
    #[inline(always)]
    pub(super) fn plane(&self, corners: [[f32; 3]; 3]) -> Plane {
        Plane::of(corners, self.side_pad.get(0))
    }

    /// The rays of packet `j`.
    #[inline(always)]
    pub(super) fn eight(&self, j: usize) -> &Eight {
        &self.rays[j]
    }

    /// How rays see things.
    #[inline(always)]
    pub(super) fn view(&self) -> &View {
        &self.view
    }
}

/// Lanes that ask anything.
#[inline(always)]
fn asked<T: Tier>(rays: &RayLanes<T::Wide>) -> u32 {
    T::nearest_f32(rays.t_max).gt(f32x8::splat(f32::NEG_INFINITY)).bits()
}

#[inline(always)]
pub(super) fn narrow<T: Tier>(v: Vec3<T::Wide>) -> Vec3<f32x8> {
    Vec3::new(T::nearest_f32(v.x), T::nearest_f32(v.y), T::nearest_f32(v.z))
}
