//! The seam between the bench and what it measures.

use rayon::prelude::*;

use super::classes::Question;
use super::rays::{HitColumns, Hits, RayColumns, RaySet};

/// Rays that one of several threads takes at a time.
const RAYS_PER_TASK: usize = 1 << 14;

/// Something that answers rays: one ray tracer in one mode.
pub trait Engine: Sync {
    /// Name of the ray tracer.
    fn name(&self) -> &'static str;
    /// How it was built and is called.
    fn mode(&self) -> String;
    /// Fills in the nearest hit of each ray.
    fn closest(&self, rays: RayColumns<'_>, hits: HitColumns<'_>);
    /// Fills in whether each ray hits anything.
    fn any(&self, rays: RayColumns<'_>, occluded: &mut [bool]);
}

/// Answers of an engine to a class of rays.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Answers {
    /// Nearest hits, where they were asked for.
    pub hits: Hits,
    /// Whether there is any hit, where that was asked for.
    pub occluded: Vec<bool>,
}

impl Answers {
    /// Room for the answers to a question put to `len` rays.
    pub fn new(question: Question, len: usize) -> Self {
        match question {
            Question::Closest => Self { hits: Hits::new(len), occluded: Vec::new() },
            Question::Any => Self { hits: Hits::default(), occluded: vec![false; len] },
        }
    }
    /// How many rays hit something.
    pub fn count(&self) -> usize {
        self.hits.count() + self.occluded.iter().filter(|&&is| is).count()
    }
}

/// Puts a question to an engine, by one thread at once, or shared by the threads of the current rayon pool.
pub fn ask(engine: &dyn Engine, question: Question, rays: &RaySet, answers: &mut Answers) {
    let size = match rayon::current_num_threads() {
        1 => rays.len().max(1),
        _ => RAYS_PER_TASK,
    };
    match question {
        Question::Closest => {
            let Hits { t, prim } = &mut answers.hits;
            let places = t.par_chunks_mut(size).zip(prim.par_chunks_mut(size)).enumerate();
            places.for_each(|(i, (t, prim))| {
                engine.closest(task(rays, i * size, t.len()), HitColumns { t, prim });
            });
        }
        Question::Any => {
            let places = answers.occluded.par_chunks_mut(size).enumerate();
            places.for_each(|(i, occluded)| engine.any(task(rays, i * size, occluded.len()), occluded));
        }
    }
}

fn task(rays: &RaySet, first: usize, len: usize) -> RayColumns<'_> {
    rays.columns().slice(first..first + len)
}
