//! `octray tradeoff`: what a scene's settings cost and bring.

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::ValueHint;

use super::args::{SceneArgs, parse_size};
use super::error::{CliError, Exit};
use super::goal::parse_seconds;
use super::pipeline::{self, RenderError, RenderOptions};
use super::simd;
use super::stdio::{print, say};
use super::threads::threads;
use crate::describe::SceneDescription;
use crate::measure::tradeoff::{Effort, Report, TradeoffError, page, table, tradeoff};
use crate::output;

/// Pictures are halved until they have no more pixels than this: errors and times a pixel hardly depend on it.
const MOST_PIXELS: u64 = 100_000;

/// Arguments of `octray tradeoff`.
#[derive(Debug, clap::Args)]
pub struct TradeoffArgs {
    /// Which scene, and changes to it.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Folder for tradeoff.json and tradeoff.html, which is made if it is not there [default: neither is written]
    #[arg(short, long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub output: Option<PathBuf>,
    /// Seconds that it may take, about; settings that do not fit are left out
    #[arg(long, value_name = "S", default_value = "120", value_parser = parse_seconds, allow_negative_numbers = true)]
    pub budget: Duration,
    /// Width and height of the pictures [default: the scene's, halved until there are at most 100,000 pixels]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<[u32; 2]>,
    /// Threads; 0 for all that this process may use
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=4096))]
    pub threads: u16,
    /// Say nothing but errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// Measures as `args` say.
pub fn run(args: &TradeoffArgs) -> Result<(), CliError> {
    let files = args.output.as_deref().map(files).transpose()?;
    let report = measure(args)?;
    print(table(&report).as_bytes())?;
    let Some([json, html]) = files else { return Ok(()) };
    let text = serde_json::to_string_pretty(&report)
        .map_err(|error| CliError::new(Exit::Failed, "the report is no JSON").because(error))?;
    output::write_atomically(&json, (text + "\n").as_bytes())?;
    let text = page(&report)
        .map_err(|error| CliError::new(Exit::Failed, "no plot can be drawn").because(error.to_string()))?;
    Ok(output::write_atomically(&html, text.as_bytes())?)
}

/// The files in the folder; fails now if writing would fail later.
fn files(folder: &Path) -> Result<[PathBuf; 2], CliError> {
    let made = std::fs::create_dir_all(folder);
    made.map_err(|error| {
        CliError::new(Exit::Failed, format!("cannot make {}", folder.display())).because(error)
    })?;
    let files = ["tradeoff.json", "tradeoff.html"].map(|name| folder.join(name));
    files.iter().try_for_each(|file| output::check_writable(file))?;
    Ok(files)
}

fn measure(args: &TradeoffArgs) -> Result<Report, CliError> {
    let resize = |scene: &mut SceneDescription| {
        scene.render.size = args.size.unwrap_or_else(|| halved(scene.render.size));
    };
    let opened = pipeline::open_changed(&args.scene.scene, &args.scene.assignments, args.threads, resize)?;
    let tell = |what: &str| {
        if !args.quiet {
            say(what);
        }
    };
    let effort = Effort {
        budget: args.budget,
        options: RenderOptions { threads: threads(args.threads), ..RenderOptions::default() },
        say: &tell,
    };
    let report = tradeoff(&opened.name, opened.scene, &effort).map_err(failed)?;
    Ok(Report { octray: simd::VERSION.into(), ..report })
}

fn failed(error: TradeoffError) -> CliError {
    match error {
        TradeoffError::Render(error @ RenderError::Crop { .. }) => CliError::of(Exit::Usage, error),
        error => CliError::of(Exit::Failed, error),
    }
}

fn halved(mut size: [u32; 2]) -> [u32; 2] {
    while size.iter().map(|&side| u64::from(side)).product::<u64>() > MOST_PIXELS {
        size = size.map(|side| side.div_ceil(2));
    }
    size
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_pictures_are_halved_and_small_ones_stay() {
        assert_eq!(halved([640, 480]), [320, 240]);
        assert_eq!(halved([320, 240]), [320, 240]);
        assert_eq!(halved([1, 1 << 20]), [1, 65536]);
    }
}
