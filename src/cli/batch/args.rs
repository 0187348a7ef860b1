//! What can be written after the verbs about many pictures.

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::{ValueEnum, ValueHint};

use crate::batch::plan::MOST_SHARDS;
use crate::batch::{Plan, Split, emit};
use crate::cli::ProgressMode;
use crate::cli::error::{CliError, Exit};

/// Arguments of `octray plan`.
#[derive(Debug, clap::Args)]
pub struct PlanArgs {
    /// Job file (TOML)
    #[arg(value_hint = ValueHint::FilePath)]
    pub job: PathBuf,
    /// Plan file [default: the job's name with .plan]
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
    /// Shards that processes can render independently
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=i64::from(MOST_SHARDS)))]
    pub shards: u32,
    /// What one unit of work is
    #[arg(long, value_name = "WHAT", default_value = "frames")]
    pub split: SplitBy,
    /// Print a script that runs all shards and merges
    #[arg(long, value_name = "FOR")]
    pub emit: Option<Wrapper>,
}

/// Arguments of `octray run`.
#[derive(Debug, clap::Args)]
pub struct RunArgs {
    /// Plan file
    #[arg(value_hint = ValueHint::FilePath)]
    pub plan: PathBuf,
    /// Shard to render: i/n counted from 0, or auto for the index that a scheduler gives [default: all]
    #[arg(long, value_name = "I/N")]
    pub shard: Option<String>,
    /// Folder of the pictures
    #[arg(short, long, value_name = "DIR", default_value = ".", value_hint = ValueHint::DirPath)]
    pub output: PathBuf,
    /// How the work is done.
    #[command(flatten)]
    pub work: WorkArgs,
}

/// Arguments of `octray batch`.
#[derive(Debug, clap::Args)]
pub struct BatchArgs {
    /// Job file (TOML)
    #[arg(value_hint = ValueHint::FilePath)]
    pub job: PathBuf,
    /// Folder of the pictures
    #[arg(short, long, value_name = "DIR", default_value = ".", value_hint = ValueHint::DirPath)]
    pub output: PathBuf,
    /// What one unit of work is
    #[arg(long, value_name = "WHAT", default_value = "frames")]
    pub split: SplitBy,
    /// How the work is done.
    #[command(flatten)]
    pub work: WorkArgs,
}

/// How the work is done.
#[derive(Debug, clap::Args)]
pub struct WorkArgs {
    /// Threads; 0 for the processors that this process may use
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=4096))]
    pub threads: u16,
    /// Forget what is done and begin anew
    #[arg(long)]
    pub force: bool,
    /// Start no further picture after one has failed
    #[arg(long)]
    pub fail_fast: bool,
    /// Keep what is done of a picture this often, in seconds
    #[arg(long, value_name = "SECONDS", default_value = "60", value_parser = seconds)]
    pub checkpoint_every: Duration,
    /// Most memory for pictures in work and scenes kept for further ones, such as 500M or 4G; one picture is always worked at
    #[arg(long, value_name = "SIZE", default_value = "2G", value_parser = size)]
    pub max_memory: u64,
    /// How progress is shown on standard error
    #[arg(long, value_name = "HOW", default_value = "auto")]
    pub progress: ProgressMode,
    /// Append what is done and when to this file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub log: Option<PathBuf>,
    /// Say nothing but errors (an explicit --progress is still obeyed)
    #[arg(short, long)]
    pub quiet: bool,
}

/// Arguments of `octray merge`.
#[derive(Debug, clap::Args)]
pub struct MergeArgs {
    /// Plan file
    #[arg(value_hint = ValueHint::FilePath)]
    pub plan: PathBuf,
    /// Folder of the pictures
    #[arg(short, long, value_name = "DIR", default_value = ".", value_hint = ValueHint::DirPath)]
    pub output: PathBuf,
    /// Write pictures from what there is
    #[arg(long)]
    pub partial: bool,
}

/// Arguments of `octray status`.
#[derive(Debug, clap::Args)]
pub struct StatusArgs {
    /// Plan file
    #[arg(value_hint = ValueHint::FilePath)]
    pub plan: PathBuf,
    /// Folder of the pictures
    #[arg(short, long, value_name = "DIR", default_value = ".", value_hint = ValueHint::DirPath)]
    pub output: PathBuf,
    /// As one JSON object
    #[arg(long)]
    pub json: bool,
}

/// What a unit is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SplitBy {
    /// A whole picture
    Frames,
    /// A tile of 128 x 128 pixels
    Tiles,
    /// Some samples of all pixels of a picture
    Samples,
}

impl From<SplitBy> for Split {
    fn from(split: SplitBy) -> Self {
        match split {
            SplitBy::Frames => Self::Frames,
            SplitBy::Tiles => Self::Tiles,
            SplitBy::Samples => Self::Samples,
        }
    }
}

/// Who runs the shards.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Wrapper {
    /// An array job and a merge that depends on it
    Slurm,
    /// An Open Job Description template
    Openjd,
    /// Kubernetes Indexed Jobs
    K8s,
    /// GNU parallel on this machine
    Parallel,
}

impl Wrapper {
    /// Fails if the scheduler takes no job of so many shards; tells what its site must have set for it, if anything.
    pub fn check(self, shards: u32) -> Result<Option<String>, CliError> {
        let (most, usual) = (emit::MOST_K8S_SHARDS, emit::USUAL_SLURM_SHARDS);
        match self {
            Self::K8s if shards > most => {
                let what = format!("Kubernetes takes indexed jobs of at most {most} shards, not {shards}");
                Err(CliError::new(
                    Exit::Usage,
                    format!("{what}: make the plan with --shards {most} or fewer"),
                ))
            }
            Self::Slurm if shards > usual => Ok(Some(format!(
                "an array of {shards} needs MaxArraySize={shards} or more in slurm.conf, which is {usual} unless the site set it"
            ))),
            _ => Ok(None),
        }
    }

    /// The script.
    pub fn text(self, plan: &Plan, path: &Path) -> String {
        let path = path.to_string_lossy();
        match self {
            Self::Slurm => emit::slurm(plan, &path),
            Self::Openjd => emit::openjd(plan, &path),
            Self::K8s => emit::k8s(plan, &path),
            Self::Parallel => emit::parallel(plan, &path),
        }
    }
}

fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse::<f64>().ok().filter(|&seconds| seconds >= 0.0);
    let duration = seconds.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    duration.ok_or_else(|| "expected seconds, such as 30 or 0.5".into())
}

fn size(text: &str) -> Result<u64, String> {
    let (number, unit) = match text.strip_suffix(['K', 'M', 'G', 'T']) {
        Some(number) => (number, text.as_bytes()[text.len() - 1]),
        None => (text, b'B'),
    };
    let factor = match unit {
        b'K' => 1 << 10,
        b'M' => 1 << 20,
        b'G' => 1 << 30,
        b'T' => 1u64 << 40,
        _ => 1,
    };
    let bytes = number.parse::<u64>().ok().and_then(|number| number.checked_mul(factor));
    bytes.ok_or_else(|| "expected bytes, or such as 500M or 4G".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_seconds_are_read() {
        assert_eq!(["7", "2K", "500M", "4G"].map(|t| size(t).unwrap()), [7, 2048, 500 << 20, 4 << 30]);
        for bad in ["", "G", "-1", "1.5G", "99999999999T"] {
            assert!(size(bad).is_err(), "{bad}");
        }
        assert_eq!(seconds("0.5"), Ok(Duration::from_millis(500)));
        assert!(["", "-1", "NaN", "1e40"].iter().all(|bad| seconds(bad).is_err()));
    }
}
