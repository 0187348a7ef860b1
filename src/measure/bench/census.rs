//! What rays visit that traverse alone.

use serde::{Deserialize, Serialize};

use super::classes::Question;
use super::rays::RaySet;
use super::subject::Subject;
use crate::accel::visits;
use crate::intersect::Ray;

/// Every so manieth ray is counted.
const EVERY: usize = 16;

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
    let counted = (0..rays.len()).step_by(EVERY);
    let count = counted.len() as f64;
    let mut all = visits::Visits::default();
    for i in counted {
        let [origin, direction] = rays.columns().ray(i);
        let ray = Ray { origin, direction, t_min: rays.t_min[i], t_max: rays.t_max[i] };
        all += subject.accel.visits(&ray, question == Question::Any);
    }
    Some(Visits { nodes: all.nodes as f64 / count, blocks: all.blocks as f64 / count })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::bench::testing::subject;
    use crate::measure::bench::view::View;
    use crate::measure::bench::{Class, ray_set};

    /// Each hit takes a block, each block a node, and no ray more than there are.
    #[test]
    fn visits_lie_between_what_is_needed_and_what_there_is() {
        for name in ["terrain:2000", "spheres"] {
            let subject = subject(name, View::Outside);
            for class in Class::ALL {
                let rays = ray_set(&subject, class, [64, 64]);
                let visits = count_visits(&subject, class.question(), &rays).unwrap();
                let most = subject.accel.node_count() as f64;
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
