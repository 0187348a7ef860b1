//! The way from a scene's name to a film, for the verbs.
//!
//! The stages describe, load, scene and wavefront are joined here and nowhere else in the command line.

use std::io::Read;
use std::time::{Duration, Instant};

use super::begun;
use super::error::{CliError, Exit};
use super::source::SceneSource;
use super::threads::pool;
use crate::batch::Job;
use crate::describe::{self, DescribeError, Origin, SceneDescription};
use crate::load::{KeptMeshes, framed};
use crate::scene::Scene;

pub(super) use crate::wavefront::{
    Goal, Progress, Reached, RenderError, RenderOptions, RenderReport, render,
};

/// A scene ready to render, and its name.
pub(super) struct Opened {
    pub(super) name: String,
    pub(super) scene: Scene,
    /// Reading and checking it, meshes included.
    pub(super) load_time: Duration,
    /// From the program's begin until now, without loading and building.
    pub(super) start_time: Duration,
}

/// Reads the scene, applies `assignments` in order, compiles it with as many threads as `--threads` says.
///
/// **Errors**: exit 3 for a bad scene or asset, 2 for a bad assignment.
pub(super) fn open(
    source: &SceneSource,
    assignments: &[(String, String)],
    threads: u16,
) -> Result<Opened, CliError> {
    open_changed(source, assignments, threads, |_| {})
}

/// [`open`], with a last change to the description.
pub(super) fn open_changed(
    source: &SceneSource,
    assignments: &[(String, String)],
    threads: u16,
    change: impl FnOnce(&mut SceneDescription),
) -> Result<Opened, CliError> {
    let sets: Vec<String> = assignments.iter().map(|(key, value)| format!("{key}={value}")).collect();
    let meshes = KeptMeshes::keeping();
    // Scene files are quickly read: only bare meshes are worth threads before it is known what there is.
    let workers = if source.is_mesh() { Some(pool(threads)?) } else { None };
    let read = || describe(source, &sets, &meshes);
    let reading = Instant::now();
    let mut description = workers.as_ref().map_or_else(read, |workers| workers.install(read))?;
    let read_time = reading.elapsed();
    change(&mut description);
    let threads = if is_small(&description) { 1 } else { threads };
    let workers = workers.map_or_else(|| pool(threads), Ok)?;
    let scene = workers.install(|| compile(&description, &meshes))?;
    let load_time = read_time + scene.times.load;
    let start_time = begun::elapsed().saturating_sub(load_time + scene.times.build);
    Ok(Opened { name: source.to_string(), scene, load_time, start_time })
}

/// Fewer shapes are compiled by one thread sooner than others could be started.
const FEW_SHAPES: usize = 1000;

fn is_small(scene: &SceneDescription) -> bool {
    let shapes = scene.sphere.len() + scene.cylinder.len() + scene.triangle.len() + scene.quad.len();
    shapes < FEW_SHAPES && scene.mesh.is_empty() && scene.group.is_empty()
}

fn compile(description: &SceneDescription, meshes: &KeptMeshes) -> Result<Scene, CliError> {
    Scene::compile_with(description, meshes).map_err(|error| CliError::of(Exit::Scene, error))
}

/// Compiles a scene in the current rayon pool for a picture of a size, a mesh alone: without floor, materials and normals.
///
/// **Errors**: as [`open`].
pub(super) fn open_bare(source: &SceneSource, size: [u32; 2]) -> Result<Scene, CliError> {
    let meshes = KeptMeshes::keeping();
    let mut description = describe(source, &[], &meshes)?;
    description.render.size = size;
    if source.is_mesh() {
        let floor = description.quad.pop();
        for mesh in &mut description.mesh {
            // Any material in place of the file's own, so that those are not read.
            mesh.material = floor.as_ref().and_then(|floor| floor.material.clone());
            mesh.normals = false;
        }
    }
    compile(&description, &meshes)
}

fn describe(
    source: &SceneSource,
    sets: &[String],
    meshes: &KeptMeshes,
) -> Result<SceneDescription, CliError> {
    match source {
        SceneSource::Stdin => {
            let mut text = String::new();
            let read = std::io::stdin().read_to_string(&mut text);
            read.map_err(|error| CliError::new(Exit::Failed, "cannot read standard input").because(error))?;
            describe::parse_with(&text, "standard input", sets).map_err(refused)
        }
        SceneSource::File(path) if source.is_mesh() => {
            let scene = framed(path, meshes).map_err(|error| CliError::of(Exit::Scene, error))?;
            scene.amended(&source.to_string(), sets).map_err(refused)
        }
        SceneSource::File(path) => describe::read_with(path, sets).map_err(|error| match Job::read(path) {
            Ok(_) => CliError::new(
                Exit::Scene,
                error.to_string() + "\n  note: this is a job: octray batch renders it",
            ),
            Err(_) => refused(error),
        }),
        SceneSource::BuiltIn(name) => builtin(name)?.amended(name, sets).map_err(refused),
    }
}

fn builtin(name: &str) -> Result<SceneDescription, CliError> {
    let scene = describe::builtin(name).map_err(|error| CliError::of(Exit::Usage, error))?;
    scene.ok_or_else(|| CliError::new(Exit::Usage, describe::unknown_builtin(name)))
}

/// A description's fault: of use where all of it is in arguments, of the scene otherwise.
fn refused(error: DescribeError) -> CliError {
    let of_use = match &error {
        DescribeError::Invalid(all) => all.iter().all(|d| matches!(d.origin, Origin::Set { .. })),
        _ => false,
    };
    CliError::of(if of_use { Exit::Usage } else { Exit::Scene }, error)
}

/// A built-in scene as a scene file.
pub(super) fn builtin_toml(name: &str) -> Result<String, CliError> {
    builtin(name).map(|scene| scene.to_toml())
}
