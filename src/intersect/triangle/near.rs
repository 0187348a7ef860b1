//! Every hit lies at its triangle: what a tree over parts of triangles rests on.
//!
//! The edge functions accept what passes the triangle within rounding. Yet the point where such a ray meets the plane may
//! be far from the triangle, for two reasons: the ray grazes the plane, so that a roundoff aside is a long way along; or
//! it runs in the plane within rounding, where the signs of the edge functions mean nothing. So `o + t d` is held against
//! the point of the triangle with the weights `u, v`. Where they are not the same within rounding, `t` becomes that of
//! the ray's closest approach to an edge, and a ray that comes near none has no hit.
//!
//! No closed mesh leaks by that. Of the triangles around the ray one holds it exactly as seen in the rounded sheared
//! coordinates, whose signs are never wrong, only 0. Each of these coordinates is off by at most 6 roundoffs of the largest
//! coordinate (1 for the difference to the origin, 3 for the product with the shear, 2 for the last difference), so the
//! ray passes that triangle at 6 roundoffs an axis across it, 8.5 in all, and has its hit: less than [`NEAR_ROUNDOFFS`].

use crate::intersect::{LaneHit, RayLanes};
use crate::math::{Lane, Mask, Real, Vec3};

/// Roundoffs of `f32` of the largest coordinate, by axis, that a hit may lie beside its triangle, in any number type: the
/// boxes of trees are widened for more than that in every tier.
pub(crate) const NEAR_ROUNDOFFS: f64 = 16.0;

/// As much is certain at a glance: comparing in `f32` costs up to 10 roundoffs more, and boxes are widened for the sum.
const GLANCE_ROUNDOFFS: f64 = 10.0;

/// Lanes whose point `o + t d` is at the point of the triangle with weights `u, v`, as far as a glance tells.
///
/// `magnitude` is the sum of the largest coordinates of origin and triangle.
#[inline(always)]
pub(super) fn at_glance<L: Lane>(
    ray: &RayLanes<L>,
    [a, b, c]: [Vec3<L>; 3],
    hit: &LaneHit<L>,
    magnitude: L,
) -> L::Mask {
    let on_ray = ray.origin + ray.direction * hit.t;
    let on_triangle = a * ((L::one() - hit.u) - hit.v) + b * hit.u + c * hit.v;
    within(on_ray - on_triangle, magnitude * L::constant(GLANCE_ROUNDOFFS * f32::ROUNDOFF))
}

/// True where no component is larger, or NaN.
#[inline(always)]
fn within<L: Lane>(apart: Vec3<L>, limit: L) -> L::Mask {
    let apart = apart.abs();
    apart.x.le(limit) & apart.y.le(limit) & apart.z.le(limit)
}

/// Brings the hits of doubtful lanes to their triangles, or drops them. `first` and `last` bound `t`.
#[cold]
#[inline(never)]
pub(super) fn settle<L: Lane>(
    ray: &RayLanes<L>,
    vertices: [Vec3<L>; 3],
    (first, last): (L, L),
    mut hit: LaneHit<L>,
    doubtful: L::Mask,
) -> LaneHit<L> {
    let bits = doubtful.bits();
    for i in (0..L::WIDTH).filter(|i| bits >> i & 1 != 0) {
        let lane = L::Mask::from_bits(1 << i);
        let corners = vertices.map(|v| Vec3::splat(v.get(i)));
        let scalar = Scalar { ray: ray.get(i), corners, first: first.get(i), last: last.get(i) };
        match scalar.settle([hit.t, hit.u, hit.v].map(|x| x.get(i))) {
            None => hit.mask = hit.mask & !lane,
            Some([t, u, v]) => {
                hit.t = L::select(lane, L::splat(t), hit.t);
                hit.u = L::select(lane, L::splat(u), hit.u);
                hit.v = L::select(lane, L::splat(v), hit.v);
            }
        }
    }
    hit
}

/// One ray and one triangle that it seems to hit.
struct Scalar<R> {
    ray: RayLanes<R>,
    corners: [Vec3<R>; 3],
    first: R,
    last: R,
}

impl<R: Real> Scalar<R> {
    /// The hit as it is if it lies at the triangle, else where the ray comes closest to an edge, if that is close.
    fn settle(&self, [t, u, v]: [R; 3]) -> Option<[R; 3]> {
        if self.roundoffs_apart(t, [u.to_f64(), v.to_f64()]) <= NEAR_ROUNDOFFS {
            return Some([t, u, v]);
        }
        let approaches = [self.approach(0), self.approach(1), self.approach(2)];
        let near = approaches.into_iter().filter(|(apart, _)| *apart <= NEAR_ROUNDOFFS);
        near.reduce(|a, b| if b.0 < a.0 { b } else { a }).map(|(_, hit)| hit)
    }

    /// The closest approach to edge `i`, from corner `i` to the next, and how close it is.
    fn approach(&self, i: usize) -> (f64, [R; 3]) {
        let corners = self.corners.map(Vec3::widen);
        let (o, d) = (self.ray.origin.widen(), self.ray.direction.widen());
        let (start, edge) = (corners[i] - o, corners[(i + 1) % 3] - corners[i]);
        let along = |p: Vec3<f64>| p.dot(d) / d.dot(d);
        let across = |p: Vec3<f64>| p - d * along(p);
        let (aside, slope) = (across(start), across(edge));
        // An edge along the ray is near everywhere or nowhere: its start will do (and NaN becomes 0).
        let share = Lane::clamp(-aside.dot(slope) / slope.dot(slope), 0.0, 1.0);
        let t = R::from_f64(along(start + edge * share)).clamp(self.first, self.last);
        let mut weights = [0.0; 3];
        (weights[i], weights[(i + 1) % 3]) = (1.0 - share, share);
        let [_, u, v] = weights;
        (self.roundoffs_apart(t, [u, v]), [t, R::from_f64(u), R::from_f64(v)])
    }

    /// How far, by axis and in roundoffs of the magnitude, `o + t d` is from the point of the triangle with weights `u, v`.
    fn roundoffs_apart(&self, t: R, [u, v]: [f64; 2]) -> f64 {
        let [a, b, c] = self.corners.map(Vec3::widen);
        let o = self.ray.origin.widen();
        let apart = o + self.ray.direction.widen() * t.to_f64() - (a * (1.0 - u - v) + b * u + c * v);
        let size = a.abs().max(b.abs()).max(c.abs()).max_component();
        let magnitude = o.abs().max_component() + size;
        let (apart, limit) = (apart.abs(), magnitude * f32::ROUNDOFF);
        // The sum is NaN if any is: such a point is nowhere near.
        let is_point = (apart.x + apart.y + apart.z).is_finite();
        if is_point { apart.max_component() / limit } else { f64::INFINITY }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::intersect::testing::dice::Dice;
    use crate::intersect::testing::line;

    /// What the sheared coordinates may be off by, see the module.
    const EDGE_ROUNDOFFS: f64 = 8.5;

    /// A triangle, and a ray that passes a point of its first edge within some roundoffs.
    fn beside_an_edge(dice: &mut Dice) -> Scalar<f32> {
        let scale = [1.0, 1e-3, 1e4][dice.below(3)];
        let far = dice.point().map(|x| x * scale * [0.0, 1.0, 30.0][dice.below(3)]);
        let mut point = || -> [f32; 3] {
            let p = dice.point();
            std::array::from_fn(|k| (far[k] + scale * p[k]) as f32)
        };
        let (corners, origin) = ([point(), point(), point()], point());
        let roundoff = magnitude(&corners, origin) * f32::ROUNDOFF;
        let (share, aside, by) = (dice.unit(), dice.heading(), dice.between(0.0, 10.0));
        let target = |k: usize| {
            let [a, b] = [corners[0], corners[1]].map(|p| f64::from(p[k]));
            a + share * (b - a) + aside[k] * by * roundoff
        };
        let direction = std::array::from_fn(|k| (target(k) - f64::from(origin[k])) as f32);
        let corners = corners.map(Vec3::splat);
        Scalar { ray: line(origin, direction), corners, first: f32::NEG_INFINITY, last: f32::INFINITY }
    }

    fn magnitude(corners: &[[f32; 3]; 3], origin: [f32; 3]) -> f64 {
        let largest = |p: &[f32; 3]| p.iter().fold(0.0, |most, x| x.abs().max(most));
        f64::from(largest(&origin)) + f64::from(corners.iter().map(largest).fold(0.0, f32::max))
    }

    /// How far the line passes from the first edge, in roundoffs.
    fn roundoffs_aside(s: &Scalar<f32>) -> f64 {
        let (o, d) = (s.ray.origin.widen(), s.ray.direction.widen());
        let across = |p: Vec3<f64>| p - d * (p.dot(d) / d.dot(d));
        let [a, b] = [0, 1].map(|i| across(s.corners[i].widen() - o));
        let edge = b - a;
        let nearest = a + edge * (-a.dot(edge) / edge.dot(edge)).clamp(0.0, 1.0);
        nearest.length() / (magnitude(&s.corners.map(|p| p.get(0)), s.ray.origin.get(0)) * f32::ROUNDOFF)
    }

    /// A hit whose `t` is far from the triangle, as that of a plane that the ray runs in, becomes one at the edge that the ray
    /// passes: dropping it would open a closed mesh.
    #[test]
    fn a_ray_beside_an_edge_keeps_its_hit_at_the_edge() {
        let mut dice = Dice(81);
        let (mut within, mut farthest) = (0, 0f64);
        for _ in 0..50_000 {
            let scalar = beside_an_edge(&mut dice);
            let aside = roundoffs_aside(&scalar);
            // Far along the ray, as the plane of a triangle seen edge-on may be met.
            let hit = scalar.settle([3.0, 0.25, 0.25]);
            if aside <= EDGE_ROUNDOFFS {
                within += 1;
                farthest = farthest.max(aside);
                assert!(
                    hit.is_some(),
                    "closed meshes leak: a hit {aside} roundoffs beside its edge is dropped, {EDGE_ROUNDOFFS} are promised: \
                     {:?} {:?}",
                    scalar.ray,
                    scalar.corners
                );
            }
        }
        assert!(within > 20_000 && farthest > 8.0, "{within} {farthest}");
    }
}
