//! What can be written after `octray render`.

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{ValueEnum, ValueHint};

use super::{BuildQuality, ProgressMode, SceneArgs, Tier};
use crate::cli::goal::GoalArgs;
use crate::film::Aov;
use crate::output::Format;

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
    /// How much work goes into building the tree; the picture stays the same, but in tier fast
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

pub(in crate::cli) fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| text.parse::<u32>().ok().filter(|&side| side > 0);
    text.split_once('x')
        .and_then(|(width, height)| Some([side(width)?, side(height)?]))
        .ok_or_else(|| "expected width x height in pixels, neither zero, such as 640x480".into())
}

pub(super) fn parse_crop(text: &str) -> Result<[u32; 4], String> {
    let numbers: Result<Vec<u32>, _> = text.split(',').map(|number| number.trim().parse()).collect();
    match numbers.ok().and_then(|numbers| <[u32; 4]>::try_from(numbers).ok()) {
        Some(crop) if crop[2] > 0 && crop[3] > 0 => Ok(crop),
        _ => Err("expected left,top,width,height in pixels, width and height not zero".into()),
    }
}
