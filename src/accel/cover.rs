//! Whether boxes cover a triangle: what must hold of the leaves that its parts are in.

use crate::math::Aabb;

/// What rounding may leave uncovered, as a share of the largest coordinate: far below what boxes are widened by when a ray
/// meets them.
const SLACK: f64 = 1e-12;

type Point = [f64; 3];

/// True if every point of the triangle is in one of the boxes.
pub(super) fn covers(boxes: &[Aabb], corners: [[f32; 3]; 3]) -> bool {
    let corners = corners.map(|corner| corner.map(f64::from));
    let slack = SLACK * corners.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
    covers_polygon(boxes, &corners, slack)
}

/// A convex polygon is covered if one box holds its corners, or if both parts on either side of some face are covered.
/// Ends because no part reaches across a face that cut it.
fn covers_polygon(boxes: &[Aabb], polygon: &[Point], slack: f64) -> bool {
    let holds = |b: &Aabb| {
        let inside =
            |p: &Point, k: usize| f64::from(b.min[k]) - slack <= p[k] && p[k] <= f64::from(b.max[k]) + slack;
        polygon.iter().all(|p| (0..3).all(|k| inside(p, k)))
    };
    if boxes.iter().any(holds) {
        return true;
    }
    let faces = boxes.iter().flat_map(|b| (0..3).flat_map(move |k| [(k, b.min[k]), (k, b.max[k])]));
    let crosses = |&(k, at): &(usize, f32)| {
        let beyond = |sign: f64| polygon.iter().any(|p| sign * (p[k] - f64::from(at)) > slack);
        beyond(1.0) && beyond(-1.0)
    };
    let Some((k, at)) = faces.into_iter().find(crosses) else { return false };
    let side = |sign: f64| covers_polygon(boxes, &clip(polygon, k, f64::from(at), sign), slack);
    side(1.0) && side(-1.0)
}

/// The part of a convex polygon on one side of a plane across axis `k`.
///
/// **Source:** Sutherland and Hodgman, "Reentrant Polygon Clipping", 1974.
fn clip(polygon: &[Point], k: usize, at: f64, sign: f64) -> Vec<Point> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, a) in polygon.iter().enumerate() {
        let b = &polygon[(i + 1) % polygon.len()];
        let (from, to) = (sign * (a[k] - at), sign * (b[k] - at));
        if from >= 0.0 {
            kept.push(*a);
        }
        if (from < 0.0) != (to < 0.0) && from != to {
            let share = from / (from - to);
            kept.push(std::array::from_fn(|k| a[k] + share * (b[k] - a[k])));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

    fn flat(min: [f32; 2], max: [f32; 2]) -> Aabb {
        Aabb { min: [min[0], min[1], 0.0], max: [max[0], max[1], 0.0] }
    }

    #[test]
    fn the_box_of_the_triangle_and_its_clipped_halves_cover() {
        assert!(covers(&[flat([0.0; 2], [4.0; 2])], TRIANGLE));
        assert!(covers(&[flat([0.0; 2], [1.0, 4.0]), flat([1.0, 0.0], [4.0, 3.0])], TRIANGLE));
    }

    #[test]
    fn a_gap_in_the_middle_or_at_a_corner_is_found() {
        assert!(!covers(&[], TRIANGLE));
        assert!(!covers(&[flat([0.0; 2], [1.0, 4.0]), flat([1.1, 0.0], [4.0, 3.0])], TRIANGLE));
        assert!(!covers(&[flat([0.0; 2], [1.0, 4.0]), flat([1.0, 0.0], [4.0, 2.9])], TRIANGLE));
        assert!(!covers(&[flat([0.0; 2], [4.0, 3.9])], TRIANGLE));
    }
}
