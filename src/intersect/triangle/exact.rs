//! The exact triangle test.
//!
//! Plainly: the ray meets the triangle if the tetrahedra that its direction spans with the three edges have volumes of one
//! sign, zeros counting for either; `t` is a quotient of two more volumes. Departures:
//! - `f64` decides where the volumes are larger than a bound on their rounding error; the other lanes, few but on the edges
//!   of meshes, are decided one by one with sums of two `f64`, and where those are in doubt too with expansions, which do
//!   not round (Shewchuk 1997);
//! - so are `t`, `u` and `v` where their quotients would cancel;
//! - a hit must lie in the triangle's own box ([`OwnBox`]), as in the watertight test. No exact hit is lost by that: it
//!   confines what is left of rounding to what every tree box holds.

use crate::intersect::aabb::OwnBox;
use crate::intersect::{LaneHit, RayLanes, TriangleTest};
use crate::math::{
    Lane, Mask, Pair, Real, Vec3, WIDTH, Wide, determinant, determinant_sign, gamma_of, three, two_sum,
};

/// See the module.
#[derive(Clone, Copy, Debug, Default)]
pub struct ExactVolumes;

/// Roundings in a volume of differences: 2 of the differences, 1 of each product, 1 of each sum; and as many again.
const ROUNDINGS: u32 = 16;

/// Quotients of volumes below this share of the product of their sides have lost more than 31 of 53 bits.
const LEAST_SHARE: f64 = 1.0 / 131_072.0;

impl TriangleTest for ExactVolumes {
    type Prepared<L: Lane> = OwnBox<L>;

    #[inline(always)]
    fn prepare<L: Lane>(ray: &RayLanes<L>) -> OwnBox<L> {
        OwnBox::new(ray.origin, ray.direction)
    }

    #[inline(always)]
    fn may_hit<L: Lane>(ray: &RayLanes<L>, _: &OwnBox<L>, v: [Vec3<L>; 3]) -> L::Mask {
        let sides = Sides::of(&ray.widen(), three(|k| v[k].widen()));
        let mut mask = L::narrow_mask(sides.inside);
        let doubtful = L::narrow_mask(sides.doubtful).bits();
        if doubtful != 0 {
            mask = mask | L::Mask::from_bits(inside_exactly(doubtful, ray, v));
        }
        mask
    }

    #[inline(always)]
    fn hit<L: Lane>(
        lanes: L::Mask,
        ray: &RayLanes<L>,
        own: &OwnBox<L>,
        v: [Vec3<L>; 3],
        limit: L,
    ) -> LaneHit<L> {
        let (lo, hi) = (v[0].min(v[1]).min(v[2]), v[0].max(v[1]).max(v[2]));
        let (first, last) = own.interval(lo, hi);
        let mask = lanes & first.le(last) & ray.t_min.le(last) & first.le(limit);
        if !mask.any() {
            return LaneHit::none();
        }
        let (mask, t, u, v) = coordinates(mask, ray, first, v);
        // A zero of either sign becomes the positive one: equal distances have equal bits.
        LaneHit { mask, t: t.clamp(first, last) + L::zero(), u, v }
    }

    type OneRay<R: Real> = ();

    #[inline(always)]
    fn each_of<L: Wide>(_: &RayLanes<L>, _: &OwnBox<L>) -> [(); WIDTH] {
        [(); WIDTH]
    }

    #[inline(always)]
    fn candidates<L: Lane>(ray: &RayLanes<L::Scalar>, (): &(), corners: &[[[f32; WIDTH]; 3]; 3]) -> u32 {
        let corners = three(|v| Vec3::<L>::load_f32(&corners[v]).widen());
        let sides = Sides::of(&RayLanes::<L>::splat(ray).widen(), corners);
        (sides.inside | sides.doubtful).bits()
    }

    #[inline(always)]
    fn test_candidates<L: Lane>(ray: &RayLanes<L>, v: [Vec3<L>; 3], limit: L) -> LaneHit<L> {
        Self::test(ray, &Self::prepare(ray), v, limit)
    }
}

/// On which sides of the edges rays pass: certainly inside of all, or not certainly outside of any.
struct Sides<D: Lane> {
    inside: D::Mask,
    doubtful: D::Mask,
}

impl<D: Lane<Scalar = f64>> Sides<D> {
    #[inline(always)]
    fn of(ray: &RayLanes<D>, v: [Vec3<D>; 3]) -> Self {
        let d = ray.direction;
        let [a, b, c] = three(|k| v[k] - ray.origin);
        let error = size(d) * D::constant(gamma_of(ROUNDINGS, f64::ROUNDOFF));
        let (around_b, sizes) = (d.cross(b), [size(a), size(b), size(c)]);
        let volumes = [around_b.dot(c), d.dot(c.cross(a)), -around_b.dot(a)];
        let errors = [sizes[1] * sizes[2] * error, sizes[2] * sizes[0] * error, sizes[0] * sizes[1] * error];
        let [(p0, n0), (p1, n1), (p2, n2)] = three(|k| (volumes[k].gt(errors[k]), volumes[k].lt(-errors[k])));
        let inside = (p0 & p1 & p2) | (n0 & n1 & n2);
        let outside = (p0 | p1 | p2) & (n0 | n1 | n2);
        // Padding is NaN, which no doubt is about.
        let finite = (volumes[0] + volumes[1] + volumes[2]).is_finite();
        Self { inside, doubtful: !(inside | outside) & finite }
    }
}

/// The sum of magnitudes: the product of three is at least that of all terms of their determinant.
#[inline(always)]
fn size<D: Lane>(v: Vec3<D>) -> D {
    v.x.abs() + v.y.abs() + v.z.abs()
}

/// Of the lanes given as bits, those that are inside.
#[cold]
fn inside_exactly<L: Lane>(lanes: u32, ray: &RayLanes<L>, v: [Vec3<L>; 3]) -> u32 {
    let inside = |i: usize| Lane1::of(i, ray, v).weights().is_inside();
    (0..L::WIDTH).filter(|i| lanes >> i & 1 != 0 && inside(*i)).map(|i| 1 << i).sum()
}

/// `t, u, v` of the lanes of the mask, and which of them may be in front of the ray, counting from `first` on.
#[inline(always)]
fn coordinates<L: Lane>(mask: L::Mask, ray: &RayLanes<L>, first: L, v: [Vec3<L>; 3]) -> (L::Mask, L, L, L) {
    let corners = three(|k| v[k].widen());
    let (d, s) = (ray.direction.widen(), ray.origin.widen() - corners[0]);
    let (e1, e2) = (corners[1] - corners[0], corners[2] - corners[0]);
    let (p, q) = (d.cross(e2), s.cross(e1));
    let (slope, height) = (e1.dot(p), e2.dot(q));
    let least = size(e1) * size(e2) * Lane::constant(LEAST_SHARE);
    let steep = slope.abs().gt(least * size(d));
    let good = steep & height.abs().gt(least * size(s));
    let scale = <L::Double as Lane>::one() / slope;
    let mut found = [height * scale, s.dot(p) * scale, d.dot(q) * scale].map(L::narrow);
    let mut mask = mask;
    let unsure = mask & !L::narrow_mask(good);
    if unsure.any() {
        let leaves = unsure & L::narrow_mask(steep & is_behind(slope, s, e1, e2));
        mask = mask & !(leaves & first.max(L::zero()).le(ray.t_min));
        let bad = (mask & unsure).bits();
        if bad != 0 {
            mask = mask & !L::Mask::from_bits(coordinates_exactly(bad, ray, first, v, &mut found));
        }
    }
    let (zero, one) = (L::zero(), L::one());
    let u = found[1].clamp(zero, one);
    (mask, found[0], u, found[2].clamp(zero, one - u))
}

/// Where rays that are not parallel to the plane certainly start beyond it: those that leave a triangle. The bound is that
/// of the terms themselves, so that planes across an axis are told apart to the last bit.
#[inline(always)]
fn is_behind<D: Lane<Scalar = f64>>(slope: D, s: Vec3<D>, e1: Vec3<D>, e2: Vec3<D>) -> D::Mask {
    let (a, b) = (e1.abs(), e2.abs());
    let sizes = Vec3::new(a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x);
    let height = s.dot(e1.cross(e2));
    let error = s.abs().dot(sizes) * D::constant(gamma_of(ROUNDINGS, f64::ROUNDOFF));
    height.with_sign_of(slope * height).lt(-error)
}

/// Replaces the lanes given as bits; gives those of them that are not in front of the ray, counting from `first` on.
#[cold]
fn coordinates_exactly<L: Lane>(
    lanes: u32,
    ray: &RayLanes<L>,
    first: L,
    v: [Vec3<L>; 3],
    found: &mut [L; 3],
) -> u32 {
    let mut behind = 0;
    for i in (0..L::WIDTH).filter(|i| lanes >> i & 1 != 0) {
        let lane = L::Mask::from_bits(1 << i);
        let (first, t_min) = (first.get(i).to_f64(), ray.t_min.get(i).to_f64());
        let Some(exact) = Lane1::of(i, ray, v).coordinates(|t| t.max(first) > t_min) else {
            behind |= 1 << i;
            continue;
        };
        for (found, exact) in found.iter_mut().zip(exact) {
            *found = L::select(lane, L::constant(exact), *found);
        }
    }
    behind
}

/// One ray and one triangle.
struct Lane1 {
    origin: [f64; 3],
    direction: [f64; 3],
    corners: [[f64; 3]; 3],
}

impl Lane1 {
    fn of<L: Lane>(i: usize, ray: &RayLanes<L>, v: [Vec3<L>; 3]) -> Self {
        let exactly = |v: Vec3<L>| v.get(i).map(Real::to_f64);
        Self { origin: exactly(ray.origin), direction: exactly(ray.direction), corners: v.map(exactly) }
    }

    fn weights(&self) -> Weights {
        let [a, b, c] = self.corners.map(|corner| difference(corner, self.origin));
        let d = self.direction.map(|x| [x, 0.0]);
        Weights([(&b, &c), (&c, &a), (&a, &b)].map(|(p, q)| determinant(&d, p, q)))
    }

    /// `t, u, v`, if `t` is in front.
    fn coordinates(&self, is_in_front: impl Fn(f64) -> bool) -> Option<[f64; 3]> {
        let [v0, v1, v2] = self.corners;
        let (e1, e2) = (difference(v1, v0), difference(v2, v0));
        let slope = determinant(&self.direction.map(|x| [x, 0.0]), &e1, &e2);
        let from = difference(v0, self.origin);
        if slope * determinant_sign(&from, &e1, &e2) < 0.0 && !is_in_front(0.0) {
            return None;
        }
        let height = determinant(&from, &e1, &e2);
        if !is_in_front(height / slope) {
            return None;
        }
        let Weights([_, u, v]) = self.weights();
        Some([height / slope, u / slope, v / slope])
    }
}

/// Volumes of direction and edge, which are the weights of the opposite corners.
struct Weights([f64; 3]);

impl Weights {
    /// All of one sign or zero, but not all zero, as they are for a triangle seen edge-on.
    fn is_inside(&self) -> bool {
        let (low, high) = self.0.iter().fold((0.0f64, 0.0f64), |(low, high), &x| (low.min(x), high.max(x)));
        (low == 0.0) != (high == 0.0)
    }
}

fn difference(a: [f64; 3], b: [f64; 3]) -> [Pair; 3] {
    three(|k| two_sum(a[k], -b[k]))
}
