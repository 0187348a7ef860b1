//! What is counted. Scenes and rays are those of `octray bench`, in its default tier, and made outside of the count.

use std::hint::black_box;

use octray::accel::{Accel, Quality};
use octray::describe::builtin;
use octray::intersect::{TierName, Watertight};
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
    /// Rays of a class through a scene.
    Rays(&'static str, Class),
    /// A tree over a terrain.
    Tree(Quality),
    /// A scene as a picture.
    Picture(&'static str),
}

pub(crate) fn all() -> Vec<Case> {
    let rays = SCENES.into_iter().flat_map(|scene| CLASSES.map(|class| Case::Rays(scene, class)));
    let trees = [Quality::Fast, Quality::Balanced, Quality::High].map(Case::Tree);
    let pictures = ["seed", "glass"].map(Case::Picture);
    rays.chain(trees).chain(pictures).collect()
}

impl Case {
    pub(crate) fn name(&self) -> String {
        match self {
            Self::Rays(scene, class) => format!("{scene} {class}"),
            Self::Tree(quality) => format!("tree {}", quality.name()),
            Self::Picture(scene) => format!("picture {scene}"),
        }
    }

    /// The function whose instructions count; without one those of the whole process do.
    pub(crate) fn counted_function(&self) -> Option<&'static str> {
        // Pictures are rendered by threads of their own, which that function is not on the stack of.
        (!matches!(self, Self::Picture(_))).then_some("*counted_work*")
    }

    pub(crate) fn run(&self) {
        match *self {
            Self::Rays(scene, class) => rays(scene, class),
            Self::Tree(quality) => tree(quality),
            Self::Picture(scene) => picture(scene),
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

fn compiled(name: &str, spp: u32) -> Scene {
    let mut scene = builtin(name).expect("a built-in scene").expect("a built-in scene");
    (scene.render.size, scene.render.spp) = (SIZE, spp);
    Scene::compile(&scene).expect("built-in scenes compile")
}

fn rays(scene: &str, class: Class) {
    let subject = Subject::new(scene.into(), compiled(scene, 1), View::Scene).expect("it holds primitives");
    let (rays, question) = (ray_set(&subject, class, SIZE), class.question());
    let engines = [Octray::<Watertight>::new(&subject.accel), Octray::plain(&subject.accel)];
    let [mut answers, mut plain] = [(); 2].map(|()| Answers::new(question, rays.len()));
    counted(|| ask(&engines[0], question, black_box(&rays), &mut answers));
    ask(&engines[1], question, &rays, &mut plain);
    agree("the counted one", &answers, &plain, TierName::Watertight).expect("the answers of single rays");
    assert!(plain.count() * 50 > rays.len(), "nothing but misses");
}

fn tree(quality: Quality) {
    let geometry = terrain_columns(TRIANGLES);
    let mut tree = None;
    counted(|| tree = Some(Accel::build_with(black_box(&geometry), quality)));
    let references = tree.map_or(0, |tree: Accel| tree.reference_count());
    assert!(references as u64 >= geometry.triangles.len() as u64, "primitives are missing");
}

fn picture(name: &str) {
    let scene = compiled(name, SPP);
    let options = RenderOptions { threads: 1, ..Default::default() };
    let (film, _) = render(black_box(&scene), &options).expect("nothing cancels it");
    assert!(film.pixels.iter().any(|&pixel| pixel != film.pixels[0]), "a picture of one colour");
}
