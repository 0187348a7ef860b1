//! Spheres.

use super::aim::{Point, across, add, of_length_one, rounded, towards, trial};
use super::{Family, Make};
use crate::intersect::testing::dice::Dice;
use crate::measure::verify::bounds::Promise;
use crate::measure::verify::trial::{Shape, Trial};

pub(super) const FAMILIES: &[Family] = &[
    Family {
        name: "spheres",
        about: "spheres of radius 1e-30 to 1e30 from inside, near and 1e4 radii away",
        promise: Promise::Curved,
        make: Make::Rays(plain),
    },
    Family {
        name: "moderate-spheres",
        about: "the same with radii of 1e-6 to 1e6",
        promise: Promise::Ordinary,
        make: Make::Rays(moderate),
    },
    Family {
        name: "tangent",
        about: "rays that graze spheres and cylinders to within some roundoffs",
        promise: Promise::Grazing,
        make: Make::Rays(tangent),
    },
    Family {
        name: "ground",
        about: "a ground sphere of radius 1e6 seen from 1e-3 to 1e3 above it",
        promise: Promise::Ground,
        make: Make::Rays(ground),
    },
    Family {
        name: "touching",
        about: "spheres that touch, share a centre or are the same, through the points where they touch",
        promise: Promise::Ground,
        make: Make::Rays(touching),
    },
];

fn plain(dice: &mut Dice) -> Trial {
    let radius = dice.magnitude(-30.0, 30.0).abs();
    near_and_far(dice, radius)
}

fn moderate(dice: &mut Dice) -> Trial {
    let radius = dice.magnitude(-6.0, 6.0).abs();
    near_and_far(dice, radius)
}

fn near_and_far(dice: &mut Dice, radius: f64) -> Trial {
    let center = dice.point().map(|x| 10.0 * radius * x);
    let shape = Shape::Sphere { center: rounded(center), radius: radius as f32 };
    trial(vec![shape], |_| {
        let away = [0.5, 1.5, 10.0, 1e4][dice.below(4)];
        let from = add(center, dice.heading(), away * radius);
        of_length_one(towards(from, add(center, dice.heading(), 1.2 * radius * dice.unit())))
    })
}

/// A point of the outline as seen along `heading`, give or take some roundoffs.
fn outline(dice: &mut Dice, center: Point, radius: f64, heading: Point) -> Point {
    let off = 1.0 + dice.magnitude(-9.0, -6.0);
    add(center, across(dice, heading), radius * off)
}

fn tangent(dice: &mut Dice) -> Trial {
    let radius = dice.magnitude(-6.0, 6.0).abs();
    let center = dice.point().map(|x| 3.0 * radius * x);
    let axis = dice.heading();
    let is_sphere = dice.below(2) == 0;
    let shape = match is_sphere {
        true => Shape::Sphere { center: rounded(center), radius: radius as f32 },
        false => Shape::Cylinder {
            from: rounded(add(center, axis, -4.0 * radius)),
            to: rounded(add(center, axis, 4.0 * radius)),
            radius: radius as f32,
        },
    };
    trial(vec![shape], |_| {
        let heading = dice.heading();
        let target = match is_sphere {
            true => outline(dice, center, radius, heading),
            false => {
                let [h, a] = [heading, axis];
                let n = [h[1] * a[2] - h[2] * a[1], h[2] * a[0] - h[0] * a[2], h[0] * a[1] - h[1] * a[0]];
                let size = n.iter().map(|x| x * x).sum::<f64>().sqrt().max(1e-30);
                add(center, n, radius * (1.0 + dice.magnitude(-9.0, -6.0)) / size)
            }
        };
        let away = [4.0, 40.0][dice.below(2)];
        of_length_one(towards(add(target, heading, -away * radius), target))
    })
}

fn ground(dice: &mut Dice) -> Trial {
    let shape = Shape::Sphere { center: [0.0, -1e6, 0.0], radius: 1e6 };
    trial(vec![shape], |_| {
        let height = dice.magnitude(-3.0, 3.0).abs();
        let p = dice.point();
        let from = [1e3 * p[0], height, 1e3 * p[2]];
        of_length_one(towards(from, add(from, [p[2], -p[1].abs() - 1e-3, p[0]], height)))
    })
}

fn touching(dice: &mut Dice) -> Trial {
    let radius = 2f64.powi(dice.below(40) as i32 - 20);
    let grid = |dice: &mut Dice| dice.below(5) as f64 - 2.0;
    let center: Point = std::array::from_fn(|_| grid(dice) * radius);
    let axis = dice.below(3);
    let beside = |by: f64| std::array::from_fn(|k| center[k] + if k == axis { by * radius } else { 0.0 });
    let ball = |center: Point, radius: f64| Shape::Sphere { center: rounded(center), radius: radius as f32 };
    let other = match dice.below(4) {
        0 => ball(beside(2.0), radius),
        1 => ball(beside(0.5), 0.5 * radius),
        2 => ball(center, [0.5, 1.0 - 1e-6][dice.below(2)] * radius),
        _ => ball(center, radius),
    };
    let point = beside(1.0);
    trial(vec![ball(center, radius), other], |_| {
        let target = [point, add(center, dice.heading(), radius)][dice.below(2)];
        let from = add(target, dice.heading(), 3.0 * radius);
        of_length_one(towards(from, target))
    })
}
