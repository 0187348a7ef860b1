//! Which pictures show one scene, and which scenes differ in nothing but transforms.

use std::collections::HashMap;

use blake3::Hash;

use crate::describe::{Camera, Lights, Render, SceneDescription};

/// How changes begin that have no part in what is costly.
const OF_VIEWS: [&str; 5] = ["camera.", "light.", "render.seed=", "render.size=", "render.spp="];

/// What of a scene is costly to compile, hashed.
#[derive(Clone, Copy)]
pub(super) struct Likeness {
    scene: Hash,
    shape: Hash,
}

impl Likeness {
    /// That of a scene as a picture describes it: camera, lights and most settings are no part of it. Pictures that change
    /// nothing else with their `sets` have no need of it: they show the job's scene.
    pub(super) fn of(description: &SceneDescription, sets: &[String]) -> Option<Self> {
        if sets.iter().all(|set| OF_VIEWS.iter().any(|key| set.starts_with(key))) {
            return None;
        }
        let mut costly = costly(description);
        let scene = key(&costly);
        costly.forget_transforms();
        Some(Self { scene, shape: key(&costly) })
    }
}

/// Numbers of scenes and shapes, in the order in which pictures show them.
#[derive(Default)]
pub(super) struct Numbers {
    scenes: HashMap<Option<Hash>, u32>,
    shapes: HashMap<Option<Hash>, u32>,
}

impl Numbers {
    /// The numbers of a scene and of its shape.
    pub(super) fn of(&mut self, likeness: Option<Likeness>) -> (u32, u32) {
        let (scene, shape) = (likeness.map(|it| it.scene), likeness.map(|it| it.shape));
        (number(&mut self.scenes, scene), number(&mut self.shapes, shape))
    }
}

fn number(known: &mut HashMap<Option<Hash>, u32>, key: Option<Hash>) -> u32 {
    let next = known.len() as u32;
    *known.entry(key).or_insert(next)
}

fn costly(description: &SceneDescription) -> SceneDescription {
    let (render, aovs) = (&description.render, &description.render.aovs);
    let mut costly = SceneDescription {
        camera: Camera::perspective([0.0; 3], [0.0, 0.0, 1.0], 40.0),
        light: Lights::default(),
        ..description.clone()
    };
    costly.render = Render {
        build_quality: render.build_quality,
        tier: render.tier,
        aovs: aovs.clone(),
        ..Render::default()
    };
    costly
}

fn key(costly: &SceneDescription) -> Hash {
    blake3::hash(&serde_json::to_vec(costly).expect("a description has only text and numbers"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers_of(pictures: &[&str]) -> Vec<(u32, u32)> {
        let base = "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n\
            transform = [{ translate = [0, 0, 0] }]\n";
        let mut numbers = Numbers::default();
        let number = |sets: &&str| {
            let sets: Vec<String> = sets.split_whitespace().map(str::to_owned).collect();
            let scene = crate::describe::parse_with(base, "scene.toml", &sets).unwrap();
            numbers.of(Likeness::of(&scene, &sets))
        };
        pictures.iter().map(number).collect()
    }

    #[test]
    fn views_show_one_scene() {
        let views = ["camera.fov_deg=30", "camera.fov_deg=40 render.seed=3", "render.spp=2"];
        assert_eq!(numbers_of(&views), [(0, 0); 3]);
    }

    #[test]
    fn what_moves_keeps_its_shape_and_what_grows_does_not() {
        let moved = |x| format!("sphere.0.transform.0.translate=[{x},0,0]");
        let (here, there, back) = (moved(0), moved(1), moved(0) + " camera.fov_deg=9");
        assert_eq!(numbers_of(&[&here, &there, &back]), [(0, 0), (1, 0), (0, 0)]);
        assert_eq!(numbers_of(&["sphere.0.radius=1", "sphere.0.radius=2"]), [(0, 0), (1, 1)]);
        assert_eq!(numbers_of(&["render.tier=exact", "render.tier=fast"]), [(0, 0), (1, 1)]);
    }
}
