//! The fast triangle test: `f32` decides what is clear, `f64` the rest.
//!
//! Plainly: solve `o + t d = v0 + u e1 + v e2` by Cramer's rule and ask `u, v >= 0`, `u + v <= 1`. Departures:
//! - what certainly misses is sorted out without a quotient: some volume has the other sign than the largest, and is not
//!   small beside it;
//! - what `f32` says of the others counts where no volume is small beside the largest, nor the determinant beside direction
//!   and edges, as it is for thin triangles and those seen edge-on: elsewhere cancellation leaves too few digits;
//! - numerator and determinant of `t` share the triangle's normal: what rounding turns it by moves `t` as if the ray met the
//!   turned plane, by no more than the triangle is large, however far away it is;
//! - in `f64` the third weight is a volume of its own over its own edge, not what the others leave of one: with two corners
//!   nearly the same, one minus the others has no digits;
//! - volumes that rounding could have made are no hit: the ray lies in the plane, where it meets an edge or nothing;
//! - `t` is confined to where the corners lie along the ray, since a plane seen nearly edge-on is met anywhere.
//!
//! A ray at an edge may still be lost between two triangles, since each rounds volumes of its own.
//!
//! **Source:** Moeller and Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997.

use crate::intersect::{LaneHit, RayLanes, TriangleTest};
use crate::math::{Lane, Mask, Real, Vec3, WIDTH, Wide, fused_cross, fused_dot, three};

/// See the module.
#[derive(Clone, Copy, Debug, Default)]
pub struct FilteredVolumes;

/// Of the largest volume, what another may have and be small: more than rounding makes of it up to a thousand times as far away
/// as the triangle is high, as the ray sees it.
const SMALL: f64 = 1.0 / 1024.0;

/// Least share, squared, that the determinant has of the product of direction and edges for `f32` to have digits enough.
const THIN2: f64 = 1.0 / 256.0;

/// What the determinant has to exceed in `f64`, as a share of the largest components of what it is made of: four times what
/// the roundings of its volumes may amount to, at most forty of each.
const NOISE: f64 = 640.0 * f64::ROUNDOFF;

impl TriangleTest for FilteredVolumes {
    /// The squared length of the direction, times that of a thin triangle.
    type Prepared<L: Lane> = L;

    #[inline(always)]
    fn prepare<L: Lane>(ray: &RayLanes<L>) -> L {
        fused_dot(ray.direction, ray.direction) * L::constant(THIN2)
    }

    #[inline(always)]
    fn may_hit<L: Lane>(ray: &RayLanes<L>, thin2: &L, v: [Vec3<L>; 3]) -> L::Mask {
        Volumes::new(ray, *thin2, v).may_hit()
    }

    #[inline(always)]
    fn hit<L: Lane>(lanes: L::Mask, ray: &RayLanes<L>, thin2: &L, v: [Vec3<L>; 3], _: L) -> LaneHit<L> {
        let volumes = Volumes::new(ray, *thin2, v);
        let hit = volumes.quotients(lanes);
        let doubtful = lanes & !volumes.are_clear();
        if doubtful.any() { decided(doubtful, ray, v, hit) } else { hit }
    }

    type OneRay<R: Real> = ();

    #[inline(always)]
    fn each_of<L: Wide>(_: &RayLanes<L>, _: &L) -> [(); WIDTH] {
        [(); WIDTH]
    }

    #[inline(always)]
    fn candidates<L: Lane>(ray: &RayLanes<L::Scalar>, _: &(), corners: &[[[f32; WIDTH]; 3]; 3]) -> u32 {
        let corners = three(|v| Vec3::<L>::load_f32(&corners[v]));
        Volumes::new(&RayLanes::splat(ray), L::zero(), corners).may_hit().bits()
    }

    #[inline(always)]
    fn test_candidates<L: Lane>(ray: &RayLanes<L>, vertices: [Vec3<L>; 3], limit: L) -> LaneHit<L> {
        Self::hit(L::Mask::splat(true), ray, &Self::prepare(ray), vertices, limit)
    }
}

/// The volumes that offset, direction and edges span.
struct Volumes<L> {
    det: L,
    u: L,
    v: L,
    /// `t` times the determinant.
    t: L,
    /// Squared determinant below which the triangle is thin, or seen nearly edge-on.
    thin2: L,
}

impl<L: Lane> Volumes<L> {
    #[inline(always)]
    fn new(ray: &RayLanes<L>, thin2: L, v: [Vec3<L>; 3]) -> Self {
        let (e1, e2, s) = (v[1] - v[0], v[2] - v[0], ray.origin - v[0]);
        let (normal, moment) = (fused_cross(e2, e1), fused_cross(ray.direction, s));
        Self {
            det: fused_dot(ray.direction, normal),
            u: fused_dot(-e2, moment),
            v: fused_dot(e1, moment),
            t: fused_dot(-s, normal),
            thin2: thin2 * (fused_dot(e1, e1) * fused_dot(e2, e2)),
        }
    }

    /// The least and the largest of the three that make the determinant: NaN if any is.
    #[inline(always)]
    fn range(&self) -> [L; 2] {
        let w = self.det - self.u - self.v;
        [self.u.min(self.v).min(w), self.u.max(self.v).max(w)]
    }

    #[inline(always)]
    fn may_hit(&self) -> L::Mask {
        let ([least, most], small, zero) = (self.range(), L::constant(SMALL), L::zero());
        most.mul_add_fast(small, least).ge(zero) | least.mul_add_fast(small, most).le(zero)
    }

    /// Lanes of [`Volumes::may_hit`] that `f32` alone is sure to hit, and whose `t` it knows.
    #[inline(always)]
    fn are_clear(&self) -> L::Mask {
        let ([least, most], small) = (self.range(), L::constant(SMALL));
        let zero = L::zero();
        let is_front = most.gt(zero) & least.gt(most * small);
        let is_back = least.lt(zero) & most.lt(least * small);
        (is_front | is_back) & (self.det * self.det).gt(self.thin2)
    }

    #[inline(always)]
    fn quotients(&self, mask: L::Mask) -> LaneHit<L> {
        let scale = L::one() / self.det;
        LaneHit { mask, t: self.t * scale, u: self.u * scale, v: self.v * scale }
    }
}

/// With some lanes as `f64` finds them.
#[inline(never)]
fn decided<L: Lane>(lanes: L::Mask, ray: &RayLanes<L>, v: [Vec3<L>; 3], hit: LaneHit<L>) -> LaneHit<L> {
    let wide = solve(&ray.widen(), three(|k| v[k].widen()));
    let pick = |wide: L::Double, kept: L| L::select(lanes, L::narrow(wide), kept);
    let (u, one) = (pick(wide.u, hit.u), L::one());
    let mask = hit.mask & (!lanes | L::narrow_mask(wide.mask));
    LaneHit { mask, t: pick(wide.t, hit.t), u, v: pick(wide.v, hit.v).min(one - u) }
}

/// Where rays meet triangles, in `f64`.
#[inline(always)]
fn solve<L: Lane>(ray: &RayLanes<L>, v: [Vec3<L>; 3]) -> LaneHit<L> {
    let d = ray.direction;
    let (e1, e2, s) = (v[1] - v[0], v[2] - v[0], ray.origin - v[0]);
    let q = fused_cross(s, e1);
    let (at_1, at_2) = (fused_dot(s, fused_cross(d, e2)), fused_dot(d, q));
    let at_0 = fused_dot(d, fused_cross(ray.origin - v[1], v[2] - v[1]));
    let (zero, det) = (L::zero(), (at_0 + at_1) + at_2);
    let same_side = at_0.min(at_1).min(at_2).ge(zero) | at_0.max(at_1).max(at_2).le(zero);
    let edge = e1.abs().max(e2.abs()).max_component();
    let size = d.abs().max_component() * edge * s.abs().max_component().max(edge);
    let scale = L::one() / det;
    let per_length = L::one() / fused_dot(d, d);
    let [a, b, c] = three(|k| fused_dot(v[k] - ray.origin, d) * per_length);
    let t = (fused_dot(e2, q) * scale).clamp(a.min(b).min(c), a.max(b).max(c));
    let mask = same_side & det.abs().gt(size * L::constant(NOISE));
    LaneHit { mask, t, u: at_1 * scale, v: at_2 * scale }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::intersect::testing::dice::Dice;
    use crate::intersect::testing::{exact, line, ray};

    type Case = (RayLanes<f32>, [Vec3<f32>; 3]);

    fn meet(r: &RayLanes<f32>, v: [Vec3<f32>; 3]) -> LaneHit<f32> {
        FilteredVolumes::test(r, &FilteredVolumes::prepare(r), v, f32::INFINITY)
    }

    /// A triangle, and a ray from up to a thousand times as far away as that is high, as the ray sees it, aimed beside an edge.
    fn beside_an_edge(dice: &mut Dice) -> Case {
        let corners: [[f64; 3]; 3] = std::array::from_fn(|_| dice.point());
        let (heading, edge) = (dice.heading(), dice.below(3));
        let [a, b, c] = three(|k| Vec3::<f64>::splat(corners[(edge + k) % 3]));
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        let height = (b - a).cross(c - a).dot(Vec3::splat(heading)).abs() / longest;
        let away = height * 10f64.powf(dice.between(0.0, 3.0));
        let on_edge = a + (b - a) * dice.unit();
        let target = (on_edge + (c - on_edge) * dice.magnitude(-7.0, -2.0)).get(0);
        let origin = std::array::from_fn(|k| (target[k] + away * heading[k]) as f32);
        let direction = std::array::from_fn(|k| (target[k] - f64::from(origin[k])) as f32);
        (ray(origin, direction), corners.map(|p| Vec3::splat(p.map(|x| x as f32))))
    }

    /// What `f32` decides alone is what `f64` says: `SMALL` leaves it only what rounding cannot have changed.
    #[test]
    fn f32_decides_as_f64_does_up_to_a_thousand_heights_away() {
        let mut dice = Dice(91);
        let (mut hits, mut misses) = (0, 0);
        for _ in 0..200_000 {
            let (r, v) = beside_an_edge(&mut dice);
            let (hit, wide) = (meet(&r, v), solve(&r.widen(), v.map(Vec3::widen)));
            assert_eq!(hit.mask, wide.mask, "f32 is trusted where it has no digits (SMALL): {r:?} {v:?}");
            hits += usize::from(hit.mask);
            misses += usize::from(!hit.mask);
        }
        assert!(hits > 10_000 && misses > 10_000, "{hits} {misses}");
    }

    /// In the plane of a triangle exactly, on a lattice so fine that volumes round: corners are sums of edges.
    fn in_plane(dice: &mut Dice) -> Case {
        let mut number = |bits: u32| (dice.word() >> (64 - bits)) as i64 - (1 << (bits - 1));
        let e: [[i64; 3]; 2] = std::array::from_fn(|_| std::array::from_fn(|_| number(19)));
        let corner: [i64; 3] = std::array::from_fn(|_| number(22));
        let [i, j, k, l] = std::array::from_fn(|_| number(4));
        let at = |a: i64, b: i64| std::array::from_fn(|x| (a * e[0][x] + b * e[1][x]) as f32);
        let from = |a: i64, b: i64| std::array::from_fn(|x| (corner[x] + a * e[0][x] + b * e[1][x]) as f32);
        let direction = if (k, l) == (0, 0) { at(1, 0) } else { at(k, l) };
        (line(from(i, j), direction), [from(0, 0), from(1, 0), from(0, 1)].map(Vec3::splat))
    }

    /// A ray that lies in the plane hits nothing, whatever signs rounding gives to volumes that are zero.
    #[test]
    fn volumes_that_rounding_made_are_no_hit() {
        let mut dice = Dice(92);
        let mut noisy = 0;
        for _ in 0..400_000 {
            let (r, v) = in_plane(&mut dice);
            let exact = exact::triangle(&r, v);
            assert_eq!(exact, None, "the ray lies in the plane: {r:?} {v:?}");
            let (wide, corners) = (r.widen(), v.map(Vec3::widen));
            let volume =
                fused_dot(wide.direction, fused_cross(corners[1] - wide.origin, corners[2] - wide.origin));
            noisy += usize::from(volume != 0.0);
            assert!(!meet(&r, v).mask, "a hit made of rounding alone (NOISE): {r:?} {v:?}");
        }
        assert!(noisy > 100_000, "{noisy}");
    }
}
