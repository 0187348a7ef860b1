//! Short ways to scenes and films, for the integration tests.
#![allow(dead_code, reason = "each test file uses some of these")]

use std::path::PathBuf;

use octray::describe::{self, SceneDescription, Tier};
use octray::film::Film;
use octray::scene::Scene;
use octray::wavefront::{RenderOptions, render};

/// A built-in scene at this size and number of samples.
pub(crate) fn builtin(name: &str, size: [u32; 2], spp: u32) -> SceneDescription {
    let mut scene = describe::builtin(name).unwrap().unwrap();
    scene.render.size = size;
    scene.render.spp = spp;
    scene
}

/// The scene of a file's text.
pub(crate) fn parse(text: &str) -> SceneDescription {
    describe::parse(text, "test.toml").unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// The scene with one sample a pixel, through the pixel's centre, and no path cut for being dim.
pub(crate) fn at_centres(mut scene: SceneDescription) -> SceneDescription {
    scene.render.spp = 1;
    scene.render.filter.radius = Some(0.0);
    scene.render.min_throughput = 0.0;
    scene
}

pub(crate) fn in_tier(mut scene: SceneDescription, tier: Tier) -> SceneDescription {
    scene.render.tier = tier;
    scene
}

/// The film of a scene, rendered by two threads.
pub(crate) fn film(scene: &SceneDescription) -> Film {
    film_with(scene, 2, None)
}

pub(crate) fn film_with(scene: &SceneDescription, threads: usize, crop: Option<[u32; 4]>) -> Film {
    let compiled = Scene::compile(scene).unwrap();
    let (film, report) =
        render(&compiled, &RenderOptions { threads, crop, ..RenderOptions::default() }).unwrap();
    assert_eq!(report.nan_samples, 0);
    film
}

/// A file of the shared scene collection, or nothing and a line that says so.
pub(crate) fn shared(path: &str) -> Option<PathBuf> {
    let file = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/scenes").join(path);
    if file.exists() {
        return Some(file);
    }
    println!("skipped: {} is not there", file.display());
    None
}

pub(crate) const TIERS: [Tier; 3] = [Tier::Fast, Tier::Watertight, Tier::Exact];
