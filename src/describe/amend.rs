//! `--set` on scenes that are no text: built-in ones, and those framed around a mesh.

use std::sync::OnceLock;

use super::{DescribeError, SceneDescription, parse_with};

/// Sections without objects: changing them alone needs no look at the objects, of which there may be many.
const SETTINGS: [&str; 5] = ["camera", "render", "background", "light", "material"];

/// A scene that is to be changed, perhaps many times: it is written out as text only once.
pub struct Amendable {
    scene: SceneDescription,
    settings: OnceLock<String>,
    whole: OnceLock<String>,
}

impl Amendable {
    /// The scene before any change.
    pub fn new(scene: SceneDescription) -> Self {
        Self { scene, settings: OnceLock::new(), whole: OnceLock::new() }
    }

    /// The scene before any change.
    pub fn scene(&self) -> &SceneDescription {
        &self.scene
    }

    /// The scene after changes, as [`SceneDescription::amended`].
    ///
    /// # Errors
    /// [`DescribeError::Invalid`], with the place in the scene written out as text or in the change.
    pub fn amended(&self, name: &str, sets: &[String]) -> Result<SceneDescription, DescribeError> {
        if sets.is_empty() {
            return Ok(self.scene.clone());
        }
        if !sets.iter().all(|set| only_settings(set)) {
            let text = self.whole.get_or_init(|| self.scene.to_toml());
            let folder = self.scene.folder.clone();
            return Ok(SceneDescription { folder, ..parse_with(text, name, sets)? });
        }
        let text = self.settings.get_or_init(|| self.scene.only_settings().to_toml());
        let SceneDescription { camera, render, background, light, material, .. } =
            parse_with(text, name, sets)?;
        Ok(SceneDescription { camera, render, background, light, material, ..self.scene.clone() })
    }
}

impl SceneDescription {
    /// The scene after changes, each `key=value` as for [`parse_with`]; `name` stands for the file in errors.
    ///
    /// # Errors
    /// [`DescribeError::Invalid`], with the place in the scene written out as text or in the change.
    pub fn amended(self, name: &str, sets: &[String]) -> Result<SceneDescription, DescribeError> {
        if sets.is_empty() { Ok(self) } else { Amendable::new(self).amended(name, sets) }
    }

    /// The same without objects.
    fn only_settings(&self) -> Self {
        Self {
            render: self.render.clone(),
            background: self.background.clone(),
            light: self.light.clone(),
            material: self.material.clone(),
            ..Self::new(self.camera.clone())
        }
    }
}

fn only_settings(set: &str) -> bool {
    let section = set.split(['.', '=']).next().unwrap_or("").trim();
    SETTINGS.contains(&section)
}

#[cfg(test)]
mod tests {
    use crate::describe::builtin;

    #[test]
    fn settings_change_and_objects_stay() {
        let seed = builtin("seed").unwrap().unwrap();
        let sets = ["render.spp=3".to_owned(), "material.glass.ior=1.2".to_owned()];
        let amended = seed.clone().amended("seed", &sets).unwrap();
        assert_eq!(amended.render.spp, 3);
        assert_eq!(amended.material.iter().find(|m| m.name == "glass").unwrap().ior, 1.2);
        assert_eq!((amended.sphere, amended.cylinder), (seed.sphere, seed.cylinder));
    }

    #[test]
    fn objects_can_be_changed_too() {
        let seed = builtin("seed").unwrap().unwrap();
        let amended = seed.amended("seed", &["sphere.0.radius=2".to_owned()]).unwrap();
        assert_eq!(amended.sphere[0].radius, 2.0);
    }

    #[test]
    fn unknown_keys_are_named() {
        let seed = builtin("seed").unwrap().unwrap();
        let error = seed.amended("seed", &["render.ssp=3".to_owned()]).unwrap_err();
        assert!(error.to_string().contains("spp"), "{error}");
    }
}
