//! How rays come to where it is hard.

use crate::intersect::Ray;
use crate::intersect::testing::dice::Dice;
use crate::measure::verify::trial::{Claim, Shape, Trial};

/// Rays a trial.
pub(super) const RAYS: usize = 16;

pub(super) type Point = [f64; 3];

pub(super) fn rounded(p: Point) -> [f32; 3] {
    p.map(|x| x as f32)
}

pub(super) fn exactly(p: [f32; 3]) -> Point {
    p.map(f64::from)
}

/// `a + by b`.
pub(super) fn add(a: Point, b: Point, by: f64) -> Point {
    std::array::from_fn(|k| a[k] + by * b[k])
}

/// The points of three with these weights.
pub(super) fn blend(corners: &[[f32; 3]; 3], weights: [f64; 3]) -> Point {
    std::array::from_fn(|k| (0..3).map(|i| weights[i] * f64::from(corners[i][k])).sum())
}

/// From a point towards another: the direction is the way between them, both rounded.
pub(super) fn towards(origin: Point, target: Point) -> Ray {
    let origin = rounded(origin);
    let direction = rounded(add(target, exactly(origin), -1.0));
    Ray::new(origin, if direction == [0.0; 3] { [0.0, 0.0, 1.0] } else { direction })
}

/// Weights of a vertex, of a point on an edge, or of one inside.
pub(super) fn weights(dice: &mut Dice) -> [f64; 3] {
    let (a, b) = (dice.unit(), dice.unit());
    let mut w = [[1.0, 0.0, 0.0], [a, 1.0 - a, 0.0], [a * b, a * (1.0 - b), 1.0 - a]][dice.below(3)];
    w.rotate_left(dice.below(3));
    w
}

/// A direction at a right angle to another.
pub(super) fn across(dice: &mut Dice, axis: Point) -> Point {
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    let a = axis.map(|x| x / length);
    loop {
        let h = dice.heading();
        let along: f64 = (0..3).map(|k| a[k] * h[k]).sum();
        let c = add(h, a, -along);
        let size = c.iter().map(|x| x * x).sum::<f64>().sqrt();
        if size > 0.1 {
            return c.map(|x| x / size);
        }
    }
}

/// A triangle of about a size around a point, with an area that `f64` sees.
pub(super) fn triangle(dice: &mut Dice, center: Point, size: f64) -> [[f32; 3]; 3] {
    loop {
        let corners = std::array::from_fn(|_| rounded(add(center, dice.point(), size)));
        if has_area(&corners) {
            return corners;
        }
    }
}

pub(super) fn has_area(corners: &[[f32; 3]; 3]) -> bool {
    let [a, b, c] = corners.map(exactly);
    let (u, v) = (add(b, a, -1.0), add(c, a, -1.0));
    let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    normal.iter().any(|&x| x != 0.0)
}

/// One scene and rays that are made alike.
pub(super) fn trial(shapes: Vec<Shape>, mut ray: impl FnMut(&[Shape]) -> Ray) -> Trial {
    let rays = (0..RAYS).map(|_| ray(&shapes)).collect();
    Trial { shapes, rays, claim: Claim::Exact }
}

/// The largest coordinate becomes about 1, so that lengths do not add to the difficulty; a power of two changes no bit.
pub(super) fn of_length_one(mut ray: Ray) -> Ray {
    let largest = ray.direction.iter().fold(0.0, |m: f32, x| m.max(x.abs()));
    let scale = 2f64.powi(-(largest.log2().floor() as i32));
    ray.direction = ray.direction.map(|x| (f64::from(x) * scale) as f32);
    ray
}
