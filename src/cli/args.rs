//! What can be written on the command line.

mod choice;
mod render;

use clap::{Parser, Subcommand, ValueEnum, ValueHint};

use super::batch::{BatchArgs, MergeArgs, PlanArgs, RunArgs, StatusArgs};
use super::bench::BenchArgs;
use super::compare::CompareArgs;
use super::simd;
use super::source::SceneSource;
use super::tradeoff::TradeoffArgs;
use super::verify::VerifyArgs;
pub use choice::{BuildQuality, ProgressMode, Tier};
pub use render::RenderArgs;
pub(super) use render::parse_size;

const EXIT_CODES: &str = "\
Exit codes:
  0  done
  1  failed while running (files, a picture of a batch, octray render interrupted)
  2  wrong use
  3  bad scene or asset, damaged or changed files, incomplete work (octray merge)
  4  beyond a limit: slower than the baseline (octray bench), a documented bound broken (octray verify),
     pictures that differ by too much (octray compare)
  75 stopped by a signal; the same command goes on from there (octray run, octray batch)

Data goes to standard output, everything else to standard error. NO_COLOR is honoured.";

/// A data-oriented CPU ray tracer: a scene becomes a picture.
#[derive(Debug, Parser)]
#[command(name = "octray", version = simd::VERSION, after_help = EXIT_CODES, arg_required_else_help = true)]
pub struct Args {
    /// What to do.
    #[command(subcommand)]
    pub verb: Verb,
}

/// What the program can do.
#[derive(Debug, Subcommand)]
pub enum Verb {
    /// Render a scene to a picture
    Render(Box<RenderArgs>),
    /// Render all pictures of a job file here, or those that are not done yet
    Batch(Box<BatchArgs>),
    /// Cut the pictures of a job file into units and shards, for `octray run`
    Plan(Box<PlanArgs>),
    /// Render the units of a plan, or those of one shard, that are not done yet
    Run(Box<RunArgs>),
    /// Check that all units of a plan are there, and put pictures together
    Merge(MergeArgs),
    /// Say how much of a plan is done
    Status(StatusArgs),
    /// Show what a scene holds and which stages it needs
    Inspect(InspectArgs),
    /// Measure rays a second
    Bench(Box<BenchArgs>),
    /// Measure how exact the answers are, and whether the documented bounds hold
    Verify(Box<VerifyArgs>),
    /// Say how far two pictures differ
    Compare(CompareArgs),
    /// Measure what settings cost and bring, against a converged exact picture
    Tradeoff(TradeoffArgs),
    /// List the built-in scenes, or print one as a scene file
    Scenes(ScenesArgs),
    /// Print the JSON Schema of scene files or of job files
    Schema(SchemaArgs),
    /// Print the completion script of a shell
    Completions(CompletionsArgs),
    /// Print a manual page (to read it: octray man | man -l -)
    Man(ManArgs),
}

/// Which scene, and changes to it.
#[derive(Debug, clap::Args)]
pub struct SceneArgs {
    /// Scene file (TOML), mesh (OBJ, PLY, STL), `-` for standard input, or the name of a built-in scene
    #[arg(default_value = "seed", value_parser = SceneSource::parse, value_hint = ValueHint::FilePath)]
    pub scene: SceneSource,
    /// Replace a value of the scene, such as camera.fov_deg=40; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = parse_assignment)]
    pub assignments: Vec<(String, String)>,
}

/// Arguments of `octray inspect`.
#[derive(Debug, clap::Args)]
pub struct InspectArgs {
    /// How much work goes into building the tree
    #[arg(long, value_name = "HOW")]
    pub build_quality: Option<BuildQuality>,
    /// Which scene, and changes to it.
    #[command(flatten)]
    pub scene: SceneArgs,
}

/// Arguments of `octray scenes`.
#[derive(Debug, clap::Args)]
pub struct ScenesArgs {
    /// Print this scene as a scene file
    #[arg(long, value_name = "NAME")]
    pub write: Option<String>,
}

/// Arguments of `octray completions`.
#[derive(Debug, clap::Args)]
pub struct CompletionsArgs {
    /// The shell
    pub shell: clap_complete::Shell,
}

/// Arguments of `octray man`.
#[derive(Debug, clap::Args)]
pub struct ManArgs {
    /// The verb to describe [default: the whole program]
    pub verb: Option<String>,
}

/// Arguments of `octray schema`.
#[derive(Debug, clap::Args)]
pub struct SchemaArgs {
    /// Of which files
    #[arg(value_name = "WHICH", default_value = "scene")]
    pub of: SchemaOf,
}

/// Files that users write.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SchemaOf {
    /// Scene files
    Scene,
    /// Job files
    Job,
}

impl InspectArgs {
    /// All changes to the scene in the order in which they apply.
    pub fn assignments(&self) -> Vec<(String, String)> {
        let quality = self.build_quality.and_then(BuildQuality::assignment);
        let given = quality.map(|value| ("render.build_quality".to_owned(), value));
        self.scene.assignments.iter().cloned().chain(given).collect()
    }
}

fn parse_assignment(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((key, value)) if !key.trim().is_empty() => Ok((key.trim().into(), value.trim().into())),
        _ => Err("expected key=value, such as camera.fov_deg=40".into()),
    }
}

#[cfg(test)]
mod tests;
