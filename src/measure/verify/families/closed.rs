//! Closed meshes, which no ray may get through.

use super::aim::{add, blend, exactly, of_length_one, towards, weights};
use super::{Family, Make};
use crate::intersect::Ray;
use crate::intersect::testing::dice::Dice;
use crate::intersect::testing::meshes::{Mesh, cube, icosphere, tetrahedron};
use crate::measure::verify::bounds::Promise;
use crate::measure::verify::trial::{Claim, Shape, Trial};

pub(super) const FAMILIES: &[Family] = &[
    Family {
        name: "closed-inside",
        about: "from inside closed meshes of size 1e-12 to 1e9 at their vertices, edges and faces",
        promise: Promise::Closed,
        make: Make::Rays(inside),
    },
    Family {
        name: "closed-outside",
        about: "the same from outside, up to 30 sizes away",
        promise: Promise::Closed,
        make: Make::Rays(outside),
    },
    Family {
        name: "along-edges",
        about: "along the edges of closed meshes, and in the planes of their faces",
        promise: Promise::EdgeOn,
        make: Make::Rays(along),
    },
];

/// Rays at a mesh.
const RAYS: usize = 64;

/// A closed convex mesh, where it stands.
pub(super) struct Placed {
    triangles: Vec<[[f32; 3]; 3]>,
    center: [f64; 3],
    size: f64,
}

impl Placed {
    fn new(dice: &mut Dice) -> Self {
        let mesh = match dice.below(4) {
            0 => tetrahedron(),
            1 => cube(),
            n => icosphere(n - 2),
        };
        Self::at_random(dice, &mesh)
    }

    /// Of any size, turned or not, up to 30 sizes from the origin.
    pub(super) fn at_random(dice: &mut Dice, mesh: &Mesh) -> Self {
        let size = dice.magnitude(-12.0, 9.0).abs();
        let center = dice.point().map(|x| x * size * [0.0, 1.0, 30.0][dice.below(3)]);
        let turned = if dice.below(3) == 0 { None } else { Some(dice.heading()) };
        let place = |p: [f64; 3]| add(center, turned.map_or(p, |axis| half_turn(axis, p)), size);
        let points: Vec<[f32; 3]> = mesh.points.iter().map(|&p| place(p).map(|x| x as f32)).collect();
        let triangles = mesh.triangles.iter().map(|t| t.map(|i| points[i])).collect();
        Self { triangles, center, size }
    }

    fn target(&self, dice: &mut Dice) -> [f64; 3] {
        let triangle = &self.triangles[dice.below(self.triangles.len())];
        blend(triangle, weights(dice))
    }

    /// A ray from inside at a vertex, an edge or a face: from a common point or one of its own.
    pub(super) fn ray_from_inside(&self, dice: &mut Dice, common: Option<[f64; 3]>) -> Ray {
        let origin = common.unwrap_or_else(|| self.point_inside(dice));
        of_length_one(towards(origin, self.target(dice)))
    }

    pub(super) fn point_inside(&self, dice: &mut Dice) -> [f64; 3] {
        add(self.center, dice.point(), 0.2 * self.size)
    }

    pub(super) fn trial(self, claim: Claim, rays: Vec<Ray>) -> Trial {
        Trial { shapes: self.triangles.into_iter().map(Shape::Triangle).collect(), rays, claim }
    }
}

/// Half a turn about a unit axis.
fn half_turn(axis: [f64; 3], p: [f64; 3]) -> [f64; 3] {
    let along: f64 = (0..3).map(|k| axis[k] * p[k]).sum();
    std::array::from_fn(|k| 2.0 * along * axis[k] - p[k])
}

/// Now from one point, now each from its own.
fn inside(dice: &mut Dice) -> Trial {
    let mesh = Placed::new(dice);
    let common = (dice.below(2) == 0).then(|| mesh.point_inside(dice));
    let rays = (0..RAYS).map(|_| mesh.ray_from_inside(dice, common)).collect();
    mesh.trial(Claim::Inside, rays)
}

fn outside(dice: &mut Dice) -> Trial {
    let mesh = Placed::new(dice);
    let from = |dice: &mut Dice| {
        let away = [2.0, 5.0, 30.0][dice.below(3)];
        add(mesh.center, dice.heading(), away * mesh.size)
    };
    let common = (dice.below(2) == 0).then(|| from(dice));
    let ray = |dice: &mut Dice| {
        let origin = common.unwrap_or_else(|| from(dice));
        of_length_one(towards(origin, mesh.target(dice)))
    };
    let rays = (0..RAYS).map(|_| ray(dice)).collect();
    mesh.trial(Claim::Outside, rays)
}

fn along(dice: &mut Dice) -> Trial {
    let mesh = Placed::new(dice);
    let ray = |dice: &mut Dice| {
        let [a, b, c] = mesh.triangles[dice.below(mesh.triangles.len())].map(exactly);
        let target = [b, add(b, add(c, b, -1.0), dice.unit())][dice.below(2)];
        let way = add(target, a, -1.0);
        let origin = add(a, way, [-1.0, 0.0, 0.25, -8.0][dice.below(4)]);
        let ray = towards(origin, target);
        of_length_one(if ray.direction == [0.0; 3] { Ray::new(ray.origin, [1.0, 0.0, 0.0]) } else { ray })
    };
    let rays = (0..RAYS).map(|_| ray(dice)).collect();
    mesh.trial(Claim::Exact, rays)
}
