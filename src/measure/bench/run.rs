//! One scene: build, make rays, check, then time all engines in turns.

use rayon::ThreadPool;

use super::census::{Visits, count_visits};
use super::check::{BruteForce, Difference, Mismatch, agree, difference, fingerprint};
use super::classes::{Class, Question};
use super::counters::{CounterReading, Counters};
use super::engine::{Answers, Engine, ask};
use super::generate::ray_set;
use super::octray::Octray;
use super::rays::RaySet;
use super::report::{BuildReport, ClassReport, EngineReport, SceneReport};
use super::subject::Subject;
use super::timing::{Spread, seconds};
use crate::intersect::{Exact, Fast, PrimKind, Tier, TierName, Watertight};
use crate::math::WIDTH;

/// How scenes are measured.
#[derive(Clone, Debug)]
pub struct Options {
    /// Classes of rays.
    pub classes: Vec<Class>,
    /// Precision.
    pub tier: TierName,
    /// Width and height of the picture that camera rays sample.
    pub size: [u32; 2],
    /// How often each engine is timed.
    pub runs: usize,
    /// From [`super::box_tests_a_second`].
    pub peak_box_tests_s: f64,
}

/// A scene in another ray tracer.
pub struct PeerScene {
    /// What building it cost.
    pub build: BuildReport,
    /// Ways to ask it.
    pub engines: Vec<Box<dyn Engine>>,
}

/// Why a scene was not measured.
#[derive(Debug, thiserror::Error)]
#[error("{scene}, {class}: {cause}")]
pub struct BenchError {
    scene: String,
    class: Class,
    cause: Box<Mismatch>,
}

/// Measures a scene with the threads of `pool`. `progress` is told what is being done.
///
/// **Errors:** answers of octray that are wrong; those of others are counted as different.
pub fn bench_scene(
    subject: &Subject,
    peers: &[PeerScene],
    options: &Options,
    pool: &ThreadPool,
    progress: &(dyn Fn(&str) + Sync),
) -> Result<SceneReport, BenchError> {
    let measure = || match options.tier {
        TierName::Fast => classes::<Fast>(subject, peers, options, progress),
        TierName::Watertight => classes::<Watertight>(subject, peers, options, progress),
        TierName::Exact => classes::<Exact>(subject, peers, options, progress),
    };
    let g = &subject.geometry;
    Ok(SceneReport {
        scene: subject.to_string(),
        triangles: g.count(PrimKind::Triangle),
        spheres: g.count(PrimKind::Sphere),
        cylinders: g.count(PrimKind::Cylinder),
        builds: std::iter::once(own_build(subject)).chain(peers.iter().map(|p| p.build.clone())).collect(),
        classes: pool.install(measure)?,
    })
}

fn own_build(subject: &Subject) -> BuildReport {
    let (seconds, bytes) = (subject.build_s, subject.tree_bytes() as f64);
    BuildReport::new("octray", subject.quality.name(), subject.primitive_count(), seconds, Some(bytes))
}

/// The engines of a scene, in the order of the report.
struct Bench<'a> {
    subject: &'a Subject,
    options: &'a Options,
    engines: Vec<&'a dyn Engine>,
    counters: Option<Counters>,
}

fn classes<T: Tier>(
    subject: &Subject,
    peers: &[PeerScene],
    options: &Options,
    progress: &(dyn Fn(&str) + Sync),
) -> Result<Vec<ClassReport>, BenchError> {
    let octray = Octray::<T>::new(&subject.accel);
    let peers = peers.iter().flat_map(|peer| &peer.engines).map(|engine| &**engine);
    let engines = std::iter::once(&octray as &dyn Engine).chain(peers).collect();
    // Counters see the thread that opens them, and no other.
    let counters = Counters::open().ok().filter(|_| rayon::current_num_threads() == 1);
    let mut bench = Bench { subject, options, engines, counters };
    let mut reports = Vec::new();
    for &class in &options.classes {
        let rays = ray_set(subject, class, options.size);
        if rays.is_empty() {
            progress(&format!("{subject}, {class}: the camera sees nothing, so there are no such rays"));
            continue;
        }
        progress(&format!("{subject}, {class}: {} rays", rays.len()));
        let report = bench.measure::<T>(class, &rays);
        reports.push(report.map_err(|cause| BenchError {
            scene: subject.to_string(),
            class,
            cause: Box::new(cause),
        })?);
    }
    Ok(reports)
}

impl Bench<'_> {
    fn measure<T: Tier>(&mut self, class: Class, rays: &RaySet) -> Result<ClassReport, Mismatch> {
        let question = class.question();
        let brute = BruteForce::of::<T>(self.subject, rays);
        let plain = self.plain_answers::<T>(question, rays, &brute)?;
        let differs = self.check::<T>(question, rays, &plain)?;
        let spreads = self.time(question, rays);
        let visits = count_visits(self.subject, question, rays);
        let rows = self.engines.clone().into_iter().zip(differs).zip(spreads);
        let engines: Vec<EngineReport> = rows
            .map(|((engine, differs), mrays_s)| {
                let counters = self.count(engine, question, rays);
                EngineReport { engine: engine.name().into(), mode: engine.mode(), mrays_s, differs, counters }
            })
            .collect();
        Ok(ClassReport {
            class: class.to_string(),
            rays: rays.len(),
            hits: plain.count(),
            fingerprint: format!("{:016x}", fingerprint(&plain)),
            brute_force_rays: brute.len(),
            visits,
            roofline_share: visits.map(|v| self.roofline_share(&v, engines[0].mrays_s.median)),
            engines,
        })
    }

    /// Answers of single rays, some of them checked against every primitive.
    fn plain_answers<T: Tier>(
        &self,
        question: Question,
        rays: &RaySet,
        brute: &BruteForce,
    ) -> Result<Answers, Mismatch> {
        let engine = Octray::<T>::plain(&self.subject.accel);
        let mut plain = Answers::new(question, rays.len());
        ask(&engine, question, rays, &mut plain);
        brute.agrees(&title(&engine), question, &plain, T::NAME)?;
        Ok(plain)
    }

    /// How the answers of each engine differ from the plain ones. octray's own must not.
    fn check<T: Tier>(
        &self,
        question: Question,
        rays: &RaySet,
        plain: &Answers,
    ) -> Result<Vec<Difference>, Mismatch> {
        let mut differs = Vec::new();
        for (i, engine) in self.engines.iter().enumerate() {
            let mut answers = Answers::new(question, rays.len());
            ask(*engine, question, rays, &mut answers);
            if i == 0 {
                agree(&title(*engine), &answers, plain, T::NAME)?;
            }
            differs.push(difference(plain, &answers));
        }
        Ok(differs)
    }

    /// Millions of rays a second. Engines take turns, so that a machine that slows down slows all of them.
    fn time(&self, question: Question, rays: &RaySet) -> Vec<Spread> {
        let threads = rayon::current_num_threads();
        let mut answers = Answers::new(question, rays.len());
        let mut rates = vec![Vec::new(); self.engines.len()];
        for _ in 0..self.options.runs {
            for (engine, rates) in self.engines.iter().zip(&mut rates) {
                let seconds = seconds(threads, || ask(*engine, question, rays, &mut answers));
                // A clock that has not moved says that there were too few rays, not that they were infinitely fast.
                rates.push(rays.len() as f64 / seconds.max(1e-9) / 1e6);
            }
        }
        rates.iter().map(|rates| Spread::of(rates)).collect()
    }

    fn count(&mut self, engine: &dyn Engine, question: Question, rays: &RaySet) -> Option<CounterReading> {
        let mut answers = Answers::new(question, rays.len());
        self.counters.as_mut()?.around(rays.len(), || ask(engine, question, rays, &mut answers))
    }

    /// Boxes that single rays test a second on each thread, over what the thread could test at most.
    fn roofline_share(&self, visits: &Visits, mrays_s: f64) -> f64 {
        let tests_s = visits.nodes * WIDTH as f64 * mrays_s * 1e6;
        tests_s / self.options.peak_box_tests_s / rayon::current_num_threads() as f64
    }
}

fn title(engine: &dyn Engine) -> String {
    format!("{} ({})", engine.name(), engine.mode())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::bench::testing::{Liar, subject};
    use crate::measure::bench::view::View;

    fn options(tier: TierName) -> Options {
        Options { classes: Class::ALL.to_vec(), tier, size: [24, 24], runs: 2, peak_box_tests_s: 1e9 }
    }

    fn pool(threads: usize) -> ThreadPool {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap()
    }

    #[test]
    fn every_class_in_every_tier_with_any_threads() {
        let subject = subject("cornell", View::Scene);
        let hits = |report: &SceneReport| -> Vec<(usize, String)> {
            report.classes.iter().map(|class| (class.hits, class.fingerprint.clone())).collect()
        };
        for tier in [TierName::Fast, TierName::Watertight, TierName::Exact] {
            let alone = bench_scene(&subject, &[], &options(tier), &pool(1), &|_| ()).unwrap();
            let shared = bench_scene(&subject, &[], &options(tier), &pool(3), &|_| ()).unwrap();
            assert_eq!(alone.classes.len(), 6);
            assert_eq!(hits(&alone), hits(&shared));
            assert!(alone.classes.iter().all(|class| class.octray().unwrap().mrays_s.min > 0.0));
        }
    }

    #[test]
    fn other_engines_stand_beside_with_what_they_get_wrong() {
        // Outlives the engine, which peers hold in boxes.
        let subject: &'static Subject = Box::leak(Box::new(subject("seed", View::Scene)));
        let liar = Liar { honest: Octray::<Watertight>::new(&subject.accel), ray: 5, off: 50.0 };
        let peer = PeerScene { build: own_build(subject), engines: vec![Box::new(liar)] };
        let options = Options { classes: vec![Class::Shadow], ..options(TierName::Watertight) };
        let report = bench_scene(subject, &[peer], &options, &pool(1), &|_| ()).unwrap();
        let class = &report.classes[0];
        assert_eq!(class.engines.iter().map(|e| e.differs.hits).collect::<Vec<_>>(), [0, 1]);
        assert!(class.ratio_to("liar").is_some() && class.ratio_to("embree").is_none());
        assert_eq!(report.builds.len(), 2);
    }

    #[test]
    fn a_camera_that_sees_nothing_gives_no_secondary_rays() {
        let mut subject = subject("cornell", View::Scene);
        subject.camera.position = [1e4, 1e4, 1e4];
        subject.camera.forward = [1.0, 0.0, 0.0];
        let report = bench_scene(&subject, &[], &options(TierName::Watertight), &pool(1), &|_| ()).unwrap();
        let names: Vec<&str> = report.classes.iter().map(|class| class.class.as_str()).collect();
        assert_eq!(names, ["primary", "random"]);
    }
}
