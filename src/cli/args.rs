//! What can be written on the command line.

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Parser, Subcommand, ValueEnum, ValueHint};

use super::batch::{BatchArgs, MergeArgs, PlanArgs, RunArgs, StatusArgs};
use super::bench::BenchArgs;
use super::compare::CompareArgs;
use super::goal::GoalArgs;
use super::simd;
use super::source::SceneSource;
use super::tradeoff::TradeoffArgs;
use super::verify::VerifyArgs;
use crate::film::Aov;
use crate::intersect::TierName;
use crate::output::Format;

const EXIT_CODES: &str = "\
Exit codes:
  0  done
  1  failed while running (files, memory, interrupted)
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

/// Arguments of `octray render`.
#[derive(Debug, clap::Args)]
pub struct RenderArgs {
    /// Picture file (ppm, png, exr, pfm); `-` for standard output [default: the scene's name with .png]
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
    /// Picture format [default: by the output's extension; ppm on standard output]
    #[arg(long, value_parser = PossibleValuesParser::new(Format::NAMES).try_map(|name| name.parse::<Format>()))]
    pub format: Option<Format>,
    /// Width and height in pixels, such as 640x480
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<[u32; 2]>,
    /// Samples a pixel; with --max-error or --time-limit the most that a pixel gets [default there: 65536]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub spp: Option<u32>,
    /// When pixels have samples enough.
    #[command(flatten)]
    pub goal: GoalArgs,
    /// How many times a path may be reflected, refracted or scattered
    #[arg(long, value_name = "N")]
    pub max_depth: Option<u32>,
    /// Number that chooses the random sequences
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Threads; 0 for all that this process may use
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=4096))]
    pub threads: u16,
    /// How exactly rays are intersected
    #[arg(long)]
    pub tier: Option<Tier>,
    /// How much work goes into building the tree; the picture stays the same
    #[arg(long, value_name = "HOW")]
    pub build_quality: Option<BuildQuality>,
    /// Values beside colour for an EXR picture, such as depth,object_id; a file with the camera's numbers is written beside it
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = PossibleValuesParser::new(Aov::NAMES))]
    pub aovs: Vec<String>,
    /// Render only this part of the picture: left, top, width, height in pixels
    #[arg(long, value_name = "X,Y,W,H", value_parser = parse_crop)]
    pub crop: Option<[u32; 4]>,
    /// How progress is shown on standard error
    #[arg(long, value_name = "HOW", default_value = "auto")]
    pub progress: ProgressMode,
    /// Which scene, and changes to it.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Say nothing but errors (an explicit --progress is still obeyed)
    #[arg(short, long)]
    pub quiet: bool,
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

/// How exactly rays are intersected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Tier {
    /// Quickest; may lose rays between triangles
    Fast,
    /// No ray is lost between triangles; the same picture everywhere
    Watertight,
    /// Double precision
    Exact,
}

/// How much work goes into building the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BuildQuality {
    /// Soonest built: for few rays
    Fast,
    /// Good for most scenes
    Balanced,
    /// Also cuts triangles where they overlap: for many rays
    High,
}

impl BuildQuality {
    /// As it is written in a scene file.
    fn assignment(self) -> Option<String> {
        self.to_possible_value().map(|value| format!("\"{}\"", value.get_name()))
    }
}

impl From<Tier> for TierName {
    fn from(tier: Tier) -> Self {
        match tier {
            Tier::Fast => Self::Fast,
            Tier::Watertight => Self::Watertight,
            Tier::Exact => Self::Exact,
        }
    }
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

/// How progress is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ProgressMode {
    /// A bar on a terminal, else lines
    Auto,
    /// A bar
    Bar,
    /// A line every tenth or every 30 seconds
    Plain,
    /// One JSON object a line; the last is `done` or `failed`
    Json,
    /// Nothing
    None,
}

impl InspectArgs {
    /// All changes to the scene in the order in which they apply.
    pub fn assignments(&self) -> Vec<(String, String)> {
        let quality = self.build_quality.and_then(BuildQuality::assignment);
        let given = quality.map(|value| ("render.build_quality".to_owned(), value));
        self.scene.assignments.iter().cloned().chain(given).collect()
    }
}

impl RenderArgs {
    /// All changes to the scene in the order in which they apply: flags are short for assignments and win over them.
    pub fn assignments(&self) -> Vec<(String, String)> {
        let tier = self.tier.and_then(|tier| tier.to_possible_value());
        let flags = [
            ("render.size", self.size.map(|[width, height]| format!("[{width}, {height}]"))),
            ("render.spp", self.spp.map(|count| count.to_string())),
            ("render.max_depth", self.max_depth.map(|depth| depth.to_string())),
            ("render.seed", self.seed.map(|seed| seed.to_string())),
            ("render.tier", tier.map(|tier| format!("\"{}\"", tier.get_name()))),
            ("render.build_quality", self.build_quality.and_then(BuildQuality::assignment)),
            ("render.aovs", (!self.aovs.is_empty()).then(|| format!("{:?}", self.aovs))),
        ];
        let given = flags.into_iter().filter_map(|(key, value)| Some((key.to_owned(), value?)));
        self.goal
            .assignment()
            .into_iter()
            .chain(self.scene.assignments.iter().cloned())
            .chain(given)
            .collect()
    }
}

pub(super) fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| text.parse::<u32>().ok().filter(|&side| side > 0);
    text.split_once('x')
        .and_then(|(width, height)| Some([side(width)?, side(height)?]))
        .ok_or_else(|| "expected width x height in pixels, neither zero, such as 640x480".into())
}

fn parse_crop(text: &str) -> Result<[u32; 4], String> {
    let numbers: Result<Vec<u32>, _> = text.split(',').map(|number| number.trim().parse()).collect();
    match numbers.ok().and_then(|numbers| <[u32; 4]>::try_from(numbers).ok()) {
        Some(crop) if crop[2] > 0 && crop[3] > 0 => Ok(crop),
        _ => Err("expected left,top,width,height in pixels, width and height not zero".into()),
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
