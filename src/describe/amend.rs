//! `--set` on scenes that are no text: built-in ones, and those framed around a mesh.

use super::{DescribeError, SceneDescription, parse_with};

/// Sections without objects: changing them alone needs no look at the objects, of which there may be many.
const SETTINGS: [&str; 5] = ["camera", "render", "background", "light", "material"];

impl SceneDescription {
    /// The scene after changes, each `key=value` as for [`parse_with`]; `name` stands for the file in errors.
    ///
    /// # Errors
    /// [`DescribeError::Invalid`], with the place in the scene written out as text or in the change.
    pub fn amended(mut self, name: &str, sets: &[String]) -> Result<SceneDescription, DescribeError> {
        if sets.is_empty() {
            return Ok(self);
        }
        let aside = sets.iter().all(|set| only_settings(set)).then(|| self.take_objects());
        let mut amended = parse_with(&self.to_toml(), name, sets)?;
        amended.folder = self.folder;
        if let Some(mut objects) = aside {
            std::mem::swap(&mut amended.camera, &mut objects.camera);
            std::mem::swap(&mut amended.render, &mut objects.render);
            std::mem::swap(&mut amended.background, &mut objects.background);
            std::mem::swap(&mut amended.light, &mut objects.light);
            std::mem::swap(&mut amended.material, &mut objects.material);
            objects.folder = amended.folder;
            return Ok(objects);
        }
        Ok(amended)
    }

    /// Everything but settings, leaving a scene of settings alone.
    fn take_objects(&mut self) -> SceneDescription {
        let mut settings = SceneDescription::new(self.camera.clone());
        settings.render = self.render.clone();
        settings.background = self.background.clone();
        settings.light = self.light.clone();
        settings.material = self.material.clone();
        settings.folder = self.folder.clone();
        std::mem::replace(self, settings)
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
