//! What a plain traversal visits: one ray at a time, node by node, counting.
//!
//! A traversal of its own, so that the timed one carries no counters. It goes down the same tree in the same order of slots.

use serde::{Deserialize, Serialize};

use super::classes::Question;
use super::rays::RaySet;
use super::subject::Subject;
use crate::accel::node::{ChildRef, Node8};
use crate::accel::query::{Closest, Query};
use crate::geometry::{Geometry, row3};
use crate::intersect::aabb::CullRay;
use crate::intersect::{
    Curved, PrimId, PrimKind, Ray, RayLanes, Tier, TriangleTest, Watertight, cylinder, sphere,
};
use crate::math::{Vec3, WIDTH};

/// Every so manieth ray is counted.
const EVERY: usize = 16;

type Test = <Watertight as Tier>::Triangle;

/// Visits a ray.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Visits {
    /// Nodes: eight boxes each.
    pub nodes: f64,
    /// Blocks of up to eight primitives.
    pub blocks: f64,
}

/// Counts over an evenly spread sixteenth of the rays. `None` for scenes with instances, whose trees hang below leaves.
pub fn count_visits(subject: &Subject, question: Question, rays: &RaySet) -> Option<Visits> {
    if rays.is_empty() || !subject.geometry.instances.is_empty() {
        return None;
    }
    let mut walk = Walk { subject, stack: Vec::new(), nodes: 0, blocks: 0 };
    let counted = (0..rays.len()).step_by(EVERY);
    let count = counted.len() as f64;
    for i in counted {
        let [origin, direction] = rays.columns().ray(i);
        let ray = Ray { origin, direction, t_min: rays.t_min[i], t_max: rays.t_max[i] };
        walk.go(question, &RayLanes::from(&ray));
    }
    Some(Visits { nodes: walk.nodes as f64 / count, blocks: walk.blocks as f64 / count })
}

struct Walk<'a> {
    subject: &'a Subject,
    /// Where to go, and the distance of its box.
    stack: Vec<(ChildRef, f32)>,
    nodes: u64,
    blocks: u64,
}

impl Walk<'_> {
    fn go(&mut self, question: Question, ray: &RayLanes<f32>) {
        let accel = &self.subject.accel;
        let (nodes, root) = accel.nodes();
        let cull = CullRay::new(ray.origin, ray.direction, accel.scale(ray.origin));
        let prepared = Test::prepare(ray);
        let mut query = Closest::new(ray.t_max);
        self.stack.clear();
        self.stack.push((root, f32::NEG_INFINITY));
        while let Some((child, near)) = self.stack.pop() {
            if near > query.t || question == Question::Any && query.t < ray.t_max {
                continue;
            }
            if child.is_node() {
                self.nodes += 1;
                self.push_children(&nodes[child.index() as usize], &cull, (ray.t_min, query.t));
                continue;
            }
            self.blocks += 1;
            for &id in accel.leaf_ids(child) {
                test(&self.subject.geometry, ray, &prepared, PrimId(id), &mut query);
            }
        }
    }

    /// The last to visit first.
    fn push_children(&mut self, node: &Node8, cull: &CullRay<f32>, (t_min, t_max): (f32, f32)) {
        let octant = (0..3).map(|k| usize::from(cull.backward()[k]) << k).sum::<usize>();
        for slot in (0..WIDTH).rev().map(|i| i ^ octant).filter(|&slot| !node.child[slot].is_empty()) {
            let bounds = node.bounds(slot);
            let (low, high) = (Vec3::splat(bounds.min), Vec3::splat(bounds.max));
            let (enter, leave) = cull.interval_any(low, high, t_min, t_max);
            if enter <= leave {
                self.stack.push((node.child[slot], enter));
            }
        }
    }
}

fn test(
    g: &Geometry,
    ray: &RayLanes<f32>,
    prepared: &<Test as TriangleTest>::Prepared<f32>,
    id: PrimId,
    query: &mut Closest<f32>,
) {
    let (row, (s, c)) = (id.row(), (&g.spheres, &g.cylinders));
    let hit = match id.kind() {
        PrimKind::Triangle => {
            Test::test(ray, prepared, g.triangles.corners(row).map(Vec3::splat_f32), query.t)
        }
        PrimKind::Sphere => {
            let lanes = sphere::Lanes { center: Vec3::splat(row3(&s.center, row)), radius: s.radius[row] };
            <Watertight as Tier>::Curved::sphere(ray, &lanes)
        }
        _ => {
            let lanes = cylinder::Lanes {
                from: Vec3::splat(row3(&c.from, row)),
                to: Vec3::splat(row3(&c.to, row)),
                radius: c.radius[row],
                capped: c.capped[row],
            };
            <Watertight as Tier>::Curved::cylinder(ray, &lanes)
        }
    };
    query.accept(ray, &hit, id.0);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::bench::subject::View;
    use crate::measure::bench::testing::subject;
    use crate::measure::bench::{Class, ray_set};

    /// Each hit takes a block, each block a node, and no ray more than there are.
    #[test]
    fn visits_lie_between_what_is_needed_and_what_there_is() {
        for name in ["terrain:2000", "spheres"] {
            let subject = subject(name, View::Outside);
            for class in Class::ALL {
                let rays = ray_set(&subject, class, [64, 64]);
                let visits = count_visits(&subject, class.question(), &rays).unwrap();
                let most = subject.accel.nodes().0.len() as f64;
                assert!(visits.nodes >= 1.0 && visits.nodes < most, "{name} {class}: {visits:?}");
                assert!(
                    visits.blocks > 0.0 && visits.blocks < visits.nodes * 8.0,
                    "{name} {class}: {visits:?}"
                );
            }
        }
    }

    #[test]
    fn trees_below_leaves_are_not_counted() {
        let subject = subject("instances", View::Scene);
        let rays = ray_set(&subject, Class::Primary, [8, 8]);
        assert_eq!(count_visits(&subject, Question::Closest, &rays), None);
    }
}
