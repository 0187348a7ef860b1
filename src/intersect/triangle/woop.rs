//! The watertight triangle test.
//!
//! Plainly: look along the ray; it meets the triangle if it passes on the same side of all three edges. Departures:
//! - the view is a shear that maps the ray to an axis, so that a vertex is mapped to the same two numbers in every
//!   triangle that shares it, and the sign for a shared edge is the same from both sides (Woop, Benthin and Wald,
//!   Watertight Ray/Triangle Intersection, 2013). A ray on an edge counts for both triangles: no closed mesh leaks;
//! - no retry in `f64` where an edge function is zero: zero counts as inside;
//! - a hit must also lie in the triangle's own box ([`OwnBox`]): far from a triangle that is small for the precision,
//!   the edge functions alone round to nonsense;
//! - `t, u, v` of accepted lanes come from the plane in `f64`, because those of the sheared `f32` form lose up to 1% on
//!   short rays; `t` is confined to the own box;
//! - the point so found must be one of the triangle within rounding, else [`near`] finds the one that is.

use super::{Glimpse, near, plane_coordinates};
use crate::intersect::aabb::OwnBox;
use crate::intersect::{LaneHit, RayLanes, TriangleTest};
use crate::math::{Lane, Mask, Real, Vec3, WIDTH, Wide, eight, three};

/// See the module.
#[derive(Clone, Copy, Debug, Default)]
pub struct Woop;

/// How high above its plane a ray has to start for the triangle to be behind it for certain, beside the farthest corner and
/// the normal: thousands of roundoffs of `f64`.
const LEAST_HEIGHT: f64 = 1e-11;

/// The shear that maps a ray to an axis.
#[derive(Clone, Copy, Debug)]
pub struct Shear<L: Lane> {
    along_x: L::Mask,
    along_y: L::Mask,
    shared: Option<u8>,
    shear_x: L,
    shear_y: L,
    /// How much `t` grows along the axis; NaN where the own box may err on so short or long a direction.
    per_z: L,
}

impl<L: Lane> Shear<L> {
    fn new(ray: &RayLanes<L>) -> Self {
        let size = ray.direction.abs();
        let along_x = size.x.ge(size.y) & size.x.ge(size.z);
        let along_y = !along_x & size.y.ge(size.z);
        let shared = shared_axis::<L>(along_x, along_y);
        let (shear_x, shear_y, per_z) = (L::zero(), L::zero(), L::one());
        let mut s = Self { along_x, along_y, shared, shear_x, shear_y, per_z };
        let d = s.permute(ray.direction);
        (s.shear_x, s.shear_y) = (d.x / d.z, d.y / d.z);
        let per_z = L::one() / d.z;
        s.per_z = L::select(is_moderate(per_z), per_z, L::constant(f64::NAN));
        s
    }

    /// Turns the axes cyclically so that `z` is the one with the largest direction component.
    #[inline(always)]
    fn permute(&self, p: Vec3<L>) -> Vec3<L> {
        match self.shared {
            Some(0) => Vec3::new(p.y, p.z, p.x),
            Some(1) => Vec3::new(p.z, p.x, p.y),
            Some(_) => p,
            None => {
                let pick = |x, y, z| L::select(self.along_x, x, L::select(self.along_y, y, z));
                Vec3::new(pick(p.y, p.z, p.x), pick(p.z, p.x, p.y), pick(p.x, p.y, p.z))
            }
        }
    }

    /// The two coordinates across the ray of a point relative to the origin.
    #[inline(always)]
    fn across(&self, p: Vec3<L>) -> (L, L) {
        let [x, y, _] = self.sheared(p);
        (x, y)
    }

    /// The same, and the one along it.
    #[inline(always)]
    fn sheared(&self, p: Vec3<L>) -> [L; 3] {
        let p = self.permute(p);
        [p.x - self.shear_x * p.z, p.y - self.shear_y * p.z, p.z]
    }
}

/// True far from where quotients of directions overflow or underflow.
#[inline(always)]
fn is_moderate<L: Lane>(x: L) -> L::Mask {
    x.abs().ge(L::constant(1e-18)) & x.abs().le(L::constant(1e18))
}

/// The axis that all lanes share, which is the common case in a coherent packet and the only one of a single ray.
fn shared_axis<L: Lane>(along_x: L::Mask, along_y: L::Mask) -> Option<u8> {
    let all = L::Mask::splat(true).bits();
    match (along_x.bits(), along_y.bits()) {
        (x, _) if x == all => Some(0),
        (_, y) if y == all => Some(1),
        (0, 0) => Some(2),
        _ => None,
    }
}

impl TriangleTest for Woop {
    type Prepared<L: Lane> = Shear<L>;

    #[inline(always)]
    fn prepare<L: Lane>(ray: &RayLanes<L>) -> Shear<L> {
        Shear::new(ray)
    }

    #[inline(always)]
    fn may_hit<L: Lane>(ray: &RayLanes<L>, shear: &Shear<L>, v: [Vec3<L>; 3]) -> L::Mask {
        inside_edges(three(|k| shear.across(v[k] - ray.origin)))
    }

    #[inline(always)]
    fn hit<L: Lane>(
        lanes: L::Mask,
        ray: &RayLanes<L>,
        _: &Shear<L>,
        v: [Vec3<L>; 3],
        limit: L,
    ) -> LaneHit<L> {
        within_own_box(lanes, ray, v, limit)
    }

    const GLIMPSES: bool = true;

    #[inline(always)]
    fn glimpse<L: Lane>(ray: &RayLanes<L>, shear: &Shear<L>, v: [Vec3<L>; 3]) -> Option<Glimpse<L>> {
        let [a, b, c] = three(|k| v[k] - ray.origin);
        let reach = a.abs().max(b.abs()).max(c.abs()).max_component();
        Some(Glimpse::of([shear.sheared(a), shear.sheared(b), shear.sheared(c)], reach, shear.per_z))
    }

    /// The height above the plane in `f64`, which a ray's start has little of, and on which side the ray goes on. A height that
    /// rounding could make in what [`refine`] computes says nothing.
    #[inline(always)]
    fn is_left<L: Lane>(ray: &RayLanes<L>, seen: &Glimpse<L>, triangle: [[f32; 3]; 3]) -> L::Mask {
        let [a, b, c] = three(|v| Vec3::<f64>::splat(three(|k| f64::from(triangle[v][k]))));
        let normal = (b - a).cross(c - a);
        let size = normal.x.abs() + normal.y.abs() + normal.z.abs();
        let (zero, wide_zero) = (L::zero(), <L::Double as Lane>::zero());
        let (a, normal) = (a.get(0), normal.get(0));
        let height = (ray.origin.widen() - Vec3::splat(a)).dot(Vec3::splat(normal));
        let least = seen.reach.widen() * <L::Double as Lane>::splat(size * LEAST_HEIGHT);
        let rises = ray.direction.dot(Vec3::splat(three(|k| <L::Scalar as Real>::from_f64(normal[k]))));
        let above = L::narrow_mask(height.gt(least)) & rises.gt(zero);
        let below = L::narrow_mask(height.lt(wide_zero - least)) & rises.lt(zero);
        (above | below) & seen.is_steep & ray.t_min.ge(zero)
    }

    #[inline(always)]
    fn settle<L: Lane>(ray: &RayLanes<L>, v: [Vec3<L>; 3]) -> LaneHit<L> {
        let (t, u, v) = refine(ray, v);
        LaneHit { mask: L::Mask::splat(true), t: t + L::zero(), u, v }
    }

    type OneRay<R: Real> = OneShear<R>;

    #[inline(always)]
    fn each_of<L: Wide>(ray: &RayLanes<L>, shear: &Shear<L>) -> [OneShear<L::Scalar>; WIDTH] {
        let (o, none) = (shear.permute(ray.origin), L::zero());
        let rows = L::transpose([o.x, o.y, o.z, shear.shear_x, shear.shear_y, none, none, none]);
        let (along_x, along_y) = (shear.along_x.bits(), shear.along_y.bits());
        let axes = |i: usize| AXES[(along_x >> i & 1 | (along_y >> i & 1) << 1) as usize];
        eight(|i| OneShear { axes: axes(i), row: rows[i].to_lanes() })
    }

    #[inline(always)]
    fn candidates<L: Lane>(
        _: &RayLanes<L::Scalar>,
        shear: &OneShear<L::Scalar>,
        corners: &[[[f32; WIDTH]; 3]; 3],
    ) -> u32 {
        inside_edges(three(|k| shear.across::<L>(&corners[k]))).bits()
    }

    #[inline(always)]
    fn test_candidates<L: Lane>(ray: &RayLanes<L>, vertices: [Vec3<L>; 3], limit: L) -> LaneHit<L> {
        within_own_box(L::Mask::splat(true), ray, vertices, limit)
    }
}

/// [`Shear`] of one ray, with the axes as places in the columns of eight triangles: nothing to choose where rays of all
/// directions follow each other.
#[derive(Clone, Copy, Debug)]
pub struct OneShear<R> {
    /// Stored axes that stand for `x`, `y` and `z`.
    axes: [u8; 3],
    /// The origin by these axes, then the shear; the rest fills up.
    row: [R; WIDTH],
}

/// Stored axes that stand for `x`, `y` and `z`, where a ray goes mostly along `z`, `x` and `y`.
const AXES: [[u8; 3]; 4] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 1, 2]];

impl<R: Real> OneShear<R> {
    /// The two coordinates across the ray of eight corners.
    #[inline(always)]
    fn across<L: Lane<Scalar = R>>(&self, corner: &[[f32; WIDTH]; 3]) -> (L, L) {
        let [x, y, z] = three(|k| L::load_f32(&corner[usize::from(self.axes[k])]) - L::splat(self.row[k]));
        (x - L::splat(self.row[3]) * z, y - L::splat(self.row[4]) * z)
    }
}

/// Of the lanes that passed the edges, those that meet the triangle's own box, with where at the triangle.
#[inline(always)]
fn within_own_box<L: Lane>(mask: L::Mask, ray: &RayLanes<L>, v: [Vec3<L>; 3], limit: L) -> LaneHit<L> {
    // Most rays are asked so little that preparing this for each would cost more.
    let own = OwnBox::new(ray.origin, ray.direction);
    let (lo, hi) = (v[0].min(v[1]).min(v[2]), v[0].max(v[1]).max(v[2]));
    let (first, last) = own.interval(lo, hi);
    let mask = mask & first.le(last) & ray.t_min.le(last) & first.le(limit);
    if !mask.any() {
        return LaneHit::none();
    }
    let (t, at_u, at_v) = refine(ray, v);
    let mut hit = LaneHit { mask, t: t.clamp(first, last), u: at_u, v: at_v };
    let doubtful = mask & !near::at_glance(ray, v, &hit, own.magnitude(lo, hi));
    if doubtful.any() {
        hit = near::settle(ray, v, (first, last), hit, doubtful);
    }
    // A zero of either sign becomes the positive one: equal distances have equal bits.
    LaneHit { t: hit.t + L::zero(), ..hit }
}

/// Lanes whose rays pass on the same side of the three edges, or on one; from the corners' coordinates across the ray.
#[inline(always)]
fn inside_edges<L: Lane>([(ax, ay), (bx, by), (cx, cy)]: [(L, L); 3]) -> L::Mask {
    let e0 = cx * by - cy * bx;
    let e1 = ax * cy - ay * cx;
    let e2 = bx * ay - by * ax;
    same_side([e0, e1, e2])
}

/// Lanes in which edge functions have one sign, or are zero, but not all.
#[inline(always)]
pub(super) fn same_side<L: Lane>([e0, e1, e2]: [L; 3]) -> L::Mask {
    let zero = L::zero();
    let same_side = e0.min(e1).min(e2).ge(zero) | e0.max(e1).max(e2).le(zero);
    let det = (e0 + e1) + e2;
    // Written so that NaN (a padding lane, a vertex out of range) is a miss.
    same_side & (det.lt(zero) | det.gt(zero))
}

/// `t, u, v` in `f64`. The plane of a triangle seen nearly edge-on is met anywhere along the ray, so `t` is confined to
/// where the corners lie along it (NaN becomes the nearest), and what comes of it is held against the triangle.
#[inline(always)]
fn refine<L: Lane>(ray: &RayLanes<L>, v: [Vec3<L>; 3]) -> (L, L, L) {
    let (origin, direction, corners) = (ray.origin.widen(), ray.direction.widen(), three(|k| v[k].widen()));
    let (t, u, v) = plane_coordinates(origin, direction, corners);
    let scale = <L::Double as Lane>::one() / direction.length_squared();
    let [a, b, c] = three(|k| (corners[k] - origin).dot(direction) * scale);
    let t = t.clamp(a.min(b).min(c), a.max(b).max(c));
    let (zero, one) = (L::zero(), L::one());
    let u = L::narrow(u).clamp(zero, one);
    let v = L::narrow(v).clamp(zero, one - u);
    (L::narrow(t), u, v)
}
