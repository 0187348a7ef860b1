//! Scene text to a description and on to a compiled scene: an error or a scene, never a panic.
#![no_main]

use libfuzzer_sys::fuzz_target;
use octray::describe::{Mesh, SceneDescription, parse};
use octray::scene::Scene;

/// Most triangles that a procedural mesh may ask for here.
const TRIANGLES: u64 = 1000;

fuzz_target!(|text: &str| {
    let Ok(mut scene) = parse(text, "scene.toml") else { return };
    forget_files(&mut scene);
    if let Ok(scene) = Scene::compile(&scene) {
        assert!(scene.settings.size.iter().all(|&n| n > 0) && scene.settings.spp > 0);
    }
});

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
