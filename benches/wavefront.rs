//! Whole renders in camera samples a second, and what a scene pays for that it does not require.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use octray::describe::{Material, MaterialKind, SceneDescription, Tier, builtin};
use octray::film::Film;
use octray::scene::Scene;
use octray::wavefront::{RenderOptions, render};
use std::hint::black_box;

const SIZE: [u32; 2] = [96, 72];
const SPP: u32 = 4;
const TIERS: [(&str, Tier); 3] =
    [("fast", Tier::Fast), ("watertight", Tier::Watertight), ("exact", Tier::Exact)];

fn small(name: &str, tier: Tier) -> SceneDescription {
    let mut scene = builtin(name).expect("a built-in scene").expect("a built-in scene");
    (scene.render.size, scene.render.spp, scene.render.tier) = (SIZE, SPP, tier);
    scene
}

fn compiled(description: &SceneDescription) -> Scene {
    Scene::compile(description).expect("built-in scenes compile")
}

fn film(scene: &Scene, threads: usize) -> Film {
    render(scene, &RenderOptions { threads, ..Default::default() }).expect("nothing cancels it").0
}

/// The bits of all pixels, mixed (FNV-1a, 64 bits).
fn checksum(film: &Film) -> u64 {
    let words = film.pixels.as_flattened().iter().map(|x| u64::from(x.to_bits()));
    words.fold(0xcbf2_9ce4_8422_2325, |sum, word| (sum ^ word).wrapping_mul(0x100_0000_01b3))
}

/// Renders twice, with one thread and with two: the same bytes, and a picture with something in it.
fn checked(scene: &Scene) -> u64 {
    let (one, two) = (film(scene, 1), film(scene, 2));
    assert_eq!(checksum(&one), checksum(&two), "the picture depends on the number of threads");
    assert!(one.pixels.iter().any(|&pixel| pixel != one.pixels[0]), "a picture of one colour");
    checksum(&one)
}

fn measure(c: &mut Criterion, group: &str, benches: &[(&str, &str, Scene)]) {
    let mut group = c.benchmark_group(group);
    group.sample_size(10).throughput(Throughput::Elements(u64::from(SIZE[0] * SIZE[1] * SPP)));
    for (name, parameter, scene) in benches {
        group.bench_function(BenchmarkId::new(*name, parameter), |b| b.iter(|| film(black_box(scene), 1)));
    }
    group.finish();
}

fn whole(c: &mut Criterion) {
    let each = |name: &'static str| TIERS.map(|(label, tier)| (name, label, compiled(&small(name, tier))));
    let benches: Vec<_> = ["seed", "spheres", "glass"].into_iter().flat_map(each).collect();
    for (_, _, scene) in &benches {
        checked(scene);
    }
    measure(c, "wavefront/render", &benches);
}

/// `seed` with every body made matt: nothing is reflected or refracted.
fn matt() -> SceneDescription {
    let mut scene = small("seed", Tier::Watertight);
    for material in &mut scene.material {
        material.kind = MaterialKind::Diffuse;
    }
    scene
}

/// The same picture from a file that also declares mirrors and glasses that nothing is made of.
fn with_unused_materials() -> SceneDescription {
    let mut scene = matt();
    for i in 0..16 {
        scene.material.push(Material::new(format!("mirror {i}"), MaterialKind::Metal));
        scene.material.push(Material::new(format!("glass {i}"), MaterialKind::Dielectric));
    }
    scene
}

fn unused(c: &mut Criterion) {
    let [plain, declared] = [matt(), with_unused_materials()].map(|scene| compiled(&scene));
    assert_eq!(plain.requirements, declared.requirements, "materials that nothing is made of are required");
    assert_eq!(checked(&plain), checked(&declared));
    measure(c, "wavefront/unused", &[("seed", "none", plain), ("seed", "32 materials", declared)]);
}

criterion_group!(benches, whole, unused);
criterion_main!(benches);
