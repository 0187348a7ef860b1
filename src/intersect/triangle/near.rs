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
