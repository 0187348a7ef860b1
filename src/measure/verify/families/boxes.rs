//! Boxes of a tree, which may be met too often but never missed.

use super::aim::{Point, of_length_one, towards, trial};
use super::{Family, Make};
use crate::intersect::Ray;
use crate::intersect::testing::dice::Dice;
use crate::measure::verify::bounds::Promise;
use crate::measure::verify::trial::{Shape, Trial};

pub(super) const FAMILIES: &[Family] = &[
    Family {
        name: "boxes",
        about: "boxes of size 1e-12 to 1e9, some of them flat, at their corners, edges and faces",
        promise: Promise::Boxes,
        make: Make::Rays(plain),
    },
    Family {
        name: "box-planes",
        about: "along the axes of boxes on a grid, in the planes of their faces, with zeros of either sign",
        promise: Promise::Boxes,
        make: Make::Rays(planes),
    },
];

fn plain(dice: &mut Dice) -> Trial {
    let size = dice.magnitude(-12.0, 9.0).abs();
    let (a, b) = (dice.point(), dice.point());
    let flat = dice.below(6);
    let corner = |k: usize, of: fn(f64, f64) -> f64| {
        let value = if k == flat { a[k] } else { of(a[k], b[k]) };
        (size * value) as f32
    };
    let (min, max) =
        (std::array::from_fn(|k| corner(k, f64::min)), std::array::from_fn(|k| corner(k, f64::max)));
    trial(vec![Shape::Box { min, max }], |_| {
        // A corner, a point on an edge or a face, or one inside.
        let target: Point = std::array::from_fn(|k| {
            let share = [0.0, 1.0, dice.unit()][dice.below(3)];
            f64::from(min[k]) + share * (f64::from(max[k]) - f64::from(min[k]))
        });
        let away = [0.5, 3.0, 100.0][dice.below(3)];
        let from = dice.point().map(|x| x * size * away);
        let mut ray = of_length_one(towards(from, target));
        if dice.below(4) == 0 {
            ray.t_max = dice.between(0.1, 2.0) as f32;
        }
        ray
    })
}

fn planes(dice: &mut Dice) -> Trial {
    let size = 2f64.powi(dice.below(60) as i32 - 30) as f32;
    let grid = |dice: &mut Dice| (dice.below(5) as f32 - 2.0) * size;
    let (a, b): ([f32; 3], [f32; 3]) =
        (std::array::from_fn(|_| grid(dice)), std::array::from_fn(|_| grid(dice)));
    let (min, max) = (std::array::from_fn(|k| a[k].min(b[k])), std::array::from_fn(|k| a[k].max(b[k])));
    trial(vec![Shape::Box { min, max }], |_| {
        let origin = std::array::from_fn(|_| grid(dice));
        let mut direction: [f32; 3] = std::array::from_fn(|_| [0.0, -0.0, 1.0, -1.0][dice.below(4)]);
        direction[dice.below(3)] = [1.0, -1.0][dice.below(2)];
        Ray::new(origin, direction)
    })
}
