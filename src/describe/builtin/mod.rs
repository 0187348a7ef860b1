//! Scenes that need no file.

mod cornell;
mod glass;
mod instances;
mod parts;
mod seed;
mod spheres;
mod terrain;

use super::{DescribeError, SceneDescription};

/// A built-in scene in a list for people.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BuiltinScene {
    /// The name that [`builtin`] takes.
    pub name: &'static str,
    /// How the name is written in help texts: with its argument, if it takes one.
    pub usage: &'static str,
    /// What it shows, in one line.
    pub summary: &'static str,
}

const SCENES: [BuiltinScene; 6] = [
    scene(
        "seed",
        "seed",
        "five spheres and two cylinders before a wall, two lights: what is rendered without a scene",
    ),
    scene("cornell", "cornell", "a box with red and green walls, a glass and a metal sphere, two lights"),
    scene("spheres", "spheres", "10,000 spheres and 1,000 cylinders in a sunflower spiral"),
    scene(
        "glass",
        "glass",
        "dielectrics inside dielectrics: water in glass, bubbles, a lens, on a chequered floor",
    ),
    scene(
        "terrain",
        "terrain[:N]",
        "a hilly mesh of about N triangles (default 1,000,000, at most 200,000,000)",
    ),
    scene("instances", "instances", "groups and a mesh seen hundreds of times: turned, stretched, mirrored"),
];

const fn scene(name: &'static str, usage: &'static str, summary: &'static str) -> BuiltinScene {
    BuiltinScene { name, usage, summary }
}

/// All built-in scenes.
#[must_use]
pub fn builtin_scenes() -> &'static [BuiltinScene] {
    &SCENES
}

/// The built-in scene of a name, `None` when no scene is called so. `terrain:N` has about N triangles.
///
/// # Errors
/// [`DescribeError::Builtin`] when the part after the colon is not a fitting number.
pub fn builtin(name: &str) -> Result<Option<SceneDescription>, DescribeError> {
    Ok(Some(match name {
        "seed" => seed::scene(),
        "cornell" => cornell::scene(),
        "spheres" => spheres::scene(),
        "glass" => glass::scene(),
        "instances" => instances::scene(),
        _ => match name.strip_prefix("terrain") {
            Some(argument) if argument.is_empty() || argument.starts_with(':') => terrain::scene(argument)?,
            _ => return Ok(None),
        },
    }))
}

/// Whether a scene's name is that of a file: it has a dot or a path separator in it, so that `./seed` is a file and `seed` a
/// built-in scene. The file system is not asked.
pub(crate) fn is_file_name(name: &str) -> bool {
    name.contains('.') || name.contains(std::path::is_separator)
}

/// What to tell who asked for a built-in scene that there is not.
pub(crate) fn unknown_builtin(name: &str) -> String {
    let known = SCENES.each_ref().map(|scene| scene.usage).join(", ");
    format!("there is no built-in scene `{name}`: expected one of {known}, or a file's name with its ending")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_passes_the_check() {
        for scene in builtin_scenes() {
            builtin(scene.name).unwrap().unwrap().check().unwrap_or_else(|f| panic!("{}: {f:?}", scene.name));
        }
    }

    #[test]
    fn spheres_has_as_many_as_it_says() {
        let scene = builtin("spheres").unwrap().unwrap();
        assert_eq!((scene.sphere.len(), scene.cylinder.len()), (10_000, 1_000));
    }

    #[test]
    fn other_names_are_no_scene_and_bad_numbers_are_errors() {
        assert!(builtin("seeds").unwrap().is_none() && builtin("terrains").unwrap().is_none());
        for bad in ["terrain:", "terrain:many", "terrain:1", "terrain:999999999999", "terrain:-5"] {
            let message = builtin(bad).unwrap_err().to_string();
            assert!(message.contains(bad) && message.contains("200000000"), "{message}");
        }
        assert!(builtin("terrain:1_000").is_ok());
    }
}
