//! Cylinders.

use super::aim::{Point, across, add, of_length_one, rounded, towards, trial};
use super::{Family, Make};
use crate::intersect::Ray;
use crate::intersect::testing::dice::Dice;
use crate::measure::verify::bounds::Promise;
use crate::measure::verify::trial::{Claim, Shape, Trial};

pub(super) const FAMILIES: &[Family] = &[
    Family {
        name: "cylinders",
        about: "cylinders of radius 1e-6 to 1e6, from coins to rods, any axis",
        promise: Promise::Ordinary,
        make: Make::Rays(plain),
    },
    Family {
        name: "rims",
        about: "within 1e-6 of the rims of cylinders",
        promise: Promise::Grazing,
        make: Make::Rays(rims),
    },
    Family {
        name: "rims-inside",
        about: "from inside closed cylinders at their rims: what gets out found a gap between side and cap",
        promise: Promise::Rims,
        make: Make::Rays(rims_from_inside),
    },
    Family {
        name: "wires",
        about: "cylinders 1e6 long and 1e-3 thick",
        promise: Promise::Grazing,
        make: Make::Rays(wires),
    },
    Family {
        name: "coins",
        about: "cylinders 1e-3 long and 1e6 thick",
        promise: Promise::Grazing,
        make: Make::Rays(coins),
    },
    Family {
        name: "along-axes",
        about: "along the axes of cylinders, but for rounding or a tiny angle, and in the planes of their caps",
        promise: Promise::Grazing,
        make: Make::Rays(along_axes),
    },
];

/// A cylinder, and what aiming at it needs.
struct Rod {
    from: Point,
    /// From end to end.
    axis: Point,
    radius: f64,
    reach: f64,
}

impl Rod {
    /// Standing anywhere, one in three along an axis of the world.
    fn new(dice: &mut Dice, radius: f64, length: f64) -> Self {
        let reach = radius + length;
        let from = dice.point().map(|x| x * reach);
        let upright = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]][dice.below(3)];
        let heading = if dice.below(3) == 0 { upright } else { dice.heading() };
        let (from, to) = (rounded(from), rounded(add(rounded(from).map(f64::from), heading, length)));
        let [from, to] = [from, to].map(|p| p.map(f64::from));
        Self { from, axis: add(to, from, -1.0), radius: f64::from(radius as f32), reach }
    }

    fn shape(&self) -> Shape {
        let to = add(self.from, self.axis, 1.0);
        Shape::Cylinder { from: rounded(self.from), to: rounded(to), radius: self.radius as f32 }
    }

    /// `height` from 0 to 1 along the axis, `out` from 0 to 1 across it.
    fn point(&self, dice: &mut Dice, height: f64, out: f64) -> Point {
        let along = add(self.from, self.axis, height);
        add(along, across(dice, self.axis), out * self.radius)
    }

    fn towards(&self, dice: &mut Dice, target: Point, away: f64) -> Ray {
        of_length_one(towards(add(target, dice.heading(), away), target))
    }
}

fn any_rod(dice: &mut Dice) -> Rod {
    let radius = dice.magnitude(-6.0, 6.0).abs();
    let length = radius * dice.magnitude(-2.0, 3.0).abs();
    Rod::new(dice, radius, length)
}

fn plain(dice: &mut Dice) -> Trial {
    let rod = any_rod(dice);
    trial(vec![rod.shape()], |_| {
        let (height, out) = (dice.between(-0.3, 1.3), dice.between(0.0, 1.5));
        let target = rod.point(dice, height, out);
        rod.towards(dice, target, 2.0 * rod.reach)
    })
}

fn rims(dice: &mut Dice) -> Trial {
    let rod = any_rod(dice);
    trial(vec![rod.shape()], |_| {
        let (end, out) = (dice.below(2) as f64, 1.0 + dice.between(-1e-6, 1e-6));
        let height = end + dice.between(-1e-6, 1e-6);
        let target = rod.point(dice, height, out);
        rod.towards(dice, target, 2.0 * rod.reach)
    })
}

fn rims_from_inside(dice: &mut Dice) -> Trial {
    let rod = any_rod(dice);
    let trial = trial(vec![rod.shape()], |_| {
        let (end, out) = (dice.below(2) as f64, 1.0 + [0.0, dice.between(-1e-6, 1e-6)][dice.below(2)]);
        let (height, aside) = (dice.between(0.2, 0.8), 0.7 * dice.unit());
        let (origin, target) = (rod.point(dice, height, aside), rod.point(dice, end, out));
        of_length_one(towards(origin, target))
    });
    Trial { claim: Claim::Inside, ..trial }
}

/// From nearby, so that rounding leaves something to aim at.
fn wires(dice: &mut Dice) -> Trial {
    let mut rod = Rod::new(dice, 1e-3, 1e6);
    // Half of them with the middle at the origin, where coordinates are fine.
    if dice.below(2) == 0 {
        rod.from = rod.axis.map(|x| f64::from((-0.5 * x) as f32));
    }
    trial(vec![rod.shape()], |_| {
        let height = [0.5, dice.unit()][dice.below(2)];
        let target = rod.point(dice, height, 1.2);
        let away = [1.0, 1e3][dice.below(2)];
        rod.towards(dice, target, away)
    })
}

fn coins(dice: &mut Dice) -> Trial {
    let mut rod = Rod::new(dice, 1e6, 1e-3);
    if dice.below(2) == 0 {
        rod.from = [0.0; 3];
    }
    if rod.axis == [0.0; 3] {
        rod.axis = [0.0, 0.0, 1e-3];
    }
    trial(vec![rod.shape()], |_| {
        let (height, out) = (dice.unit(), 1.1 * dice.unit());
        let target = rod.point(dice, height, out);
        let away = [1.0, 1e6][dice.below(2)];
        rod.towards(dice, target, away)
    })
}

fn along_axes(dice: &mut Dice) -> Trial {
    let rod = any_rod(dice);
    trial(vec![rod.shape()], |_| {
        let out = [1.0, dice.between(0.0, 1.4)][dice.below(2)];
        if dice.below(3) == 0 {
            // In the plane of a cap, or beside it.
            let height = [0.0, 1.0, 0.0 - 1e-7][dice.below(3)];
            let target = rod.point(dice, height, out);
            let way = across(dice, rod.axis);
            return of_length_one(towards(add(target, way, 3.0 * rod.radius), target));
        }
        let height = [-1.0, 0.5][dice.below(2)];
        let start = rod.point(dice, height, out);
        let tilt = [0.0, dice.magnitude(-12.0, -2.0)][dice.below(2)];
        let way = add(rod.axis, dice.heading(), tilt * rod.radius);
        of_length_one(Ray::new(rounded(start), rounded(way)))
    })
}
