//! Where a scene comes from.

use std::convert::Infallible;
use std::fmt;
use std::path::{Path, PathBuf};

use crate::describe::is_file_name;
use crate::load;

/// Where a scene comes from, by the look of its name: the file system is not asked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SceneSource {
    /// Standard input, as TOML.
    Stdin,
    /// A scene file or a mesh.
    File(PathBuf),
    /// A built-in scene, perhaps with a number, such as `terrain:1000`.
    BuiltIn(String),
}

impl SceneSource {
    /// The source that `text` names: `-` is standard input; a dot or a path separator makes it a file, so that
    /// `./seed` is a file and `seed` a built-in scene.
    pub fn parse(text: &str) -> Result<Self, Infallible> {
        Ok(match text {
            "-" => Self::Stdin,
            _ if is_file_name(text) => Self::File(text.into()),
            _ => Self::BuiltIn(text.into()),
        })
    }

    /// Whether it is a mesh without a scene.
    pub fn is_mesh(&self) -> bool {
        matches!(self, Self::File(path) if load::is_mesh(path))
    }

    /// A short name for messages and for the picture's file: `bunny` for `meshes/bunny.obj`.
    pub fn stem(&self) -> String {
        match self {
            Self::Stdin => "stdin".into(),
            Self::File(path) => path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy().into_owned(),
            // A colon in a file's name is not allowed everywhere.
            Self::BuiltIn(name) => name.replace(':', "-"),
        }
    }

    /// The folder that relative paths in the scene start from.
    pub fn folder(&self) -> &Path {
        match self {
            Self::File(path) => path.parent().unwrap_or(Path::new("")),
            _ => Path::new(""),
        }
    }
}

impl fmt::Display for SceneSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stdin => f.write_str("standard input"),
            Self::File(path) => write!(f, "{}", path.display()),
            Self::BuiltIn(name) => f.write_str(name),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(text: &str) -> SceneSource {
        SceneSource::parse(text).unwrap()
    }

    #[test]
    fn names_tell_the_source() {
        assert_eq!(source("-"), SceneSource::Stdin);
        for file in ["a.toml", "bunny.obj", "./seed", "folder/seed", "/a", "..", "scene.txt"] {
            assert_eq!(source(file), SceneSource::File(file.into()), "{file}");
        }
        for name in ["seed", "terrain:1000", "no-such-scene", ""] {
            assert_eq!(source(name), SceneSource::BuiltIn(name.into()), "{name}");
        }
    }

    #[test]
    fn stems_are_file_names() {
        let stems = ["-", "meshes/bunny.obj", "seed", "terrain:1000", ".."].map(|text| source(text).stem());
        assert_eq!(stems, ["stdin", "bunny", "seed", "terrain-1000", ".."]);
    }

    #[test]
    fn paths_start_beside_the_scene_file() {
        assert_eq!(source("a/b.toml").folder(), Path::new("a"));
        assert_eq!(source("b.toml").folder(), Path::new(""));
        assert_eq!(source("-").folder(), Path::new(""));
    }
}
