//! `octray compare`: how far two pictures differ.

use std::path::{Path, PathBuf};

use clap::ValueHint;
use clap::builder::{PossibleValuesParser, TypedValueParser};

use super::error::{CliError, Exit};
use super::stdio::{print, say};
use crate::film::Tone;
use crate::measure::compare::{Metric, difference, heatmap};
use crate::output::{self, Format, Picture};

/// Arguments of `octray compare`.
#[derive(Debug, clap::Args)]
pub struct CompareArgs {
    /// The first picture (png, ppm, pfm, exr)
    #[arg(value_name = "A", value_hint = ValueHint::FilePath)]
    pub first: PathBuf,
    /// The second picture, of the same size
    #[arg(value_name = "B", value_hint = ValueHint::FilePath)]
    pub second: PathBuf,
    /// How the difference is measured [default: in all ways]
    #[arg(long, value_name = "METRIC",
          value_parser = PossibleValuesParser::new(Metric::NAMES).try_map(|name| name.parse::<Metric>()))]
    pub metric: Option<Metric>,
    /// Exit 4 if the root mean square of the difference is larger than this
    #[arg(long, value_name = "X", value_parser = parse_limit, allow_negative_numbers = true)]
    pub max_rmse: Option<f64>,
    /// Write a picture of where they differ: of FLIP with --metric flip, of the channels otherwise
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub heatmap: Option<PathBuf>,
}

/// Compares as `args` say. Two 8-bit pictures are compared by their sRGB values from 0 to 1, others by their light.
pub fn run(args: &CompareArgs) -> Result<(), CliError> {
    let map = args.heatmap.as_deref().map(target).transpose()?;
    let [first, second] = [read(&args.first)?, read(&args.second)?];
    tell_of_no_numbers(&args.first, &first);
    tell_of_no_numbers(&args.second, &second);
    let metrics = args.metric.map_or(Metric::ALL.to_vec(), |metric| vec![metric]);
    let found = difference(&first, &second, metrics.contains(&Metric::Flip))
        .map_err(|error| CliError::of(Exit::Scene, error))?;
    let line = |metric: &Metric| format!("{metric} {}\n", found.by(*metric).unwrap_or_default());
    print(metrics.iter().map(line).collect::<String>().as_bytes())?;
    if let Some((path, format)) = map {
        let film = heatmap(&found, args.metric.unwrap_or(Metric::Rmse));
        output::write_file(path, &film, format, Tone::default())?;
    }
    let rmse = found.by(Metric::Rmse).unwrap_or_default();
    match args.max_rmse {
        Some(limit) if rmse > limit => Err(CliError::new(
            Exit::Regression,
            format!("the pictures differ by a rmse of {rmse}, more than {limit}"),
        )),
        _ => Ok(()),
    }
}

/// Why a difference may be infinite, or none where nothing can be seen.
fn tell_of_no_numbers(path: &Path, picture: &Picture) {
    let Picture::Light(film) = picture else { return };
    let count = film.pixels.iter().flatten().filter(|x| !x.is_finite()).count();
    if count > 0 {
        say(&format!(
            "note: {}: {count} of {} values are NaN or infinite; such a value is like its own kind and infinitely far from others",
            path.display(),
            3 * film.pixels.len()
        ));
    }
}

fn target(path: &Path) -> Result<(&Path, Format), CliError> {
    let format = Format::from_path(path)?;
    output::check_writable(path)?;
    Ok((path, format))
}

fn read(path: &Path) -> Result<Picture, CliError> {
    Ok(output::read_file(path)?)
}

fn parse_limit(text: &str) -> Result<f64, String> {
    let limit = text.parse::<f64>().ok().filter(|limit| *limit >= 0.0);
    limit.ok_or_else(|| "expected a number that is not negative".into())
}
