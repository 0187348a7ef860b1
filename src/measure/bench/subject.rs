//! A scene as the bench sees it: geometry at a common size, its tree, a camera and a light.

use std::fmt;
use std::sync::Arc;

use super::timing::timed;
use super::view::{View, within};
use crate::accel::{Accel, Quality};
use crate::geometry::{Geometry, Instance, Planes};
use crate::intersect::PrimKind;
use crate::math::{Aabb, Transform, Vec3};
use crate::scene::{Camera, Light, Scene};

/// Diagonal that scenes are scaled near to: some ray tracers have absolute epsilons made for such sizes.
const DIAGONAL: f64 = 100.0;

/// Where shadow rays go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// To a point, where they end.
    Point([f64; 3]),
    /// Along a direction, without end.
    Direction([f64; 3]),
}

/// What is measured.
#[derive(Debug)]
pub struct Subject {
    /// Name in reports.
    pub name: String,
    /// Where rays start.
    pub view: View,
    /// All primitives but planes, scaled by a power of two to a diagonal near 100.
    ///
    /// Planes have no bounds: they stand before the tree, other ray tracers have none, and every ray would hit one.
    pub geometry: Geometry,
    /// How much work went into its tree.
    pub quality: Quality,
    /// Its tree.
    pub accel: Accel,
    /// Seconds that building it took the rayon pool that [`Subject::new`] was called in: CPU time of one thread, wall time
    /// of several.
    pub build_s: f64,
    /// The camera.
    pub camera: Camera,
    /// Where shadow rays go.
    pub light: Target,
}

impl Subject {
    /// [`Subject::with_quality`] as trees are usually built.
    pub fn new(name: String, scene: Scene, view: View) -> Option<Self> {
        Self::with_quality(name, scene, view, Quality::default())
    }

    /// Takes a scene apart, scales it, and builds its tree anew. `None` where nothing but planes is left.
    pub fn with_quality(name: String, scene: Scene, view: View, quality: Quality) -> Option<Self> {
        let bounds = scene.accel.bounds();
        if bounds.is_empty() {
            return None;
        }
        let factor = scale_of(&bounds);
        let Scene { geometry, camera, lights, .. } = scene;
        let mut geometry = Arc::unwrap_or_clone(geometry);
        geometry.planes = Planes::default();
        scale(&mut geometry, factor as f32);
        let (accel, build_s) = timed(rayon::current_num_threads(), || Accel::build_with(&geometry, quality));
        let bounds = accel.bounds();
        let light = match view {
            View::Scene => target(&lights, factor, &bounds),
            View::Outside => Target::Point(within(&bounds, [0.8, 2.0, 1.5])),
            View::Inside => Target::Point(within(&bounds, [0.5, 0.8, 0.5])),
        };
        let camera = view.camera(&camera, factor, &bounds);
        Some(Self { name, view, geometry, quality, accel, build_s, camera, light })
    }

    /// Length of the diagonal of the bounds.
    pub fn diagonal(&self) -> f64 {
        diagonal(&self.accel.bounds())
    }

    /// Primitives in the columns; what instances show counts once.
    pub fn primitive_count(&self) -> usize {
        PrimKind::ALL.iter().map(|&kind| self.geometry.count(kind)).sum()
    }

    /// Bytes of the tree with its leaves.
    pub fn tree_bytes(&self) -> u64 {
        self.accel.memory().iter().map(|(_, bytes)| bytes).sum()
    }
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.view {
            View::Scene => f.write_str(&self.name),
            view => write!(f, "{}@{}", self.name, view.name()),
        }
    }
}

pub(super) fn length(v: [f64; 3]) -> f64 {
    Vec3::<f64>::splat(v).length()
}

fn diagonal(bounds: &Aabb) -> f64 {
    length(bounds.size().map(f64::from))
}

/// The power of two that brings the diagonal nearest to 100: multiplying by it rounds nothing.
fn scale_of(bounds: &Aabb) -> f64 {
    let diagonal = diagonal(bounds);
    if diagonal > 0.0 { (DIAGONAL / diagonal).log2().round().exp2() } else { 1.0 }
}

fn scale(g: &mut Geometry, by: f32) {
    let (t, s, c) = (&mut g.triangles, &mut g.spheres, &mut g.cylinders);
    let columns = t.position.iter_mut().chain(&mut s.center).chain([&mut s.radius]);
    let columns = columns.chain(&mut c.from).chain(&mut c.to).chain([&mut c.radius]);
    columns.flatten().for_each(|x| *x *= by);
    g.instances.iter_mut().for_each(|instance| instance.to_world = scaled_map(instance, f64::from(by)));
}

/// The same map between two scaled spaces: only its translation grows.
fn scaled_map(instance: &Instance, by: f64) -> Transform {
    let rows = instance.to_world.rows().map(|[x, y, z, w]| [x, y, z, w * by]);
    // The linear part is as invertible as it was.
    Transform::from_rows(rows).unwrap_or(instance.to_world)
}

/// The scene's first light that has a place, else its first, else a place above the bounds.
fn target(lights: &[Light], factor: f64, bounds: &Aabb) -> Target {
    let placed = lights.iter().find(|light| light.t_max().is_finite());
    let Some(light) = placed.or(lights.first()) else {
        return Target::Point(within(bounds, [0.8, 2.0, 1.5]));
    };
    // Seen from the origin, the way to a light that has a place is that place.
    let to_light = light.illuminate(Vec3::<f64>::zero()).to_light.get(0);
    match light {
        Light::Directional(_) => Target::Direction(to_light),
        _ => Target::Point(to_light.map(|x| x * factor)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::bench::testing::subject;

    #[test]
    fn scenes_come_to_a_common_size() {
        for name in ["seed", "cornell", "spheres", "terrain:200", "instances"] {
            let subject = subject(name, View::Scene);
            assert!((70.0..142.0).contains(&subject.diagonal()), "{name}: {}", subject.diagonal());
            assert_eq!(subject.geometry.planes.len(), 0, "{name}");
        }
    }
}
