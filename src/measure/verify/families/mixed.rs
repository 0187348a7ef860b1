//! What is hard for every kind of primitive alike.

use super::aim::{Point, add, of_length_one, rounded, towards, trial, triangle};
use super::{Family, Make};
use crate::intersect::Ray;
use crate::intersect::oracle::{Line, nearest};
use crate::intersect::testing::dice::Dice;
use crate::measure::verify::bounds::Promise;
use crate::measure::verify::trial::{Shape, Trial};

pub(super) const FAMILIES: &[Family] = &[
    Family {
        name: "far",
        about: "objects of size 1 seen from 1e3 to 1e8",
        promise: Promise::Magnitudes,
        make: Make::Rays(far),
    },
    Family {
        name: "axis-parallel",
        about: "along axes and in planes of two, with zeros of either sign, at shapes on a grid",
        promise: Promise::Ordinary,
        make: Make::Rays(axis_parallel),
    },
    Family {
        name: "lengths",
        about: "directions of length 1e-20 to 1e20",
        promise: Promise::Curved,
        make: Make::Rays(lengths),
    },
    Family {
        name: "moderate-lengths",
        about: "directions of length 1e-6 to 1e6",
        promise: Promise::Ordinary,
        make: Make::Rays(moderate_lengths),
    },
    Family {
        name: "odd-lengths",
        about: "directions as short as the least f32 and as long as the largest: beyond the domain",
        promise: Promise::Beyond,
        make: Make::Rays(odd_lengths),
    },
    Family {
        name: "t-max",
        about: "rays that end exactly at their hit, one number before or behind it",
        promise: Promise::Ordinary,
        make: Make::Rays(t_max),
    },
    Family {
        name: "mixed",
        about: "a dozen triangles, spheres and cylinders that interpenetrate",
        promise: Promise::Mixed,
        make: Make::Rays(mixed),
    },
];

/// A shape of any kind of about size 1 around a point.
fn any_shape(dice: &mut Dice, center: Point) -> Shape {
    let size = dice.between(0.3, 1.0);
    match dice.below(3) {
        0 => Shape::Triangle(triangle(dice, center, size)),
        1 => Shape::Sphere { center: rounded(center), radius: size as f32 },
        _ => {
            let (from, to) = (add(center, dice.heading(), size), add(center, dice.heading(), -size));
            let to = if rounded(from) == rounded(to) { add(to, [1.0, 0.0, 0.0], size) } else { to };
            Shape::Cylinder { from: rounded(from), to: rounded(to), radius: (0.5 * size) as f32 }
        }
    }
}

fn far(dice: &mut Dice) -> Trial {
    let shape = any_shape(dice, [0.0; 3]);
    trial(vec![shape], |_| {
        let away = dice.magnitude(3.0, 8.0).abs();
        of_length_one(towards(dice.heading().map(|x| x * away), dice.point().map(|x| 0.8 * x)))
    })
}

/// On a grid tangents, edges and caps are met exactly.
fn axis_parallel(dice: &mut Dice) -> Trial {
    let size = 2f64.powi(dice.below(40) as i32 - 20) as f32;
    let grid = |dice: &mut Dice| -> [f32; 3] { std::array::from_fn(|_| (dice.below(5) as f32 - 2.0) * size) };
    let shape = match dice.below(3) {
        0 => Shape::Triangle(triangle_on(dice, grid)),
        1 => Shape::Sphere { center: grid(dice), radius: (1 + dice.below(2)) as f32 * size },
        _ => {
            let from = grid(dice);
            let mut to = from;
            to[dice.below(3)] += (1 + dice.below(2)) as f32 * size;
            Shape::Cylinder { from, to, radius: (1 + dice.below(2)) as f32 * size }
        }
    };
    trial(vec![shape], |_| {
        let mut direction: [f32; 3] = std::array::from_fn(|_| [0.0, -0.0, 0.0, 1.0, -0.5][dice.below(5)]);
        direction[dice.below(3)] = [1.0, -1.0][dice.below(2)];
        let start = grid(dice);
        Ray::new(std::array::from_fn(|k| start[k] - 8.0 * size * direction[k]), direction)
    })
}

fn triangle_on(dice: &mut Dice, grid: impl Fn(&mut Dice) -> [f32; 3]) -> [[f32; 3]; 3] {
    loop {
        let corners = std::array::from_fn(|_| grid(dice));
        if super::aim::has_area(&corners) {
            return corners;
        }
    }
}

fn of_length(dice: &mut Dice, length: fn(&mut Dice) -> f64) -> Trial {
    let shape = any_shape(dice, [0.0; 3]);
    trial(vec![shape], |_| {
        let ray = towards(dice.heading().map(|x| 3.0 * x), dice.point().map(|x| 0.8 * x));
        let length = length(dice);
        let direction = ray.direction.map(|x| (f64::from(x) / 3.0 * length) as f32);
        if direction == [0.0; 3] { ray } else { Ray { direction, ..ray } }
    })
}

fn lengths(dice: &mut Dice) -> Trial {
    of_length(dice, |dice| dice.magnitude(-20.0, 20.0).abs())
}

fn moderate_lengths(dice: &mut Dice) -> Trial {
    of_length(dice, |dice| dice.magnitude(-6.0, 6.0).abs())
}

fn odd_lengths(dice: &mut Dice) -> Trial {
    of_length(dice, |dice| match dice.below(2) {
        0 => dice.magnitude(-44.0, -36.0).abs(),
        _ => dice.magnitude(36.0, 38.0).abs(),
    })
}

fn t_max(dice: &mut Dice) -> Trial {
    let shape = any_shape(dice, [0.0; 3]);
    let exact = [shape.exact()];
    trial(vec![shape], |_| {
        let ray = of_length_one(towards(dice.heading().map(|x| 3.0 * x), dice.point().map(|x| 0.8 * x)));
        let Some((_, t)) = nearest(&Line::of(&ray), &exact, |t| t > 0.0) else { return ray };
        let t = t as f32;
        Ray { t_max: [t, t.next_up(), t.next_down()][dice.below(3)], ..ray }
    })
}

fn mixed(dice: &mut Dice) -> Trial {
    let shapes: Vec<Shape> = (0..12)
        .map(|_| {
            let center = dice.point().map(|x| 2.0 * x);
            any_shape(dice, center)
        })
        .collect();
    trial(shapes, |_| {
        let from = dice.point().map(|x| x * [1.0, 6.0][dice.below(2)]);
        of_length_one(towards(from, dice.point().map(|x| 2.0 * x)))
    })
}
