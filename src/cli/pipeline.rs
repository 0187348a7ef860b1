//! The way from a scene's name to a film, for the verbs.
//!
//! The stages below describe, scene and wavefront are joined here and nowhere else in the command line.
#![allow(dead_code, reason = "the stages that these types come from are not joined yet")]

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use super::error::{CliError, Exit};
use super::source::SceneSource;
use crate::film::{Film, Tone};

/// How far a render is.
pub(super) struct Progress {
    pub(super) pixels_done: u64,
    pub(super) pixels_total: u64,
    pub(super) rays: u64,
}

/// Rays by their reason.
#[derive(Default)]
pub(super) struct RayCounts {
    pub(super) camera: u64,
    pub(super) shadow: u64,
    pub(super) reflected: u64,
    pub(super) refracted: u64,
    pub(super) diffuse: u64,
}

/// What a render did.
pub(super) struct RenderReport {
    pub(super) rays: RayCounts,
    pub(super) samples: u64,
    pub(super) nan_samples: u64,
    pub(super) render_time: Duration,
    pub(super) threads: usize,
}

/// How a scene is rendered.
pub(super) struct RenderOptions<'a> {
    pub(super) threads: usize,
    pub(super) crop: Option<[u32; 4]>,
    pub(super) progress: Option<&'a (dyn Fn(Progress) + Sync)>,
    pub(super) cancel: Option<&'a AtomicBool>,
}

/// Why a render gave no film.
#[derive(Debug, thiserror::Error)]
pub(super) enum RenderError {
    #[error("cancelled")]
    Cancelled,
}

/// A scene ready to render.
pub(super) struct Opened {
    pub(super) name: String,
    pub(super) tone: Tone,
    pub(super) load_time: Duration,
    pub(super) build_time: Duration,
}

/// A built-in scene's name and what it shows.
pub(super) struct BuiltIn {
    pub(super) name: &'static str,
    pub(super) summary: &'static str,
}

/// Reads the scene, applies `assignments` in order, compiles it.
///
/// **Errors**: exit 3 for a bad scene or asset, 2 for a bad assignment.
pub(super) fn open(source: &SceneSource, _assignments: &[(String, String)]) -> Result<Opened, CliError> {
    Err(not_wired(&format!("cannot load {source}")))
}

/// Renders an opened scene.
pub(super) fn render(_scene: &Opened, _options: &RenderOptions) -> Result<(Film, RenderReport), RenderError> {
    Err(RenderError::Cancelled)
}

/// The text of `octray inspect`.
pub(super) fn inspect(_scene: &Opened) -> String {
    String::new()
}

/// Every built-in scene.
pub(super) fn builtin_scenes() -> Result<Vec<BuiltIn>, CliError> {
    Err(not_wired("cannot list scenes"))
}

/// A built-in scene as a scene file.
pub(super) fn builtin_toml(name: &str) -> Result<String, CliError> {
    Err(not_wired(&format!("cannot write {name}")))
}

/// The JSON Schema of scene files.
pub(super) fn schema() -> Result<String, CliError> {
    Err(not_wired("cannot print the schema"))
}

fn not_wired(context: &str) -> CliError {
    CliError::new(Exit::Failed, context).because("not wired")
}
