//! The crate `bvh`: a binary tree that gives the shapes whose boxes a query meets.
//!
//! Its own triangle test sees front faces only, so triangles are tested by octray's plain one. Its rays have no end: the
//! query here is such a ray with one, so that what lies behind the nearest hit is left out.

use std::cell::Cell;

use bvh::aabb::{Aabb, Bounded, IntersectsAabb};
use bvh::bounding_hierarchy::BHShape;
use bvh::bvh::Bvh;
use nalgebra::{Point3, SVector};

use super::faces::Faces;
use crate::intersect::triangle::MollerTrumbore;
use crate::intersect::{Ray, RayLanes, TriangleTest};
use crate::math::Vec3;

struct Face {
    corners: [[f32; 3]; 3],
    row: usize,
    node: usize,
}

impl Bounded<f32, 3> for Face {
    fn aabb(&self) -> Aabb<f32, 3> {
        let [a, b, c] = self.corners.map(Point3::from);
        Aabb::empty().grow(&a).grow(&b).grow(&c)
    }
}

impl BHShape<f32, 3> for Face {
    fn set_bh_node_index(&mut self, index: usize) {
        self.node = index;
    }
    fn bh_node_index(&self) -> usize {
        self.node
    }
}

/// The tree and its triangles.
pub(super) struct BvhCrate {
    tree: Bvh<f32, 3>,
    faces: Vec<Face>,
}

/// A ray that ends.
struct Segment {
    line: bvh::ray::Ray<f32, 3>,
    ray: RayLanes<f32>,
    end: Cell<f32>,
}

impl Segment {
    fn new([origin, direction]: [[f32; 3]; 2], [t_min, t_max]: [f32; 2]) -> Self {
        let ray = RayLanes::from(&Ray { origin, direction, t_min, t_max });
        // The crate makes directions of length one; distances are in units of ours.
        let length = ray.direction.length();
        let line = bvh::ray::Ray::new(Point3::from(origin), SVector::from(direction));
        Self { line, ray, end: Cell::new(t_max * length) }
    }

    /// Where a face is hit within the range.
    fn meets(&self, face: &Face, limit: f32) -> Option<f32> {
        let corners = face.corners.map(Vec3::splat_f32);
        let hit = MollerTrumbore::test(&self.ray, &MollerTrumbore::prepare(&self.ray), corners, limit);
        (hit.mask && hit.t > self.ray.t_min && hit.t < limit).then_some(hit.t)
    }
}

impl IntersectsAabb<f32, 3> for Segment {
    fn intersects_aabb(&self, aabb: &Aabb<f32, 3>) -> bool {
        self.line.intersection_slice_for_aabb(aabb).is_some_and(|(near, _)| near <= self.end.get())
    }
}

impl Faces for BvhCrate {
    const NAME: &'static str = "bvh";
    const MODE: &'static str = "default";

    fn build(corners: &[[[f32; 3]; 3]]) -> Self {
        let face = |(row, &corners): (usize, &[[f32; 3]; 3])| Face { corners, row, node: 0 };
        let mut faces: Vec<Face> = corners.iter().enumerate().map(face).collect();
        let tree = Bvh::build(&mut faces);
        Self { tree, faces }
    }

    fn nearest(&self, ray: [[f32; 3]; 2], range: [f32; 2]) -> Option<(f32, usize)> {
        let segment = Segment::new(ray, range);
        let length = segment.ray.direction.length();
        let mut nearest = None;
        let mut limit = range[1];
        for face in self.tree.traverse_iterator(&segment, &self.faces) {
            if let Some(t) = segment.meets(face, limit) {
                limit = t;
                segment.end.set(t * length);
                nearest = Some((t, face.row));
            }
        }
        nearest
    }

    fn any(&self, ray: [[f32; 3]; 2], range: [f32; 2]) -> bool {
        let segment = Segment::new(ray, range);
        self.tree.traverse_iterator(&segment, &self.faces).any(|face| segment.meets(face, range[1]).is_some())
    }
}
