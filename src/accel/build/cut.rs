//! Cutting a triangle in two by a plane across an axis: boxes of its parts.
//!
//! Why no tree over parts loses a hit, or finds another: a hit counts where `o + t d` lies within 20 roundoffs of the largest
//! coordinates of some point of the triangle (`intersect::triangle::near`: 16, or 10 as a glance of 10 roundoffs tells).
//! That point is in a part, so in the box of the part and in every box above. [`crate::intersect::aabb::CullRay`] widens
//! boxes by the 24 roundoffs of [`crate::intersect::aabb::OwnBox`], of which its own slab takes 4, and by what the two
//! slabs may differ: so `t` itself is in the interval of each of these boxes, and a ray that still looks for hits up to
//! `t` gets to the triangle. Whether it gets there once or more often changes nothing: an equal hit does not replace one.
//!
//! **Accuracy:** the boxes hold the parts: points on the plane are widened by more than their roundings, and an edge too
//! short to place a point on counts whole.

use wide::f32x4;

use super::box8::Box8;
use crate::math::gamma;

/// What can be cut for spatial splits.
pub trait Cuttable: Sync {
    /// The corners of a primitive if it is a triangle; nothing else is cut.
    fn corners(&self, primitive: u32) -> Option<[[f32; 3]; 3]>;
    /// True if it is one.
    fn is_cuttable(&self, primitive: u32) -> bool {
        self.corners(primitive).is_some()
    }
}

/// Nothing is cut.
#[derive(Clone, Copy, Debug, Default)]
pub struct Uncut;

impl Cuttable for Uncut {
    fn corners(&self, _: u32) -> Option<[[f32; 3]; 3]> {
        None
    }
}

/// A point on an edge is off by at most 12 roundoffs of the edge's largest coordinates: 3 for its share of the edge on
/// either end, 1 for the other share, 1 for each product, 1 for the sum.
const POINT_ERROR: f32 = gamma(16);

/// Shares of shorter edges are no numbers to trust: the span may have lost digits to underflow.
const LEAST_SPAN: f32 = f32::MIN_POSITIVE / f32::EPSILON;

/// A triangle as planes across one axis meet it: corners in the order in which they do.
#[derive(Clone, Copy)]
pub(super) struct Sweep {
    corners: [f32x4; 3],
    place: [f32; 3],
    axis: usize,
}

impl Sweep {
    #[inline]
    pub(super) fn new(corners: [[f32; 3]; 3], axis: usize) -> Self {
        let [mut a, mut b, mut c] = corners;
        if b[axis] < a[axis] {
            (a, b) = (b, a);
        }
        if c[axis] < b[axis] {
            (b, c) = (c, b);
        }
        if b[axis] < a[axis] {
            (a, b) = (b, a);
        }
        let corners = [a, b, c].map(|[x, y, z]| f32x4::new([x, y, z, 0.0]));
        Self { corners, place: [a[axis], b[axis], c[axis]], axis }
    }

    /// A box around where the plane at `at` meets the triangle; planes beyond its ends count as at its ends.
    #[inline(always)]
    pub(super) fn section(&self, at: f32) -> Box8 {
        let ([a, b, c], [first, second, third]) = (self.corners, self.place);
        let at = at.max(first).min(third);
        let other = if at < second {
            crossing([a, b], [first, second], at)
        } else {
            crossing([b, c], [second, third], at)
        };
        crossing([a, c], [first, third], at).join(other)
    }

    /// A box around what is between two planes, given the sections there.
    #[inline(always)]
    pub(super) fn between(&self, [from, to]: [f32; 2], [start, end]: [Box8; 2]) -> Box8 {
        let ends = start.join(end);
        let [_, corner, _] = self.corners;
        let inside = from <= self.place[1] && self.place[1] <= to;
        if inside { ends.join(Box8::new(corner, corner)) } else { ends }
    }

    /// Boxes of what lies in the box `part` up to the plane at `at`, and from there on; either may be empty.
    ///
    /// **Source:** Stich, Friedrich and Dietrich, "Spatial Splits in Bounding Volume Hierarchies", 2009, section 4.
    pub(super) fn cut(&self, part: Box8, at: f32) -> [Box8; 2] {
        let ([first, _, third], section) = (self.place, self.section(at));
        let low = self.between([first, at], [self.section(first), section]);
        let high = self.between([at, third], [section, self.section(third)]);
        let (below, above) = part.parted(self.axis, at);
        [low.intersection(below), high.intersection(above)]
    }
}

/// A box around the point where an edge crosses the plane at `at`.
#[inline(always)]
fn crossing([a, b]: [f32x4; 2], [from, to]: [f32; 2], at: f32) -> Box8 {
    let whole = Box8::new(a.fast_min(b), a.fast_max(b));
    // Halved, so that no difference overflows.
    let span = 0.5 * to - 0.5 * from;
    if span < LEAST_SPAN {
        return whole;
    }
    let share = f32x4::splat((0.5 * at - 0.5 * from) / span);
    let point = a * (f32x4::ONE - share) + b * share;
    let pad = a.abs().fast_max(b.abs()) * f32x4::splat(POINT_ERROR);
    Box8::new(point - pad, point + pad).intersection(whole)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::intersect::testing::dice::Dice;
    use crate::math::Aabb;

    fn box_of(corners: [[f32; 3]; 3]) -> Box8 {
        Box8::of(&corners.into_iter().fold(Aabb::EMPTY, Aabb::join_point))
    }

    #[test]
    fn a_right_triangle_is_cut_where_it_should_be() {
        let corners = [[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [0.0, 4.0, 1.0]];
        let [low, high] = Sweep::new(corners, 0).cut(box_of(corners), 1.0).map(Box8::to_aabb);
        assert_eq!((low.min, low.max), ([0.0, 0.0, 1.0], [1.0, 4.0, 1.0]));
        assert_eq!((high.min, high.max[0]), ([1.0, 0.0, 1.0], 4.0));
        assert!((3.0..3.00001).contains(&high.max[1]), "{high:?}");
    }

    #[test]
    fn a_plane_beside_leaves_one_side_empty() {
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 1.0]];
        let [low, high] = Sweep::new(corners, 1).cut(box_of(corners), 2.0).map(Box8::to_aabb);
        assert!(low == box_of(corners).to_aabb() && high.is_empty());
    }

    /// Any point of the triangle is in one of the parts, however often it is cut.
    #[test]
    fn the_parts_cover_the_triangle() {
        let mut dice = Dice(31);
        for round in 0..4_000 {
            let scale = [1.0, 1e-30, 1e30, 1e-42][round % 4];
            let thin = [1.0, 1e-6][dice.below(2)];
            let a = dice.point();
            let corners: [[f64; 3]; 3] = std::array::from_fn(|i| {
                let p = dice.point();
                std::array::from_fn(|k| scale * if i == 2 { a[k] + thin * p[k] } else { p[k] + a[k] })
            });
            let corners = corners.map(|p| p.map(|x| x as f32));
            let mut parts = vec![box_of(corners)];
            for _ in 0..4 {
                let axis = dice.below(3);
                let cut = |part: &Box8| {
                    let b = part.to_aabb();
                    let at = b.min[axis] + dice.unit() as f32 * (b.max[axis] - b.min[axis]);
                    Sweep::new(corners, axis).cut(*part, at)
                };
                parts = parts.iter().flat_map(cut).filter(|part| !part.to_aabb().is_empty()).collect();
            }
            for _ in 0..50 {
                let (u, v) = (dice.unit(), dice.unit());
                let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
                let at = |k: usize, i: usize| f64::from(corners[i][k]);
                let point: [f64; 3] =
                    std::array::from_fn(|k| (1.0 - u - v) * at(k, 0) + u * at(k, 1) + v * at(k, 2));
                let holds = |part: &Box8| {
                    let b = part.to_aabb();
                    (0..3).all(|k| {
                        let slack = 1e-15 * f64::from(b.max[k].abs().max(b.min[k].abs()));
                        f64::from(b.min[k]) - slack <= point[k] && point[k] <= f64::from(b.max[k]) + slack
                    })
                };
                assert!(parts.iter().any(holds), "{point:?} of {corners:?} is in none of {parts:?}");
            }
        }
    }
}
