//! Any intersector that can be verified, timed beside octray on the same rays.

use std::time::Instant;

use super::testkit::Intersector;
use super::trial::Shape;
use crate::geometry::{Geometry, row3};
use crate::intersect::{PrimId, PrimKind, Ray};
use crate::measure::bench::{BuildReport, Engine, HitColumns, NO_HIT, PeerScene, RayColumns, Subject};

/// A scene of the bench in another intersector, for [`crate::measure::bench::bench_scene`]; nothing if it knows one of the
/// shapes not, or if there are instances or open cylinders, which [`Shape`] has not.
pub fn peer_scene<I>(name: &'static str, intersector: I, subject: &Subject) -> Option<PeerScene>
where
    I: Intersector + 'static,
    I::Scene: Sync + 'static,
{
    let shapes = shapes(&subject.geometry)?;
    let start = Instant::now();
    let scene = intersector.build(&shapes)?;
    let build = BuildReport::new(name, MODE, shapes.len(), start.elapsed().as_secs_f64(), None);
    Some(PeerScene { build, engines: vec![Box::new(RayByRay { name, intersector, scene })] })
}

const MODE: &str = "ray by ray";

fn shapes(g: &Geometry) -> Option<Vec<Shape>> {
    let known = g.instances.is_empty() && g.cylinders.capped.iter().all(|&capped| capped);
    let triangles = (0..g.triangles.len()).map(|row| Shape::Triangle(g.triangles.corners(row)));
    let spheres = (0..g.spheres.len())
        .map(|row| Shape::Sphere { center: row3(&g.spheres.center, row), radius: g.spheres.radius[row] });
    let cylinders = (0..g.cylinders.len()).map(|row| Shape::Cylinder {
        from: row3(&g.cylinders.from, row),
        to: row3(&g.cylinders.to, row),
        radius: g.cylinders.radius[row],
    });
    known.then(|| triangles.chain(spheres).chain(cylinders).collect())
}

/// An intersector as an engine. It names no primitives: where it hits, the first of all stands.
struct RayByRay<I: Intersector> {
    name: &'static str,
    intersector: I,
    scene: I::Scene,
}

impl<I: Intersector> RayByRay<I> {
    fn nearest(&self, rays: &RayColumns<'_>, i: usize) -> Option<f32> {
        let [origin, direction] = rays.ray(i);
        let ray = Ray { t_min: rays.t_min[i], t_max: rays.t_max[i], ..Ray::new(origin, direction) };
        self.intersector.nearest(&self.scene, &ray)
    }
}

impl<I: Intersector> Engine for RayByRay<I>
where
    I::Scene: Sync,
{
    fn name(&self) -> &'static str {
        self.name
    }
    fn mode(&self) -> String {
        MODE.into()
    }
    fn closest(&self, rays: RayColumns<'_>, hits: HitColumns<'_>) {
        for i in 0..rays.len() {
            let hit = self.nearest(&rays, i).map(|t| (t, PrimId::new(PrimKind::Triangle, 0).0));
            (hits.t[i], hits.prim[i]) = hit.unwrap_or((0.0, NO_HIT));
        }
    }
    fn any(&self, rays: RayColumns<'_>, occluded: &mut [bool]) {
        for (i, occluded) in occluded.iter_mut().enumerate() {
            *occluded = self.nearest(&rays, i).is_some();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::describe::builtin;
    use crate::intersect::TierName;
    use crate::intersect::oracle::{self, Line};
    use crate::measure::bench::{Class, Options, View, bench_scene};
    use crate::scene::Scene;

    /// What is exactly true, by a loop.
    struct Truth;

    impl Intersector for Truth {
        type Scene = Vec<oracle::Shape>;

        fn build(&self, shapes: &[Shape]) -> Option<Self::Scene> {
            Some(shapes.iter().map(Shape::exact).collect())
        }

        fn nearest(&self, scene: &Self::Scene, ray: &Ray) -> Option<f32> {
            let counts = |t: f64| t as f32 > ray.t_min && (t as f32) < ray.t_max;
            oracle::nearest(&Line::of(ray), scene, counts).map(|(_, t)| t as f32)
        }
    }

    fn subject(name: &str) -> Subject {
        let mut description = builtin(name).unwrap().unwrap();
        description.render.size = [12, 9];
        Subject::new(name.into(), Scene::compile(&description).unwrap(), View::Scene).unwrap()
    }

    #[test]
    fn an_intersector_is_timed_beside_octray_and_its_answers_are_compared() {
        let subject = subject("seed");
        let peer = peer_scene("truth", Truth, &subject).expect("spheres and closed cylinders");
        let options = Options {
            classes: Class::ALL.to_vec(),
            tier: TierName::Watertight,
            size: [12, 9],
            runs: 1,
            peak_box_tests_s: 1e9,
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let report = bench_scene(&subject, &[peer], &options, &pool, &|_| ()).unwrap();
        assert_eq!((report.builds[1].engine.as_str(), report.classes.len()), ("truth", 6));
        for class in &report.classes {
            let truth = &class.engines[1];
            assert!(truth.mrays_s.median > 0.0 && truth.differs.hits == 0, "{class:?}");
        }
    }

    #[test]
    fn scenes_that_shapes_cannot_say_are_left_out() {
        assert!(peer_scene("truth", Truth, &subject("instances")).is_none());
    }
}
