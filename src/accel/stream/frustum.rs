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

use wide::f32x8;

use crate::accel::instance::TreeRoot;
use crate::accel::node::Node8;
use crate::intersect::{RayLanes, Tier};
use crate::math::{Lane, Mask, Real, Transform, Vec3, WIDTH, fused_cross, three};

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

/// Largest slope: beyond it rays go too far apart, or along another axis.
const MAX_SLOPE: f32 = 2.0;

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

/// Slopes: of one pyramid in all lanes, or of a packet a lane.
#[derive(Clone, Copy, Debug)]
struct Slopes {
    /// Least and greatest `x / z`.
    a: [f32x8; 2],
    /// Least and greatest `y / z`.
    b: [f32x8; 2],
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
    all_about_middle: Slopes,
    packets_about_middle: Slopes,
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

/// Which stored axes stand for `x`, `y` and `z`, seen from the apex.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    axes: [usize; 3],
    /// Rays go against the stored axis that stands for `z`.
    backward: bool,
    apex: [f32; 3],
}

/// Least, then greatest coordinates of eight boxes, as a view sees them.
pub(super) type Boxes = [Vec3<f32x8>; 2];

impl View {
    /// The view along the axis on which a direction goes farthest.
    fn along(d: [f32; 3], apex: [f32; 3]) -> Self {
        let size = d.map(f32::abs);
        let z = if size[0] >= size[1] && size[0] >= size[2] {
            0
        } else if size[1] >= size[2] {
            1
        } else {
            2
        };
        Self { axes: [(z + 1) % 3, (z + 2) % 3, z], backward: d[z] < 0.0, apex }
    }
    #[inline(always)]
    fn direction(&self, d: Vec3<f32x8>) -> Vec3<f32x8> {
        let d = [d.x, d.y, d.z];
        let [x, y, z] = self.axes;
        Vec3::new(d[x], d[y], if self.backward { -d[z] } else { d[z] })
    }
    #[inline(always)]
    fn point(&self, p: impl Fn(usize) -> f32x8) -> Vec3<f32x8> {
        let [x, y, z] = three(|i| p(self.axes[i]) - f32x8::splat(self.apex[self.axes[i]]));
        Vec3::new(x, y, if self.backward { -z } else { z })
    }
    /// Boxes from their stored coordinates, by axis.
    #[inline(always)]
    pub(super) fn boxes(&self, lo: impl Fn(usize) -> f32x8, hi: impl Fn(usize) -> f32x8) -> Boxes {
        let (a, b) = (self.point(lo), self.point(hi));
        match self.backward {
            true => [Vec3 { z: b.z, ..a }, Vec3 { z: a.z, ..b }],
            false => [a, b],
        }
    }
}

impl Frustum {
    /// The pyramid around packets; `None` where they have no axis in common or go too far apart.
    ///
    /// **Needs:** one to eight packets.
    pub(super) fn around<T: Tier>(packets: &[RayLanes<T::Wide>], apex: Apex, tree: TreeRoot) -> Option<Self> {
        let (point, is_target) = match apex {
            Apex::Origin(point) => (point, false),
            Apex::Target(point) => (point, true),
        };
        let first = packets.iter().find(|rays| asked::<T>(rays) != 0)?;
        let lead = asked::<T>(first).trailing_zeros() as usize;
        let view = View::along(from_apex::<T>(first, point, is_target).get(lead), point);
        let mut a = [f32x8::ZERO; WIDTH];
        let (mut b, mut along) = (a, [f32x8::ONE; WIDTH]);
        let (mut astray, mut far) = (f32x8::ZERO, Vec3::zero());
        for (j, rays) in packets.iter().enumerate() {
            let asked = asked::<T>(rays);
            if asked & !rays.t_min.ge(T::Wide::zero()).bits() != 0 {
                return None;
            }
            let seen = view.direction(from_apex::<T>(rays, point, is_target));
            (a[j], b[j], along[j]) = slopes(seen, asked)?;
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
        let packets = Slopes { a: range(a), b: range(b) };
        if !close {
            return None;
        }
        Self { view, is_target, along, ..Self::with(packets, 2.0 * size) }.oriented()
    }

    /// What the rays have in common.
    pub(super) fn apex(&self) -> Apex {
        let point = self.view.apex;
        if self.is_target { Apex::Target(point) } else { Apex::Origin(point) }
    }

    /// The pyramid of some slopes, in a scene of some size.
    fn with(packets: Slopes, size: f32) -> Self {
        let whole = |s: [f32x8; 2]| [f32x8::splat(least(s[0])), f32x8::splat(greatest(s[1]))];
        let pad = |roundoffs: f64| f32x8::splat((f64::from(size) * roundoffs * f32::ROUNDOFF) as f32);
        let all = Slopes { a: whole(packets.a), b: whole(packets.b) };
        let half = f32x8::splat(0.5);
        let middle = [(all.a[0] + all.a[1]) * half, (all.b[0] + all.b[1]) * half];
        let all_about_middle = all.about(middle);
        let [a, b] = {
            let greatest = |s: [f32x8; 2]| Lane::max(s[0].abs(), s[1].abs());
            [greatest(all_about_middle.a), greatest(all_about_middle.b)]
        };
        Self {
            view: View { axes: [0, 1, 2], backward: false, apex: [0.0; 3] },
            is_target: false,
            octant: 0,
            all,
            packets,
            middle,
            all_about_middle,
            packets_about_middle: packets.about(middle),
            spread: Lane::max(a, b),
            along: [f32x8::ONE; WIDTH],
            packet_reach: [f32::NEG_INFINITY; WIDTH],
            reach: f32::NEG_INFINITY,
            side_pad: pad(SIDE_ROUNDOFFS),
            edge_pad: pad(EDGE_ROUNDOFFS),
        }
    }

    /// With the order of visits; `None` where coordinates are so large that a bound overflows.
    fn oriented(mut self) -> Option<Self> {
        let [x, y, z] = self.view.axes;
        let backward = |s: [f32x8; 2]| usize::from(s[0].get(0) + s[1].get(0) < 0.0);
        self.octant =
            backward(self.all.a) << x | backward(self.all.b) << y | usize::from(self.view.backward) << z;
        self.edge_pad.get(0).is_finite().then_some(self)
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

    /// Of eight primitives in their boxes, those that rays may meet.
    #[inline(always)]
    pub(super) fn primitives(&self, boxes: &Boxes) -> u32 {
        self.meets(&self.all, boxes, f32x8::splat(self.reach))
    }

    /// Packets that may meet primitive `i`.
    #[inline(always)]
    pub(super) fn packets(&self, boxes: &Boxes, i: usize) -> u32 {
        let one = |v: Vec3<f32x8>| Vec3::splat(v.get(i));
        let reach = f32x8::new(self.packet_reach) + self.side_pad;
        self.meets(&self.packets, &[one(boxes[0]), one(boxes[1])], reach)
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

    /// The edge functions of eight triangles, from stored corners.
    #[inline(always)]
    pub(super) fn edges(&self, corner: &[[[f32; WIDTH]; 3]; 3]) -> Edges {
        let corners = three(|v| self.view.point(|k| f32x8::new(corner[v][k])));
        Edges::of(corners, self.middle, self.spread, self.edge_pad)
    }

    /// Of eight triangles, those that rays may meet.
    #[inline(always)]
    pub(super) fn triangles(&self, edges: &Edges) -> u32 {
        edges.met(&self.all_about_middle) & edges.nearest.le(f32x8::splat(self.reach)).bits()
    }

    /// Packets that may meet triangle `i`.
    #[inline(always)]
    pub(super) fn packets_at(&self, edges: &Edges, i: usize) -> u32 {
        let one = Edges {
            normal: three(|e| Vec3::splat(edges.normal[e].get(i))),
            pad: f32x8::splat(edges.pad.get(i)),
            nearest: f32x8::splat(edges.nearest.get(i)),
        };
        let reach = f32x8::new(self.packet_reach) + self.side_pad;
        one.met(&self.packets_about_middle) & one.nearest.le(reach).bits()
    }

    /// How rays see things.
    #[inline(always)]
    pub(super) fn view(&self) -> &View {
        &self.view
    }
}

impl Slopes {
    fn about(&self, [a, b]: [f32x8; 2]) -> Self {
        Self { a: [self.a[0] - a, self.a[1] - a], b: [self.b[0] - b, self.b[1] - b] }
    }
}

/// Edge functions of eight triangles: the ray of slopes `a` and `b` about the middle passes edge `i` on the side that the
/// sign of `normal[i] . (a, b, 1)` tells, if it is farther from zero than the pad.
///
/// Coordinates are sheared by the middle slopes, so that they are small for triangles that rays may meet, and so are
/// the errors of their products.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edges {
    normal: [Vec3<f32x8>; 3],
    pad: f32x8,
    /// Least `z`.
    nearest: f32x8,
}

impl Edges {
    #[inline(always)]
    fn of(corners: [Vec3<f32x8>; 3], middle: [f32x8; 2], spread: f32x8, pad: f32x8) -> Self {
        let shear = |p: Vec3<f32x8>| Vec3::new(p.x - middle[0] * p.z, p.y - middle[1] * p.z, p.z);
        let [a, b, c] = three(|v| shear(corners[v]));
        let size = a.abs().max(b.abs()).max(c.abs());
        let across = Lane::max(size.x, size.y) + spread * size.z;
        Self {
            normal: [fused_cross(b, c), fused_cross(c, a), fused_cross(a, b)],
            pad: pad * across,
            nearest: a.z.min(b.z).min(c.z),
        }
    }

    /// Lanes where not all rays pass on the outer side of one edge.
    #[inline(always)]
    fn met(&self, slopes: &Slopes) -> u32 {
        let ([n0, n1, n2], pad) = (self.normal, self.pad);
        let range = |n: Vec3<f32x8>| {
            let (a0, a1) = (slopes.a[0] * n.x, slopes.a[1] * n.x);
            let (b0, b1) = (slopes.b[0] * n.y, slopes.b[1] * n.y);
            (n.z + a0.min(a1) + b0.min(b1), n.z + a0.max(a1) + b0.max(b1))
        };
        let (r0, r1, r2, whole) = (range(n0), range(n1), range(n2), range(n0 + n1 + n2));
        // Seen by all from the front, or by all from the back: only then does a sign tell the side.
        let front = whole.0.gt(pad * f32x8::splat(4.0));
        let back = whole.1.lt(pad * f32x8::splat(-4.0));
        let least_of_greatest = r0.1.min(r1.1).min(r2.1);
        let greatest_of_least = r0.0.max(r1.0).max(r2.0);
        let missed = (front & least_of_greatest.lt(-pad)) | (back & greatest_of_least.gt(pad));
        (!missed).bits()
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

/// Slopes of directions, and their lengths along `z`. Lanes that are not asked take the slopes of one that is; without
/// any, zero.
#[inline(always)]
fn slopes(d: Vec3<f32x8>, asked: u32) -> Option<(f32x8, f32x8, f32x8)> {
    let most = d.z * f32x8::splat(MAX_SLOPE);
    let fits = d.z.gt(f32x8::ZERO) & d.x.abs().le(most) & d.y.abs().le(most);
    if asked & !fits.bits() != 0 {
        return None;
    }
    let scale = f32x8::ONE / d.z;
    let (a, b) = (d.x * scale, d.y * scale);
    if asked == 0xff {
        return Some((a, b, d.z));
    }
    let mask = Mask::from_bits(asked);
    let stand_in = |v: f32x8| if asked == 0 { 0.0 } else { v.get(asked.trailing_zeros() as usize) };
    let fill = |v: f32x8| Lane::select(mask, v, f32x8::splat(stand_in(v)));
    Some((fill(a), fill(b), Lane::select(mask, d.z, f32x8::ONE)))
}

#[inline(always)]
fn narrow<T: Tier>(v: Vec3<T::Wide>) -> Vec3<f32x8> {
    Vec3::new(T::nearest_f32(v.x), T::nearest_f32(v.y), T::nearest_f32(v.z))
}

/// Least and greatest of the lanes of row `j`, in lane `j`.
#[inline(always)]
fn range(rows: [f32x8; WIDTH]) -> [f32x8; 2] {
    let c = f32x8::transpose(rows);
    [fold(c, Lane::min), fold(c, Lane::max)]
}

#[inline(always)]
fn greatest(v: f32x8) -> f32 {
    fold(v.to_array(), |a, b| if a > b { a } else { b })
}

#[inline(always)]
fn least(v: f32x8) -> f32 {
    fold(v.to_array(), |a, b| if a < b { a } else { b })
}

/// Three rounds, not a chain of seven.
#[inline(always)]
fn fold<T: Copy>(v: [T; WIDTH], f: impl Fn(T, T) -> T) -> T {
    let [a, b, c, d] = [f(v[0], v[4]), f(v[1], v[5]), f(v[2], v[6]), f(v[3], v[7])];
    f(f(a, c), f(b, d))
}
