//! What was measured, as written to JSON files and read back as baselines.

use serde::{Deserialize, Serialize};

use super::census::Visits;
use super::check::Difference;
use super::counters::CounterReading;
use super::scaling::Scaling;
use super::timing::Spread;
use crate::accel::Quality;

/// Everything that was measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Report {
    /// Version of the program, and for which instructions it was built.
    pub octray: String,
    /// What was asked for.
    pub settings: Settings,
    /// Tests of one ray against one box a second that one thread reaches with nodes in the nearest cache.
    pub peak_box_tests_s: f64,
    /// Scenes in the order in which they were given.
    pub scenes: Vec<SceneReport>,
    /// How costs grow with the number of primitives, where that was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scaling: Option<Scaling>,
}

/// What was asked for; reports compare only where these are equal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// Precision tier.
    pub tier: String,
    /// How much work went into trees.
    #[serde(default = "balanced")]
    pub build_quality: String,
    /// Threads that asked rays.
    pub threads: usize,
    /// Width and height of the picture that camera rays sample.
    pub size: [u32; 2],
    /// How often each engine was timed.
    pub runs: usize,
}

/// What trees were built with before it was a setting.
fn balanced() -> String {
    Quality::Balanced.name().to_owned()
}

/// What was measured of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneReport {
    /// Name, with the view.
    pub scene: String,
    /// Triangles.
    pub triangles: usize,
    /// Spheres.
    pub spheres: usize,
    /// Cylinders.
    pub cylinders: usize,
    /// Builds: octray's first.
    pub builds: Vec<BuildReport>,
    /// Ray classes in the order in which they were asked for.
    pub classes: Vec<ClassReport>,
}

/// What a tree cost.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BuildReport {
    /// Name of the ray tracer.
    pub engine: String,
    /// How it built.
    pub mode: String,
    /// CPU time where one thread builds, else wall time.
    pub seconds: f64,
    /// Millions of primitives a second.
    pub mprims_s: f64,
    /// Bytes of the tree and its leaves, where the engine tells.
    pub bytes_a_prim: Option<f64>,
}

/// What was measured of a class of rays.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClassReport {
    /// Name of the class.
    pub class: String,
    /// Number of rays.
    pub rays: usize,
    /// How many of them hit something.
    pub hits: usize,
    /// Tells the answers apart from others.
    pub fingerprint: String,
    /// How many of them were asked of every primitive, too.
    pub brute_force_rays: usize,
    /// What a plain traversal visits, where it was counted.
    pub visits: Option<Visits>,
    /// Boxes that the plain traversal tests, times rays a second, over the peak.
    pub roofline_share: Option<f64>,
    /// Engines: octray first.
    pub engines: Vec<EngineReport>,
}

/// What was measured of an engine in one mode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EngineReport {
    /// Name of the ray tracer.
    pub engine: String,
    /// How it was built and is called.
    pub mode: String,
    /// Millions of rays a second.
    pub mrays_s: Spread,
    /// Rays that it answers differently than octray's plain traversal.
    pub differs: Difference,
    /// Hardware counters, where the kernel allows them.
    pub counters: Option<CounterReading>,
}

impl BuildReport {
    /// A build of so many primitives.
    pub fn new(engine: &str, mode: &str, prims: usize, seconds: f64, bytes: Option<f64>) -> Self {
        let prims = prims as f64;
        Self {
            engine: engine.into(),
            mode: mode.into(),
            seconds,
            // A clock that has not moved says that there was little to do, not that it was infinitely fast.
            mprims_s: prims / seconds.max(1e-9) / 1e6,
            bytes_a_prim: bytes.map(|bytes| bytes / prims),
        }
    }
}

impl ClassReport {
    /// octray's own row.
    pub fn octray(&self) -> Option<&EngineReport> {
        self.engines.first()
    }
    /// The fastest mode of a ray tracer.
    pub fn best_of(&self, engine: &str) -> Option<&EngineReport> {
        let modes = self.engines.iter().filter(|e| e.engine == engine);
        modes.max_by(|a, b| a.mrays_s.median.total_cmp(&b.mrays_s.median))
    }
    /// How many times as fast as the fastest mode of a ray tracer octray is.
    pub fn ratio_to(&self, engine: &str) -> Option<f64> {
        Some(self.octray()?.mrays_s.median / self.best_of(engine)?.mrays_s.median)
    }
    /// Share of rays that hit something.
    pub fn hit_share(&self) -> f64 {
        self.hits as f64 / self.rays.max(1) as f64
    }
}

impl SceneReport {
    /// Primitives of all kinds.
    pub fn primitives(&self) -> usize {
        self.triangles + self.spheres + self.cylinders
    }
}

impl Report {
    /// Names of the other ray tracers, each once.
    pub fn peers(&self) -> Vec<&str> {
        let classes = self.scenes.iter().flat_map(|scene| &scene.classes);
        let mut names: Vec<&str> = Vec::new();
        for engine in classes.flat_map(|class| class.engines.iter().skip(1)) {
            if !names.contains(&engine.engine.as_str()) {
                names.push(&engine.engine);
            }
        }
        names
    }
    /// Names of the classes of rays, each once.
    pub fn classes(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for class in self.scenes.iter().flat_map(|scene| &scene.classes) {
            if !names.contains(&class.class.as_str()) {
                names.push(&class.class);
            }
        }
        names
    }
}
