//! The fast triangle test: `f32` sorts out what certainly misses, `f64` decides the rest.
//!
//! Plainly: solve `o + t d = v0 + u e1 + v e2` by Cramer's rule and ask `u, v >= 0`, `u + v <= 1`. Departures:
//! - in `f32` nothing is divided, and the questions are asked with as much slack as their rounding needs, so that what is
//!   sorted out is missed;
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

/// Four times what that is in `f64`, as a share of it.
const NOISE: f64 = 4.0 * f64::ROUNDOFF / f32::ROUNDOFF;

impl TriangleTest for FilteredVolumes {
    /// The slack that a direction gives to volumes over edges and offsets of length 1.
    type Prepared<L: Lane> = L;

    #[inline(always)]
    fn prepare<L: Lane>(ray: &RayLanes<L>) -> L {
        ray.direction.abs().max_component() * L::constant(SLACK)
    }

    #[inline(always)]
    fn may_hit<L: Lane>(ray: &RayLanes<L>, slack: &L, v: [Vec3<L>; 3]) -> L::Mask {
        let (e1, e2, s) = (v[1] - v[0], v[2] - v[0], ray.origin - v[0]);
        let (p, q) = (fused_cross(ray.direction, e2), fused_cross(s, e1));
        let (det, u, v) = (fused_dot(e1, p), fused_dot(s, p), fused_dot(ray.direction, q));
        let is_back = det.lt(L::zero());
        let (u, v) = (L::select(is_back, -u, u), L::select(is_back, -v, v));
        let slack = *slack * reach([e1, e2], s);
        u.min(v).ge(-slack) & (u + v).le(det.abs() + slack)
    }

    #[inline(always)]
    fn hit<L: Lane>(lanes: L::Mask, ray: &RayLanes<L>, slack: &L, v: [Vec3<L>; 3], _: L) -> LaneHit<L> {
        let slack = *slack * reach([v[1] - v[0], v[2] - v[0]], ray.origin - v[0]);
        let hit = solve(&ray.widen(), three(|k| v[k].widen()), slack.widen() * <L::Double as Lane>::constant(NOISE));
        let (u, one) = (L::narrow(hit.u), L::one());
        LaneHit { mask: lanes & L::narrow_mask(hit.mask), t: L::narrow(hit.t), u, v: L::narrow(hit.v).min(one - u) }
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

/// The largest product of components of an edge with those of an edge or the offset.
#[inline(always)]
fn reach<L: Lane>(edges: [Vec3<L>; 2], offset: Vec3<L>) -> L {
    let edge = edges[0].abs().max(edges[1].abs()).max_component();
    edge * offset.abs().max_component().max(edge)
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
