//! Single triangles and a few together.

use super::aim::{
    Point, add, blend, exactly, has_area, of_length_one, rounded, towards, trial, triangle, weights,
};
use super::{Family, Make};
use crate::intersect::Ray;
use crate::intersect::testing::dice::Dice;
use crate::measure::verify::bounds::Promise;
use crate::measure::verify::trial::{Shape, Trial};

pub(super) const FAMILIES: &[Family] = &[
    Family {
        name: "triangles",
        about: "triangles of size 1e-12 to 1e9, hit and missed",
        promise: Promise::Triangles,
        make: Make::Rays(plain),
    },
    Family {
        name: "triangle-edges",
        about: "triangles of size 1e-12 to 1e9 at their vertices and edges",
        promise: Promise::Triangles,
        make: Make::Rays(edges),
    },
    Family {
        name: "slivers",
        about: "triangles as thin as 1e-9 of their length, and with two corners nearly the same",
        promise: Promise::Triangles,
        make: Make::Rays(slivers),
    },
    Family {
        name: "any-magnitude",
        about: "triangles whose coordinates are 1e-30 to 1e18, all mixed: beyond the domain of f32",
        promise: Promise::Beyond,
        make: Make::Rays(any_magnitude),
    },
    Family {
        name: "on-faces",
        about: "from points on faces, edges and vertices of triangles",
        promise: Promise::Starting,
        make: Make::Rays(on_faces),
    },
    Family {
        name: "coplanar",
        about: "triangles that overlap in one plane, some of them the same",
        promise: Promise::Triangles,
        make: Make::Rays(coplanar),
    },
];

fn corners_of(shape: &Shape) -> [[f32; 3]; 3] {
    match shape {
        Shape::Triangle(corners) => *corners,
        _ => [[0.0; 3]; 3],
    }
}

/// A size, and a place up to 30 sizes from the world's origin.
fn place(dice: &mut Dice) -> (Point, f64) {
    let size = dice.magnitude(-12.0, 9.0).abs();
    let center = dice.point().map(|x| x * size * [0.0, 1.0, 30.0][dice.below(3)]);
    (center, size)
}

fn plain(dice: &mut Dice) -> Trial {
    let (center, size) = place(dice);
    let shapes = vec![Shape::Triangle(triangle(dice, center, size))];
    trial(shapes, |shapes| {
        let corners = corners_of(&shapes[0]);
        let (a, b) = (dice.between(-0.3, 1.1), dice.between(-0.3, 1.1));
        let from = add(center, dice.point(), 3.0 * size);
        of_length_one(towards(from, blend(&corners, [1.0 - a - b, a, b])))
    })
}

fn edges(dice: &mut Dice) -> Trial {
    let (center, size) = place(dice);
    let shapes = vec![Shape::Triangle(triangle(dice, center, size))];
    at_edges(dice, shapes, center, size)
}

fn at_edges(dice: &mut Dice, shapes: Vec<Shape>, center: Point, size: f64) -> Trial {
    trial(shapes, |shapes| {
        let corners = corners_of(&shapes[dice.below(shapes.len())]);
        let from = add(center, dice.point(), 3.0 * size);
        of_length_one(towards(from, blend(&corners, weights(dice))))
    })
}

fn slivers(dice: &mut Dice) -> Trial {
    let (center, size) = place(dice);
    let corners = loop {
        let [a, b, _] = triangle(dice, center, size).map(exactly);
        let width = size * dice.magnitude(-9.0, -2.0);
        let near = [a, add(a, add(b, a, -1.0), dice.unit())][dice.below(2)];
        let corners = [a, b, add(near, dice.heading(), width)].map(rounded);
        if has_area(&corners) {
            break corners;
        }
    };
    at_edges(dice, vec![Shape::Triangle(corners)], center, size)
}

fn any_magnitude(dice: &mut Dice) -> Trial {
    let number = |dice: &mut Dice| dice.magnitude(-30.0, 18.0) as f32;
    let corners = loop {
        let corners: [[f32; 3]; 3] = std::array::from_fn(|_| std::array::from_fn(|_| number(dice)));
        if has_area(&corners) {
            break corners;
        }
    };
    trial(vec![Shape::Triangle(corners)], |_| {
        let from = std::array::from_fn(|_| f64::from(number(dice)));
        of_length_one(towards(from, blend(&corners, weights(dice))))
    })
}

/// On an axis-parallel face the origin is exactly in the plane; elsewhere it is rounded.
fn on_faces(dice: &mut Dice) -> Trial {
    let (center, size) = place(dice);
    let mut corners = triangle(dice, center, size);
    if dice.below(2) == 0 {
        let axis = dice.below(3);
        let level = corners[0][axis];
        corners.iter_mut().for_each(|corner| corner[axis] = level);
    }
    let corners = if has_area(&corners) { corners } else { triangle(dice, center, size) };
    let beside = triangle(dice, center, size);
    trial(vec![Shape::Triangle(corners), Shape::Triangle(beside)], |_| {
        let origin = rounded(blend(&corners, weights(dice)));
        of_length_one(Ray::new(origin, rounded(dice.heading())))
    })
}

/// In a plane across an axis, on a grid, so that edges and corners fall together.
fn coplanar(dice: &mut Dice) -> Trial {
    let (axis, level) = (dice.below(3), dice.below(9) as f32 - 4.0);
    let size = 2f64.powi(dice.below(60) as i32 - 30) as f32;
    let count = 2 + dice.below(4);
    let mut shapes: Vec<Shape> = Vec::new();
    while shapes.len() < count {
        let mut corners: [[f32; 3]; 3] =
            std::array::from_fn(|_| std::array::from_fn(|_| (dice.below(9) as f32 - 4.0) * size));
        corners.iter_mut().for_each(|corner| corner[axis] = level * size);
        if has_area(&corners) {
            shapes.push(Shape::Triangle(corners));
            if dice.below(4) == 0 {
                shapes.push(Shape::Triangle(corners));
            }
        }
    }
    at_edges(dice, shapes, [0.0; 3], f64::from(size) * 4.0)
}
