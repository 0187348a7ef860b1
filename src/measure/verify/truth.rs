//! What is true of a ray, without rounding, and what a few roundoffs of the input could make of it.

use super::trial::{Claim, Shape, Trial};
use crate::intersect::Ray;
use crate::intersect::oracle::{self, Line, surfaces};
use crate::math::Vec3;

/// Roundoffs by which an input may be off for an error to count as small.
pub const EXCUSED_ROUNDOFFS: f64 = 16.0;

/// A ray, and every `t` at which its line meets a surface.
pub(super) struct Truth {
    pub(super) ray: Ray,
    line: Line,
    /// Ascending.
    surfaces: Vec<f64>,
}

/// Where an answer may lie for a slightly different input.
struct Band {
    first: f64,
    last: f64,
    /// Every such input has a surface there.
    certain: bool,
}

impl Truth {
    pub(super) fn of(ray: &Ray, shapes: &[oracle::Shape]) -> Self {
        let line = Line::of(ray);
        let met = shapes.iter().filter(|shape| may_meet(&line, shape));
        let mut surfaces: Vec<f64> = met.flat_map(|shape| surfaces(&line, shape)).flatten().collect();
        surfaces.sort_by(f64::total_cmp);
        Self { ray: *ray, line, surfaces }
    }

    /// The nearest `t` that counts, where `t` is compared with the bounds after `round`.
    pub(super) fn nearest(&self, round: fn(f64) -> f64) -> Option<f64> {
        let (t_min, t_max) = (f64::from(self.ray.t_min), f64::from(self.ray.t_max));
        self.surfaces.iter().copied().find(|&t| round(t) > t_min && round(t) < t_max)
    }

    /// First and last surface of a convex whole that lies ahead.
    pub(super) fn chord(&self) -> Option<[f64; 2]> {
        let (first, last) = (*self.surfaces.first()?, *self.surfaces.last()?);
        (first > 0.0).then_some([first, last])
    }

    /// Whether the ray meets the box between its bounds.
    pub(super) fn meets_box(&self) -> bool {
        let (t_min, t_max) = (f64::from(self.ray.t_min), f64::from(self.ray.t_max));
        matches!(self.surfaces[..], [first, last] if last >= t_min && first <= t_max)
    }

    /// Whether no change of the input by some roundoffs excuses an answer: that it misses what is certainly there, or
    /// hits where nothing can be.
    pub(super) fn is_gross(&self, trial: &Trial, answer: Option<f64>, roundoff: f64) -> [bool; 2] {
        let bands: Vec<Band> = trial.shapes.iter().flat_map(|shape| self.bands(shape, roundoff)).collect();
        let (t_min, t_max) = (f64::from(self.ray.t_min), f64::from(self.ray.t_max));
        let until = answer.unwrap_or(t_max);
        let missed = bands.iter().any(|b| b.certain && b.first > t_min && b.last < until.min(t_max));
        let made = answer.is_some_and(|t| !bands.iter().any(|b| b.first <= t && t <= b.last));
        [missed, made]
    }

    fn bands(&self, shape: &Shape, roundoff: f64) -> Vec<Band> {
        let exact = shape.exact();
        let origin = self.line.origin.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let slack = EXCUSED_ROUNDOFFS * roundoff * (origin + exact.magnitude());
        let mut bands = match exact {
            oracle::Shape::Triangle(corners) => triangle_band(&self.line, corners, slack),
            _ => shell_bands(&self.line, &exact, slack),
        };
        for band in &mut bands {
            band.first -= 4.0 * roundoff * band.first.abs();
            band.last += 4.0 * roundoff * band.last.abs();
        }
        bands
    }
}

/// Between the shape with its surface moved inwards and outwards.
fn shell_bands(line: &Line, shape: &oracle::Shape, slack: f64) -> Vec<Band> {
    let ends = |shape: Option<oracle::Shape>| match shape.map(|shape| surfaces(line, &shape)) {
        Some([Some(first), Some(last)]) => Some([first, last]),
        _ => None,
    };
    let Some([enter, leave]) = ends(shape.grown(slack)) else { return Vec::new() };
    match ends(shape.grown(-slack)) {
        Some([inner, outer]) => vec![
            Band { first: enter, last: inner, certain: true },
            Band { first: outer, last: leave, certain: true },
        ],
        None => vec![Band { first: enter, last: leave, certain: false }],
    }
}

/// Around the plane, as far as its slope makes of the slack, but no farther than the corners reach.
fn triangle_band(line: &Line, corners: [[f64; 3]; 3], slack: f64) -> Vec<Band> {
    let v = |p: [f64; 3]| Vec3::<f64>::splat(p);
    let (origin, d) = (v(line.origin), v(line.direction));
    let relative = corners.map(|corner| v(corner) - origin);
    let is_inside = oracle::triangle(line, corners).is_some();
    let distance = distance_to_edges(d, relative);
    if !is_inside && distance > slack {
        return Vec::new();
    }
    let along = relative.map(|p| p.dot(d) / d.length_squared());
    let reach = slack / d.length();
    let (nearest, farthest) =
        along.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &t| (a.min(t), b.max(t)));
    let normal = (relative[1] - relative[0]).cross(relative[2] - relative[0]);
    let slope = normal.dot(d);
    let (t, tilt) = (normal.dot(relative[0]) / slope, slack * (normal.length() / slope.abs()));
    let (first, last) =
        if t.is_finite() && tilt.is_finite() { (t - tilt, t + tilt) } else { (nearest, farthest) };
    let first = first.max(nearest - reach).min(farthest + reach);
    let last = last.min(farthest + reach).max(nearest - reach);
    vec![Band { first, last, certain: is_inside && distance > slack && tilt.is_finite() }]
}

/// How far the line through zero passes from the nearest point of the triangle's edges.
fn distance_to_edges(direction: Vec3<f64>, corners: [Vec3<f64>; 3]) -> f64 {
    let d = direction * (1.0 / direction.length());
    let across = corners.map(|p| p + d * -p.dot(d));
    let to_segment = |a: Vec3<f64>, b: Vec3<f64>| {
        let e = b - a;
        let share = (-a.dot(e) / e.length_squared()).clamp(0.0, 1.0);
        (a + e * if share.is_nan() { 0.0 } else { share }).length()
    };
    (0..3).map(|i| to_segment(across[i], across[(i + 1) % 3])).fold(f64::INFINITY, f64::min)
}

/// False for triangles that `f64` is sure to see the line pass: they need no exact arithmetic.
fn may_meet(line: &Line, shape: &oracle::Shape) -> bool {
    let oracle::Shape::Triangle(corners) = shape else { return true };
    let v = |p: [f64; 3]| Vec3::<f64>::splat(p);
    let d = v(line.direction);
    let [a, b, c] = corners.map(|corner| v(corner) - v(line.origin));
    let side = |p: Vec3<f64>, q: Vec3<f64>| {
        let (volume, size) = (d.dot(p.cross(q)), d.length() * p.length() * q.length());
        // A hundred times what its roundings may amount to.
        if volume.abs() > 1e-13 * size { volume.signum() } else { 0.0 }
    };
    let sides = [side(b, c), side(c, a), side(a, b)];
    !(sides.contains(&1.0) && sides.contains(&-1.0))
}

/// Whether all of a chord lies within some slack of the plane of one face: moved aside by that, the ray misses the convex
/// whole, however long the chord.
fn hugs_a_face(trial: &Trial, truth: &Truth, chord: [f64; 2], slack: f64) -> bool {
    let v = |p: [f64; 3]| Vec3::<f64>::splat(p);
    let (origin, d) = (v(truth.line.origin), v(truth.line.direction));
    trial.shapes.iter().any(|shape| {
        let oracle::Shape::Triangle(corners) = shape.exact() else { return false };
        let [a, b, c] = corners.map(|corner| v(corner) - origin);
        let normal = (b - a).cross(c - a).normalize();
        chord.iter().all(|&t| (d * t - a).dot(normal).abs() <= slack)
    })
}

/// Whether a ray that should have met a closed convex whole got through its front.
pub(super) fn leaked(trial: &Trial, truth: &Truth, answer: Option<f64>, roundoff: f64) -> bool {
    match trial.claim {
        Claim::Inside => answer.is_none(),
        Claim::Outside => {
            let Some([first, last]) = truth.chord() else { return false };
            // A chord as short as what rounding may do to the surface can be missed by a slightly different ray.
            let size = trial.shapes.iter().fold(0.0, |m: f64, shape| m.max(shape.exact().magnitude()));
            let speed = Vec3::<f64>::splat(truth.line.direction).length();
            let reach = truth.line.origin.iter().fold(size, |m, x| m.max(x.abs()));
            let slack = EXCUSED_ROUNDOFFS * roundoff * reach;
            let is_deep =
                (last - first) * speed > 1e3 * slack && !hugs_a_face(trial, truth, [first, last], slack);
            is_deep && answer.is_none_or(|t| t > 0.5 * (first + last))
        }
        Claim::Exact | Claim::Leaving => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::intersect::testing::meshes::cube;
    use crate::math::Real;

    /// The ray from far outside that no answer is given to runs so deep below the upper face of a cube.
    fn is_leak(depth: f64, roundoff: f64) -> bool {
        let mesh = cube();
        let corner = |i: usize| mesh.points[i].map(|x| x as f32);
        let shapes = mesh.triangles.iter().map(|t| Shape::Triangle(t.map(corner))).collect();
        let top = mesh.points.iter().map(|p| p[1]).fold(0.0, f64::max);
        let ray = Ray::new([-30.0, (top - depth) as f32, 0.1], [1.0, 0.0, 0.0]);
        let trial = Trial { shapes, rays: vec![ray], claim: Claim::Outside };
        let exact: Vec<_> = trial.shapes.iter().map(Shape::exact).collect();
        let truth = Truth::of(&ray, &exact);
        assert!(truth.chord().is_some(), "it meets the cube");
        leaked(&trial, &truth, None, roundoff)
    }

    /// Two rays of 10^7 that ran 2.5 roundoffs below a face from end to end, and passed above it as they were rounded.
    #[test]
    fn what_slides_below_a_face_within_rounding_is_no_leak_and_what_lies_deeper_is() {
        assert!(!is_leak(6e-8, f32::ROUNDOFF));
        assert!(is_leak(6e-8, f64::ROUNDOFF), "for f64 that is deep");
        assert!(is_leak(1e-3, f32::ROUNDOFF));
    }
}
