//! The fast triangle test: `f32` decides what is clear, `f64` the rest.
//!
//! Plainly: solve `o + t d = v0 + u e1 + v e2` by Cramer's rule and ask `u, v >= 0`, `u + v <= 1`. Departures:
//! - what `f32` says counts where the ray passes the edges at more than what rounding may amount to, and the triangle is
//!   neither thin nor seen nearly edge-on; what certainly misses is sorted out without a quotient;
//! - in `f64` the third weight is a volume of its own over its own edge, not what the others leave of one: with two corners
//!   nearly the same, one minus the others has no digits;
//! - volumes that rounding could have made are no hit: the ray lies in the plane, where it meets an edge or nothing;
//! - `t` is confined to where the corners lie along the ray, since a plane seen nearly edge-on is met anywhere.
//!
//! A ray at an edge may still be lost between two triangles, since each rounds volumes of its own.
//!
//! **Source:** Moeller and Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997.

use crate::intersect::{LaneHit, RayLanes, TriangleTest};
use crate::math::{Lane, Mask, Real, Vec3, WIDTH, fused_cross, fused_dot, three};

/// See the module.
#[derive(Clone, Copy, Debug, Default)]
pub struct FilteredVolumes;

/// What a volume may be off by, as a share of the largest components of the three vectors it is made of: at most forty
/// roundings of each volume and of the sum of three, which also turns its sign.
const SLACK: f64 = 160.0 * f32::ROUNDOFF;

/// Of the largest volume, what another may have of the other sign and still be one to look at again.
const SHARE: f64 = 1.0 / 256.0;

/// Determinant over direction and square of the largest edge, by their largest components, from which on `f32` has digits
/// enough for `t`.
const THIN: f64 = 0.06;

/// Four times what the slack is in `f64`, as a share of it.
const NOISE: f64 = 4.0 * f64::ROUNDOFF / f32::ROUNDOFF;

impl TriangleTest for FilteredVolumes {
    /// The slack that a direction gives to volumes over edges and offsets of length 1.
    type Prepared<L: Lane> = L;

    #[inline(always)]
    fn prepare<L: Lane>(ray: &RayLanes<L>) -> L {
        ray.direction.abs().max_component() * L::constant(SLACK)
    }

    /// With slack that is a share of the volumes, which needs no sizes: more than rounding takes unless the triangle is a
    /// thousand times as long as it is wide.
    #[inline(always)]
    fn may_hit<L: Lane>(ray: &RayLanes<L>, _: &L, v: [Vec3<L>; 3]) -> L::Mask {
        let (e1, e2, s) = (v[1] - v[0], v[2] - v[0], ray.origin - v[0]);
        let p = fused_cross(ray.direction, e2);
        let (u, v) = (fused_dot(s, p), fused_dot(ray.direction, fused_cross(s, e1)));
        let w = fused_dot(e1, p) - u - v;
        // In this order a NaN of the last is what comes out.
        let (least, most, share) = (u.min(v).min(w), u.max(v).max(w), L::constant(SHARE));
        let zero = L::zero();
        most.mul_add_fast(share, least).ge(zero) | least.mul_add_fast(share, most).le(zero)
    }

    #[inline(always)]
    fn hit<L: Lane>(lanes: L::Mask, ray: &RayLanes<L>, slack: &L, v: [Vec3<L>; 3], _: L) -> LaneHit<L> {
        let volumes = Volumes::new(ray, v, *slack);
        let lanes = lanes & !volumes.surely_missed();
        let hit = volumes.quotients(lanes);
        let doubtful = lanes & !volumes.surely_hit();
        if doubtful.any() { decided(doubtful, ray, v, volumes.slack, hit) } else { hit }
    }

    type OneRay<R: Real> = R;

    #[inline(always)]
    fn prepare_one<R: Real>(ray: &RayLanes<R>) -> R {
        Self::prepare(ray)
    }

    #[inline(always)]
    fn one_of<L: Lane>(_: &RayLanes<L::Scalar>, slack: &L, i: usize) -> L::Scalar {
        slack.get(i)
    }

    #[inline(always)]
    fn candidates<L: Lane>(
        ray: &RayLanes<L::Scalar>,
        slack: &L::Scalar,
        corners: &[[[f32; WIDTH]; 3]; 3],
    ) -> u32 {
        let corners = three(|v| Vec3::<L>::load_f32(&corners[v]));
        Self::may_hit(&RayLanes::splat(ray), &L::splat(*slack), corners).bits()
    }

    #[inline(always)]
    fn test_candidates<L: Lane>(ray: &RayLanes<L>, vertices: [Vec3<L>; 3], limit: L) -> LaneHit<L> {
        Self::hit(L::Mask::splat(true), ray, &Self::prepare(ray), vertices, limit)
    }
}

/// The volumes that offset, direction and edges span, with the signs of a triangle seen from its front.
struct Volumes<L> {
    det: L,
    u: L,
    v: L,
    t: L,
    slack: L,
    /// The least determinant of a triangle that is neither thin nor seen nearly edge-on.
    least: L,
}

impl<L: Lane> Volumes<L> {
    #[inline(always)]
    fn new(ray: &RayLanes<L>, v: [Vec3<L>; 3], slack: L) -> Self {
        let (e1, e2, s) = (v[1] - v[0], v[2] - v[0], ray.origin - v[0]);
        let (p, q) = (fused_cross(ray.direction, e2), fused_cross(s, e1));
        let det = fused_dot(e1, p);
        let is_back = det.lt(L::zero());
        let front = |x: L| L::select(is_back, -x, x);
        let edge = e1.abs().max(e2.abs()).max_component();
        let slack = slack * edge;
        Self {
            det: det.abs(),
            u: front(fused_dot(s, p)),
            v: front(fused_dot(ray.direction, q)),
            t: front(fused_dot(e2, q)),
            slack: slack * s.abs().max_component().max(edge),
            least: slack * edge * L::constant(THIN / SLACK),
        }
    }

    #[inline(always)]
    fn surely_hit(&self) -> L::Mask {
        let inside = self.u.min(self.v).gt(self.slack) & (self.u + self.v + self.slack).lt(self.det);
        inside & self.det.gt(self.least)
    }

    #[inline(always)]
    fn surely_missed(&self) -> L::Mask {
        self.u.min(self.v).lt(-self.slack) | (self.u + self.v).gt(self.det + self.slack)
    }

    #[inline(always)]
    fn quotients(&self, mask: L::Mask) -> LaneHit<L> {
        let scale = L::one() / self.det;
        LaneHit { mask, t: self.t * scale, u: self.u * scale, v: self.v * scale }
    }
}

/// With some lanes as `f64` finds them.
#[inline(never)]
fn decided<L: Lane>(
    lanes: L::Mask,
    ray: &RayLanes<L>,
    v: [Vec3<L>; 3],
    slack: L,
    hit: LaneHit<L>,
) -> LaneHit<L> {
    let noise = slack.widen() * <L::Double as Lane>::constant(NOISE);
    let wide = solve(&ray.widen(), three(|k| v[k].widen()), noise);
    let pick = |wide: L::Double, kept: L| L::select(lanes, L::narrow(wide), kept);
    let (u, one) = (pick(wide.u, hit.u), L::one());
    let mask = hit.mask & (!lanes | L::narrow_mask(wide.mask));
    LaneHit { mask, t: pick(wide.t, hit.t), u, v: pick(wide.v, hit.v).min(one - u) }
}

/// Where rays meet triangles. `noise` is what volumes have to exceed together.
#[inline(always)]
fn solve<L: Lane>(ray: &RayLanes<L>, v: [Vec3<L>; 3], noise: L) -> LaneHit<L> {
    let d = ray.direction;
    let (e1, e2, s) = (v[1] - v[0], v[2] - v[0], ray.origin - v[0]);
    let q = fused_cross(s, e1);
    let (at_1, at_2) = (fused_dot(s, fused_cross(d, e2)), fused_dot(d, q));
    let at_0 = fused_dot(d, fused_cross(ray.origin - v[1], v[2] - v[1]));
    let (zero, det) = (L::zero(), (at_0 + at_1) + at_2);
    let same_side = at_0.min(at_1).min(at_2).ge(zero) | at_0.max(at_1).max(at_2).le(zero);
    let scale = L::one() / det;
    let per_length = L::one() / fused_dot(d, d);
    let [a, b, c] = three(|k| fused_dot(v[k] - ray.origin, d) * per_length);
    let t = (fused_dot(e2, q) * scale).clamp(a.min(b).min(c), a.max(b).max(c));
    LaneHit { mask: same_side & det.abs().gt(noise), t, u: at_1 * scale, v: at_2 * scale }
}
