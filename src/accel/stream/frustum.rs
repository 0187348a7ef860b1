//! The pyramid around rays with a common point: what culls for 64 rays at the price of one.
//!
//! Plainly: a ray may hit a box only if the pyramid of all rays meets it. Seen along the axis `z` on which the rays go
//! farthest, a ray from the apex is `x = a z`, `y = b z` with slopes `a` and `b`; the pyramid is `a0 z <= x <= a1 z`,
//! `b0 z <= y <= b1 z`, `0 <= z <= reach`. It misses a box if all corners lie beyond one of those six planes, and a
//! triangle if all its rays pass on the outer side of one edge. Departures from the plain form:
//! - everything is widened by bounds on what the primitive tests may be off by, so that results do not depend on culling;
//! - the pyramid may stand on its tip: shadow rays towards a light meet in their target.
//!
//! **Source:** Reshetov, Soupikov and Hurley, Multi-Level Ray Tracing Algorithm, 2005; Boulos, Wald and Benthin, Adaptive
//! Ray Packet Reordering, 2008. Changed: eight boxes, or the slopes of eight packets, a test; edge functions with bounds.

mod edges;
mod slopes;
mod view;

use wide::f32x8;

use crate::accel::instance::TreeRoot;
use crate::accel::node::Node8;
use crate::intersect::{RayLanes, Tier};
use crate::math::{Lane, Mask, Real, Transform, Vec3, WIDTH};
use edges::Edges;
use slopes::{Slopes, greatest, least, range, slopes};
use view::{Boxes, View};

/// What rays of a stream have in common. It changes time, never results: rays that it is not true of go another way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Apex {
    /// All start here, up to rounding.
    Origin([f32; 3]),
    /// All pass through here, up to rounding, at or beyond their `t_max`.
    Target([f32; 3]),
}

impl Apex {
    /// The same point, in the space of an instance.
    pub(super) fn in_space_of(self, to_world: &Transform) -> Self {
        let inside = |p: [f32; 3]| to_world.inverted().point(p.map(f64::from)).map(|x| x as f32);
        match self {
            Self::Origin(p) => Self::Origin(inside(p)),
            Self::Target(p) => Self::Target(inside(p)),
        }
    }
}

/// Roundoffs of the largest coordinate by which rays may pass by their apex.
const APEX_ROUNDOFFS: f64 = 8.0;

/// Roundoffs of the largest coordinate by which the sides are moved outwards: the 36 by which boxes of a tree are padded,
/// 8 for an apex that rays pass by, 8 for the roundings of slopes and planes, on both axes of a slope up to 2; and a
/// quarter more.
const SIDE_ROUNDOFFS: f64 = 192.0;

/// The same for edge functions, of the product of the largest coordinate and the distance at which rays pass the
/// corners: a coordinate across is off by 6 roundoffs of the largest, by 14 for an apex that rays pass by, in the triangle
/// test as here; an edge function is the sum of two products of two such; and twice that.
const EDGE_ROUNDOFFS: f64 = 128.0;

/// Where eight primitives stand, as rays see them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sight {
    slopes: Slopes,
    /// Where along `z` they start.
    nearest: f32x8,
}

/// The pyramid around up to eight packets.
#[derive(Clone, Debug)]
pub(super) struct Frustum {
    view: View,
    is_target: bool,
    /// Bit `k` set where rays go against axis `k`: the order of visits.
    pub(super) octant: usize,
    all: Slopes,
    packets: Slopes,
    /// Slopes of the middle, and those above relative to it.
    middle: [f32x8; 2],
    about_middle: Slopes,
    /// Largest slope about the middle.
    spread: f32x8,
    /// Length of the directions along `z`, by packet.
    along: [f32x8; WIDTH],
    /// How far along `z` each packet still looks.
    packet_reach: [f32; WIDTH],
    /// How far along `z` any packet still looks.
    pub(super) reach: f32,
    side_pad: f32x8,
    edge_pad: f32x8,
}

/// Around nothing.
impl Default for Frustum {
    fn default() -> Self {
        let none = Slopes { a: [f32x8::ZERO; 2], b: [f32x8::ZERO; 2] };
        Self {
            view: View { axes: [0, 1, 2], backward: false, apex: [0.0; 3] },
            is_target: false,
            octant: 0,
            all: none,
            packets: none,
            middle: [f32x8::ZERO; 2],
            about_middle: none,
            spread: f32x8::ZERO,
            along: [f32x8::ONE; WIDTH],
            packet_reach: [f32::NEG_INFINITY; WIDTH],
            reach: f32::NEG_INFINITY,
            side_pad: f32x8::ZERO,
            edge_pad: f32x8::ZERO,
        }
    }
}

impl Frustum {
    /// Puts the pyramid around packets; `None`, and of no use, where they have no axis in common, go too far apart, or lie
    /// so far out that a bound overflows. In place, as it is large.
    ///
    /// **Needs:** one to eight packets.
    pub(super) fn surround<T: Tier>(
        &mut self,
        packets: &[RayLanes<T::Wide>],
        apex: Apex,
        tree: TreeRoot,
    ) -> Option<()> {
        let (point, is_target) = match apex {
            Apex::Origin(point) => (point, false),
            Apex::Target(point) => (point, true),
        };
        let first = packets.iter().find(|rays| asked::<T>(rays) != 0)?;
        let lead = asked::<T>(first).trailing_zeros() as usize;
        let view = View::along(from_apex::<T>(first, point, is_target).get(lead), point);
        let mut a = [f32x8::ZERO; WIDTH];
        let mut b = a;
        let (mut astray, mut far) = (f32x8::ZERO, Vec3::zero());
        for (j, rays) in packets.iter().enumerate() {
            let asked = asked::<T>(rays);
            if asked & !rays.t_min.ge(T::Wide::zero()).bits() != 0 {
                return None;
            }
            let seen = view.direction(from_apex::<T>(rays, point, is_target));
            (a[j], b[j], self.along[j]) = slopes(seen, asked)?;
            let origin = narrow::<T>(rays.origin);
            let by = match is_target {
                true => passes_by::<T>(rays, &view, seen),
                false => (origin - Vec3::splat(point)).abs().max_component(),
            };
            let by = Lane::select(by.ge(f32x8::ZERO), by, f32x8::splat(f32::INFINITY));
            let asked = Mask::from_bits(asked);
            astray = Lane::select(asked, Lane::max(astray, by), astray);
            far = Vec3::select(asked, far.max(origin.abs()), far);
        }
        for j in packets.len()..WIDTH {
            (a[j], b[j]) = (a[0], b[0]);
        }
        let scale = greatest(tree.scale_for(far).max(far.max_component()));
        let size = point.iter().fold(scale, |size, x| size.max(x.abs()));
        let close = greatest(astray) <= size * (APEX_ROUNDOFFS * f32::ROUNDOFF) as f32;
        if !close {
            return None;
        }
        (self.view, self.is_target) = (view, is_target);
        self.packet_reach = [f32::NEG_INFINITY; WIDTH];
        self.set_slopes(Slopes { a: range(a), b: range(b) });
        self.set_pads(2.0 * size)
    }

    /// What the rays have in common.
    pub(super) fn apex(&self) -> Apex {
        let point = self.view.apex;
        if self.is_target { Apex::Target(point) } else { Apex::Origin(point) }
    }

    /// Takes the slopes of packets, and from them the order of visits.
    #[inline(always)]
    fn set_slopes(&mut self, packets: Slopes) {
        let whole = |s: [f32x8; 2]| [f32x8::splat(least(s[0])), f32x8::splat(greatest(s[1]))];
        let all = Slopes { a: whole(packets.a), b: whole(packets.b) };
        let half = f32x8::splat(0.5);
        let middle = [(all.a[0] + all.a[1]) * half, (all.b[0] + all.b[1]) * half];
        (self.all, self.packets, self.middle) = (all, packets, middle);
        self.about_middle = all.about(middle);
        self.spread = self.about_middle.greatest();
        let [x, y, z] = self.view.axes;
        let backward = |middle: f32x8| usize::from(middle.get(0) < 0.0);
        self.octant =
            backward(middle[0]) << x | backward(middle[1]) << y | usize::from(self.view.backward) << z;
    }

    /// Takes the size of coordinates; `None` where a bound overflows.
    #[inline(always)]
    fn set_pads(&mut self, size: f32) -> Option<()> {
        let pad = |roundoffs: f64| f32x8::splat((f64::from(size) * roundoffs * f32::ROUNDOFF) as f32);
        (self.side_pad, self.edge_pad) = (pad(SIDE_ROUNDOFFS), pad(EDGE_ROUNDOFFS));
        self.edge_pad.get(0).is_finite().then_some(())
    }

    /// Takes note that the rays of packet `j` need nothing at or beyond `limit`; [`Frustum::update_reach`] must follow.
    #[inline(always)]
    pub(super) fn look(&mut self, j: usize, limit: f32x8) {
        let off = f32x8::splat(f32::NEG_INFINITY);
        let reach = match self.is_target {
            true => Lane::select(limit.gt(off), self.along[j], off),
            false => limit * self.along[j],
        };
        self.packet_reach[j] = greatest(reach);
    }

    /// Draws the far end in to what any packet still looks for.
    #[inline(always)]
    pub(super) fn update_reach(&mut self) {
        self.reach = greatest(f32x8::new(self.packet_reach)) + self.side_pad.get(0);
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
        let (at_near, at_far) = (f32x8::ONE / lo.z, f32x8::ONE / hi.z);
        let infinity = f32x8::splat(f32::INFINITY);
        let in_front = lo.z.gt(self.side_pad) & at_near.lt(infinity);
        let pad = self.side_pad * at_near;
        let range = |lo: f32x8, hi: f32x8| {
            let least = (lo * at_near).min(lo * at_far) - pad;
            let greatest = (hi * at_near).max(hi * at_far) + pad;
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

    /// Packets that may meet primitive `i`.
    #[inline(always)]
    pub(super) fn packets(&self, sight: &Sight, i: usize) -> u32 {
        let reach = f32x8::new(self.packet_reach) + self.side_pad;
        let nearest = f32x8::splat(sight.nearest.get(i));
        (sight.slopes.splat(i).overlap(&self.packets) & nearest.le(reach)).bits()
    }

    /// Lanes where no side of the pyramid has the whole box outside.
    #[inline(always)]
    fn meets(&self, slopes: &Slopes, [lo, hi]: &Boxes, reach: f32x8) -> u32 {
        let pad = self.side_pad;
        let above = |x: f32x8, slope: f32x8| x - (slope * lo.z).max(slope * hi.z);
        let below = |x: f32x8, slope: f32x8| (slope * lo.z).min(slope * hi.z) - x;
        let outside = above(lo.x, slopes.a[1])
            .max(below(hi.x, slopes.a[0]))
            .max(above(lo.y, slopes.b[1]))
            .max(below(hi.y, slopes.b[0]))
            .max(-hi.z);
        (outside.le(pad) & lo.z.le(reach)).bits()
    }

    /// Of eight triangles, given by their corners, those that rays may meet: told by their edges, not by their boxes.
    #[inline(always)]
    pub(super) fn triangles(&self, corners: [Vec3<f32x8>; 3]) -> u32 {
        let edges = Edges::of(corners, self.middle, self.spread, self.edge_pad);
        edges.met(&self.about_middle, f32x8::splat(self.reach))
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

/// From the apex along the rays: their directions, or where they come from.
#[inline(always)]
fn from_apex<T: Tier>(rays: &RayLanes<T::Wide>, apex: [f32; 3], is_target: bool) -> Vec3<f32x8> {
    match is_target {
        true => narrow::<T>(rays.origin) - Vec3::splat(apex),
        false => narrow::<T>(rays.direction),
    }
}

/// How far rays from `seen` pass by the target; infinite where they are asked for what is beyond it.
#[inline(always)]
fn passes_by<T: Tier>(rays: &RayLanes<T::Wide>, view: &View, seen: Vec3<f32x8>) -> f32x8 {
    let d = view.direction(narrow::<T>(rays.direction));
    let t = -seen.z / d.z;
    let by = Lane::max((seen.x + t * d.x).abs(), (seen.y + t * d.y).abs());
    let ends = T::nearest_f32(rays.t_max).le(t * f32x8::splat(1.0 + 4.0 * f32::EPSILON));
    Lane::select(ends, by, f32x8::splat(f32::INFINITY))
}

#[inline(always)]
fn narrow<T: Tier>(v: Vec3<T::Wide>) -> Vec3<f32x8> {
    Vec3::new(T::nearest_f32(v.x), T::nearest_f32(v.y), T::nearest_f32(v.z))
}
