//! Scene text to a checked description.

use super::locate::Sources;
use super::words::explain;
use super::{DescribeError, Diagnostic, SceneDescription, overrides};
use serde::Deserialize;
use std::path::Path;
use toml::Spanned;
use toml::de::{DeTable, Deserializer};

/// The scene that `text` describes; `source_name` is what errors call it.
///
/// # Errors
/// [`DescribeError::Invalid`] with the place of everything that is wrong.
pub fn parse(text: &str, source_name: &str) -> Result<SceneDescription, DescribeError> {
    parse_with(text, source_name, &[])
}

/// The scene that `text` describes after the changes of `sets`, each `key=value`.
///
/// Keys are joined by dots, elements of arrays named by place or name: `camera.fov_deg=40`, `sphere.0.radius=2`,
/// `material.glass.ior=1.4`, `render.tier=exact`.
///
/// # Errors
/// [`DescribeError::Invalid`]; what comes from a change says so.
pub fn parse_with(text: &str, source_name: &str, sets: &[String]) -> Result<SceneDescription, DescribeError> {
    let sources = Sources { name: source_name, text, sets };
    let table = tree(&sources).map_err(one)?;
    let scene = SceneDescription::deserialize(Deserializer::from(table));
    let scene = scene.map_err(|error| one(explain(&sources, &error)))?;
    scene.check().map_err(|faults| locate_faults(&sources, faults))?;
    Ok(scene)
}

/// The scene in a file. Paths in it are relative to its folder.
///
/// # Errors
/// [`DescribeError`]: the file cannot be read, is not text, or is not a valid scene.
pub fn read(path: &Path) -> Result<SceneDescription, DescribeError> {
    read_with(path, &[])
}

/// The scene in a file after changes, as [`parse_with`].
///
/// # Errors
/// [`DescribeError`]: the file cannot be read, is not text, or is not a valid scene.
pub fn read_with(path: &Path, sets: &[String]) -> Result<SceneDescription, DescribeError> {
    let bytes =
        std::fs::read(path).map_err(|source| DescribeError::Read { path: path.to_owned(), source })?;
    let text = str::from_utf8(&bytes)
        .map_err(|error| DescribeError::NotText { path: path.to_owned(), offset: error.valid_up_to() })?;
    let mut scene = parse_with(text, &path.display().to_string(), sets)?;
    scene.folder = path.parent().unwrap_or(Path::new("")).to_owned();
    Ok(scene)
}

/// The parsed file with all changes applied, every key and value with its place.
fn tree<'a>(sources: &Sources<'a>) -> Result<Spanned<DeTable<'a>>, Diagnostic> {
    let mut table = DeTable::parse(sources.text).map_err(|error| explain(sources, &error))?;
    for (offset, argument) in sources.sets() {
        overrides::apply(&mut table, argument, offset)
            .map_err(|error| sources.diagnose(offset, error.message, error.help))?;
    }
    Ok(table)
}

fn one(diagnostic: Diagnostic) -> DescribeError {
    DescribeError::Invalid(vec![diagnostic])
}

/// Parses a second time for the places: only a scene with faults pays for that.
fn locate_faults(sources: &Sources<'_>, faults: Vec<super::Fault>) -> DescribeError {
    match tree(sources) {
        Ok(table) => {
            DescribeError::Invalid(faults.into_iter().map(|f| sources.diagnose_fault(&table, f)).collect())
        }
        Err(diagnostic) => one(diagnostic),
    }
}

#[cfg(test)]
mod tests;
