//! What intersectors are asked: some shapes, some rays, and what is claimed about them.

use crate::geometry::{Geometry, Group, NO_MATERIAL, push3};
use crate::intersect::{Ray, oracle};

/// A primitive as it is given to an intersector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Three corners; edges and corners belong to it, both sides count.
    Triangle([[f32; 3]; 3]),
    /// A sphere; seen from inside its far side is hit.
    Sphere {
        /// Centre.
        center: [f32; 3],
        /// Radius, positive.
        radius: f32,
    },
    /// A cylinder closed by caps.
    Cylinder {
        /// Centre of the first cap.
        from: [f32; 3],
        /// Centre of the second cap.
        to: [f32; 3],
        /// Radius, positive.
        radius: f32,
    },
    /// A box along the axes as trees have them: to meet any of it, inside or out, is a hit.
    Box {
        /// Least coordinates.
        min: [f32; 3],
        /// Greatest coordinates.
        max: [f32; 3],
    },
}

/// What must hold for the rays of a trial beside what the exact oracle says of each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Claim {
    /// Nothing more.
    Exact,
    /// The shapes are a closed surface around the origins: a ray that hits nothing leaked.
    Inside,
    /// The shapes are a closed convex surface with the origins outside: a ray that misses the front leaked.
    Outside,
    /// Rays leave a convex surface outwards, from points moved off it: any hit is one of the surface with itself.
    Leaving,
}

/// Rays put to a small scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// The scene: of boxes only a single one.
    pub shapes: Vec<Shape>,
    /// The rays.
    pub rays: Vec<Ray>,
    /// What holds for them.
    pub claim: Claim,
}

impl Shape {
    /// The same for the exact oracle.
    pub fn exact(&self) -> oracle::Shape {
        let v = |p: [f32; 3]| p.map(f64::from);
        match *self {
            Self::Triangle(corners) => oracle::Shape::Triangle(corners.map(v)),
            Self::Sphere { center, radius } => {
                oracle::Shape::Sphere { center: v(center), radius: radius.into() }
            }
            Self::Cylinder { from, to, radius } => oracle::Shape::Cylinder(oracle::Cylinder {
                from: v(from),
                to: v(to),
                radius: radius.into(),
                capped: true,
            }),
            Self::Box { min, max } => oracle::Shape::Box { min: v(min), max: v(max) },
        }
    }
}

impl Trial {
    /// The shapes as columns, in one group; boxes are left out.
    pub(super) fn geometry(&self) -> Geometry {
        let mut g = Geometry::default();
        for shape in &self.shapes {
            match *shape {
                Shape::Triangle(corners) => push_triangle(&mut g, corners),
                Shape::Sphere { center, radius } => g.spheres.push(center, radius, NO_MATERIAL),
                Shape::Cylinder { from, to, radius } => {
                    g.cylinders.push([from, to], radius, true, NO_MATERIAL);
                }
                Shape::Box { .. } => {}
            }
        }
        let (triangles, spheres, cylinders) =
            (0..g.triangles.len(), 0..g.spheres.len(), 0..g.cylinders.len());
        g.groups = vec![Group { triangles, spheres, cylinders }];
        g
    }

    /// The origin that all rays share, if they do.
    pub(super) fn common_origin(&self) -> Option<[f32; 3]> {
        let first = self.rays.first()?.origin;
        self.rays.iter().all(|ray| ray.origin == first).then_some(first)
    }
}

fn push_triangle(g: &mut Geometry, corners: [[f32; 3]; 3]) {
    let triangles = &mut g.triangles;
    for (column, corner) in triangles.vertex.iter_mut().zip(corners) {
        column.push(triangles.position[0].len() as u32);
        push3(&mut triangles.position, corner);
    }
    triangles.material.push(NO_MATERIAL);
}
