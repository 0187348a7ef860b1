//! What is counted. Scenes and rays are those of `octray bench`, made outside of the count; in the default tier, and a few in
//! the others, so that none of the three gets slower beside the others unnoticed.

use std::hint::black_box;

use octray::accel::{Accel, Quality};
use octray::describe::builtin;
use octray::intersect::{Exact, Fast, Tier, TierName, Watertight};
use octray::measure::bench::{Answers, Class, Octray, Subject, View, agree, ask, ray_set};
use octray::scene::Scene;
use octray::wavefront::{RenderOptions, render};

use crate::common::terrain_columns;

const SCENES: [&str; 3] = ["terrain:5000", "spheres", "instances"];
const CLASSES: [Class; 3] = [Class::Primary, Class::Shadow, Class::Diffuse];
const SIZE: [u32; 2] = [96, 96];
const TRIANGLES: u64 = 20_000;
const SPP: u32 = 2;

pub(crate) enum Case {
    /// Rays of a class through a scene, in a tier.
    Rays(&'static str, Class, TierName),
    /// A tree over a terrain.
    Tree(Quality),
    /// A scene as a picture, in a tier.
    Picture(&'static str, TierName),
}

pub(crate) fn all() -> Vec<Case> {
    let rays =
        |tier| SCENES.into_iter().flat_map(move |scene| CLASSES.map(|class| Case::Rays(scene, class, tier)));
    let pictures = |tier| ["seed", "glass"].map(|scene| Case::Picture(scene, tier));
    let others = [TierName::Fast, TierName::Exact].into_iter().flat_map(|tier| {
        let rays =
            rays(tier).filter(|case| matches!(case, Case::Rays(_, Class::Primary | Class::Diffuse, _)));
        rays.chain(pictures(tier))
    });
    let trees = [Quality::Fast, Quality::Balanced, Quality::High].map(Case::Tree);
    rays(TierName::Watertight).chain(trees).chain(pictures(TierName::Watertight)).chain(others).collect()
}

impl Case {
    pub(crate) fn name(&self) -> String {
        let of = |tier: &TierName| match tier {
            TierName::Watertight => String::new(),
            tier => format!(" {}", tier.name()),
        };
        match self {
            Self::Rays(scene, class, tier) => format!("{scene} {class}{}", of(tier)),
            Self::Tree(quality) => format!("tree {}", quality.name()),
            Self::Picture(scene, tier) => format!("picture {scene}{}", of(tier)),
        }
    }

    /// The function whose instructions count; without one those of the whole process do.
    pub(crate) fn counted_function(&self) -> Option<&'static str> {
        // Pictures are rendered by threads of their own, which that function is not on the stack of.
        (!matches!(self, Self::Picture(..))).then_some("*counted_work*")
    }

    pub(crate) fn run(&self) {
        match *self {
            Self::Rays(scene, class, TierName::Fast) => rays::<Fast>(scene, class),
            Self::Rays(scene, class, TierName::Watertight) => rays::<Watertight>(scene, class),
            Self::Rays(scene, class, TierName::Exact) => rays::<Exact>(scene, class),
            Self::Tree(quality) => tree(quality),
            Self::Picture(scene, tier) => picture(scene, tier),
        }
    }
}

/// One symbol in the program, so that Valgrind can be told of it.
#[inline(never)]
fn counted_work(work: &mut (dyn FnMut() + Send)) {
    work();
    // Else the call is a jump, and the function is left before its work begins.
    black_box(());
}

/// By one thread: with more, who does what is chance.
fn counted(mut work: impl FnMut() + Send) {
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread can be started");
    alone.install(|| counted_work(&mut work));
}

fn compiled(name: &str, spp: u32, tier: TierName) -> Scene {
    let mut scene = builtin(name).expect("a built-in scene").expect("a built-in scene");
    (scene.render.size, scene.render.spp) = (SIZE, spp);
    let mut scene = Scene::compile(&scene).expect("built-in scenes compile");
    scene.settings.tier = tier;
    scene
}

fn rays<T: Tier>(scene: &str, class: Class) {
    let subject =
        Subject::new(scene.into(), compiled(scene, 1, T::NAME), View::Scene).expect("it holds primitives");
    let (rays, question) = (ray_set(&subject, class, SIZE), class.question());
    let engines = [Octray::<T>::new(&subject.accel), Octray::plain(&subject.accel)];
    let [mut answers, mut plain] = [(); 2].map(|()| Answers::new(question, rays.len()));
    counted(|| ask(&engines[0], question, black_box(&rays), &mut answers));
    ask(&engines[1], question, &rays, &mut plain);
    agree("the counted one", &answers, &plain, T::NAME).expect("the answers of single rays");
    assert!(plain.count() * 50 > rays.len(), "nothing but misses");
}

fn tree(quality: Quality) {
    let geometry = terrain_columns(TRIANGLES);
    let mut tree = None;
    counted(|| tree = Some(Accel::build_with(black_box(&geometry), quality)));
    let references = tree.map_or(0, |tree: Accel| tree.reference_count());
    assert!(references as u64 >= geometry.triangles.len() as u64, "primitives are missing");
}

fn picture(name: &str, tier: TierName) {
    let scene = compiled(name, SPP, tier);
    let options = RenderOptions { threads: 1, ..Default::default() };
    let (film, _) = render(black_box(&scene), &options).expect("nothing cancels it");
    assert!(film.pixels.iter().any(|&pixel| pixel != film.pixels[0]), "a picture of one colour");
}
