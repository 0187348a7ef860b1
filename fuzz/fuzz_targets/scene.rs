//! Scene text to a description, a compiled scene and a tiny picture: an error or a picture, never a panic.
#![no_main]

use libfuzzer_sys::fuzz_target;
use octray::describe::{Mesh, SceneDescription, parse};
use octray::scene::Scene;
use octray::wavefront::{RenderOptions, render};

/// Most triangles that a procedural mesh may ask for here.
const TRIANGLES: u64 = 1000;

/// Most pixels along each side, samples and bounces of the picture: glass can double paths with each bounce.
const SIDE: u32 = 6;
const SAMPLES: u32 = 2;
const BOUNCES: u32 = 4;

fuzz_target!(|text: &str| {
    let Ok(mut scene) = parse(text, "scene.toml") else { return };
    forget_files(&mut scene);
    let asked = &mut scene.render;
    asked.size = asked.size.map(|n| n.min(SIDE));
    (asked.spp, asked.max_depth) = (asked.spp.min(SAMPLES), asked.max_depth.min(BOUNCES));
    if let Ok(scene) = Scene::compile(&scene) {
        paint(&scene);
    }
});

/// Every pixel gets its samples, and what is no number is counted and left out.
fn paint(scene: &Scene) {
    let [width, height] = scene.settings.size;
    let options = RenderOptions { threads: 1, ..RenderOptions::default() };
    let (film, report) = render(scene, &options).expect("nothing cancels it");
    let pixels = u64::from(width) * u64::from(height);
    assert_eq!((film.width, film.height, film.pixels.len() as u64), (width, height, pixels));
    assert_eq!(report.samples, pixels * u64::from(scene.settings.spp));
    assert!(!film.pixels.iter().flatten().any(|x| x.is_nan()), "a pixel is no number");
}

/// Leaves out what is another target's, or only takes long.
fn forget_files(scene: &mut SceneDescription) {
    for material in &mut scene.material {
        material.texture = None;
    }
    let here = |mesh: &Mesh| mesh.path.is_none();
    scene.mesh.retain(here);
    scene.group.iter_mut().for_each(|group| group.mesh.retain(here));
    let meshes = scene.mesh.iter_mut().chain(scene.group.iter_mut().flat_map(|group| &mut group.mesh));
    for made in meshes.filter_map(|mesh| mesh.procedural.as_mut()) {
        made.triangles = made.triangles.min(TRIANGLES);
    }
}
