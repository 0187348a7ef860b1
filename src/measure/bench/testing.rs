//! Small subjects, and an engine that lies.

use super::engine::Engine;
use super::rays::{HitColumns, RayColumns};
use super::subject::Subject;
use super::view::View;
use crate::describe::builtin;
use crate::scene::Scene;

/// A built-in scene for a picture of 64x64 pixels.
pub(super) fn subject(name: &str, view: View) -> Subject {
    let mut description = builtin(name).unwrap().unwrap();
    description.render.size = [64, 64];
    Subject::new(name.into(), Scene::compile(&description).unwrap(), view).unwrap()
}

/// Answers as another engine, but one ray differently.
pub(super) struct Liar<E> {
    pub(super) honest: E,
    pub(super) ray: usize,
    /// What is added to its distance.
    pub(super) off: f32,
}

impl<E: Engine> Engine for Liar<E> {
    fn name(&self) -> &'static str {
        "liar"
    }
    fn mode(&self) -> String {
        "lying".into()
    }
    fn closest(&self, rays: RayColumns<'_>, hits: HitColumns<'_>) {
        let HitColumns { t, prim } = hits;
        self.honest.closest(rays, HitColumns { t, prim });
        t[self.ray] += self.off;
    }
    fn any(&self, rays: RayColumns<'_>, occluded: &mut [bool]) {
        self.honest.any(rays, occluded);
        occluded[self.ray] ^= true;
    }
}
