//! Rays that start where curved surfaces are.

use super::aim::{Point, add, of_length_one, rounded, trial};
use super::{Family, Make};
use crate::intersect::Ray;
use crate::intersect::testing::dice::Dice;
use crate::measure::verify::bounds::Promise;
use crate::measure::verify::trial::{Shape, Trial};

pub(super) const FAMILIES: &[Family] = &[Family {
    name: "on-curved",
    about: "from points of spheres and cylinders, and from 1e-30 to 1e-6 beside them",
    promise: Promise::Nearby,
    make: Make::Rays(on_curved),
}];

/// Vectors at right angles, all of one whole length, and that.
fn frame(dice: &mut Dice) -> ([Point; 3], f64) {
    let upright = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let askew = [[1.0, 2.0, 2.0], [2.0, 1.0, -2.0], [2.0, -2.0, 1.0]];
    let (mut axes, length) = [(upright, 1.0), (askew, 3.0)][dice.below(2)];
    axes.rotate_left(dice.below(3));
    (axes, length)
}

/// On a grid, so that a point of the surface is one exactly. Often that is zero, beside which lie numbers that are small for all of it.
fn on_curved(dice: &mut Dice) -> Trial {
    let size = 2f64.powi(dice.below(40) as i32 - 20);
    let (axes, length) = frame(dice);
    let along = |by: [f64; 3]| (0..3).fold([0.0; 3], |sum, i| add(sum, axes[i], by[i] * size));
    let grid = |dice: &mut Dice| -> Point { std::array::from_fn(|_| (dice.below(7) as f64 - 3.0) * size) };
    let on = [[0.0; 3], grid(dice)][dice.below(2)];
    let [x, y] = [[5.0, 0.0], [3.0, 4.0], [-4.0, 3.0], [0.0, -5.0]][dice.below(4)];
    let radius = (5.0 * length * size) as f32;
    let shape = if dice.below(2) == 0 {
        Shape::Sphere { center: rounded(add(on, along([x, y, 0.0]), -1.0)), radius }
    } else {
        let (inwards, end) = ([1.0, 1.0, 0.5, 0.0][dice.below(4)], 1.0 + dice.below(4) as f64);
        let height = [0.0, end, 1.0][dice.below(3)];
        let from = add(on, along([x * inwards, y * inwards, height]), -1.0);
        Shape::Cylinder { from: rounded(from), to: rounded(add(from, along([0.0, 0.0, end]), 1.0)), radius }
    };
    trial(vec![shape], |_| {
        let beside =
            |dice: &mut Dice| if dice.below(3) == 0 { dice.magnitude(-30.0, -6.0) * size } else { 0.0 };
        let origin = on.map(|x| x + beside(dice));
        let steps: [f64; 3] = std::array::from_fn(|_| dice.below(5) as f64 - 2.0);
        let way = [along(steps).map(|x| x / size), dice.heading()][dice.below(2)];
        let way = way.map(|x| x + beside(dice) / size);
        of_length_one(Ray::new(rounded(origin), rounded(if way == [0.0; 3] { axes[0] } else { way })))
    })
}
