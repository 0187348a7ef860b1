//! The picture depends on the scene alone: not on threads, nor on which part of it is rendered.

mod common;

use common::{TIERS, builtin, film, film_with, in_tier, parse};
use octray::describe::{BuildQuality, Sampler, SceneDescription};

const BUILTINS: [&str; 6] = ["seed", "cornell", "spheres", "glass", "terrain:2000", "instances"];
/// Neither a multiple of a tile nor of a packet.
const SIZE: [u32; 2] = [45, 35];

fn bits(film: &octray::film::Film) -> Vec<[u32; 3]> {
    film.pixels.iter().map(|p| p.map(f32::to_bits)).collect()
}

/// Renders with several numbers of threads, and in parts.
fn check(name: &str, scene: &SceneDescription) {
    let whole = film_with(scene, 1, None);
    for threads in [2, 7] {
        assert_eq!(bits(&whole), bits(&film_with(scene, threads, None)), "{name}, {threads} threads");
    }
    let [x, y, width, height] = [7, 3, 34, 31];
    let part = film_with(scene, 2, Some([x, y, width, height]));
    for (row, column) in (0..height).flat_map(|r| (0..width).map(move |c| (r, c))) {
        let (in_part, in_whole) = (part.pixel(column, row), whole.pixel(x + column, y + row));
        assert_eq!(in_part.map(f32::to_bits), in_whole.map(f32::to_bits), "{name} at {column}, {row}");
    }
}

#[test]
fn threads_and_crops_do_not_change_a_bit() {
    for name in BUILTINS {
        for tier in TIERS {
            check(&format!("{name} {tier:?}"), &in_tier(builtin(name, SIZE, 2), tier));
        }
    }
}

#[test]
fn trees_of_any_quality_give_the_same_picture() {
    let sponza = common::shared("sponza/sponza.obj").map(|file| {
        let view = "[camera]\nposition = [-11, 3.5, 0.3]\nlook_at = [0, 4.5, 0]\nfov_deg = 70\n";
        let light = "[[light.point]]\nposition = [0, 8, 0]\nintensity = 60\n";
        (
            "sponza",
            parse(&format!(
                "{view}{light}[render]\nsize = [160, 120]\nspp = 2\n[[mesh]]\npath = '{}'\n",
                file.display()
            )),
        )
    });
    let builtins = BUILTINS.map(|name| (name, builtin(name, SIZE, 2)));
    for (name, mut scene) in builtins.into_iter().chain(sponza) {
        let balanced = film(&scene);
        for quality in [BuildQuality::Fast, BuildQuality::High] {
            scene.render.build_quality = quality;
            assert_eq!(bits(&balanced), bits(&film(&scene)), "{name}, {quality:?}");
        }
    }
}

#[test]
fn any_number_of_samples_and_any_sampler() {
    for spp in [1, 3, 17] {
        for sampler in [Sampler::Random, Sampler::Stratified, Sampler::Sobol] {
            let mut scene = bouncing();
            scene.render.spp = spp;
            scene.render.sampler = sampler;
            check(&format!("{spp} {sampler:?}"), &scene);
        }
    }
}

#[test]
fn another_seed_is_another_picture_of_the_same_thing() {
    let scene = bouncing();
    let mut other = scene.clone();
    other.render.seed = 1;
    let (a, b) = (film(&scene), film(&other));
    assert_ne!(bits(&a), bits(&b));
    let mean =
        |f: &octray::film::Film| f.pixels.iter().flatten().sum::<f32>() / (3.0 * f.pixels.len() as f32);
    assert!((mean(&a) - mean(&b)).abs() < 0.02 * mean(&a), "{} {}", mean(&a), mean(&b));
}

#[test]
fn textures_and_instances_of_files() {
    let folder = tempfile::tempdir().unwrap();
    let picture = image::RgbImage::from_fn(8, 8, |x, y| image::Rgb([32 * x as u8, 32 * y as u8, 90]));
    picture.save(folder.path().join("t.png")).unwrap();
    let obj = "mtllib m.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
               usemtl m\nf 1/1 2/2 3/3 4/4\n";
    std::fs::write(folder.path().join("m.mtl"), "newmtl m\nKd 1 1 1\nmap_Kd t.png\n").unwrap();
    std::fs::write(folder.path().join("q.obj"), obj).unwrap();
    let mut scene = parse(INSTANCES);
    scene.folder = folder.path().to_owned();
    check("textured instances", &scene);
    let colours: std::collections::HashSet<_> = bits(&film(&scene)).into_iter().collect();
    assert!(colours.len() > 100, "the texture is seen: {} colours", colours.len());
}

fn bouncing() -> SceneDescription {
    parse(&format!("{HEAD}{BOUNCING}"))
}

const HEAD: &str = "
[camera]
position = [0, 1, 5]
look_at = [0, 0, 0]
aperture_radius = 0.1
[render]
size = [45, 35]
spp = 3
max_depth = 4
filter = { kind = 'mitchell' }
[background]
bottom = [0.2, 0.3, 0.4]
top = [0.9, 0.9, 1.0]
[[light.point]]
position = [3, 4, 3]
intensity = 20
";

const BOUNCING: &str = "
[[material]]
name = 'matt'
bounce = true
[[material]]
name = 'glass'
kind = 'dielectric'
[[plane]]
point = [0, -1, 0]
normal = [0, 1, 0]
material = 'matt'
[[sphere]]
center = [-1, 0, 0]
radius = 1
material = 'matt'
[[sphere]]
center = [1.1, 0, 0]
radius = 1
material = 'glass'
";

const INSTANCES: &str = "
[camera]
position = [0, 0, 6]
look_at = [0, 0, 0]
[render]
size = [45, 35]
spp = 2
[[light.directional]]
direction = [0, 0, -1]
intensity = 1
[[mesh]]
name = 'quad'
path = 'q.obj'
[[instance]]
of = 'quad'
transform = [{ rotate_deg = { axis = [0, 0, 1], angle = 30 } }, { translate = [1.2, 0, -1] }]
[[instance]]
of = 'quad'
transform = [{ scale = [-0.5, 1.5, 1] }, { translate = [-1.4, 0, 0.5] }]
";
