//! `octray verify`: how exact the answers are, against exact arithmetic.

use std::path::PathBuf;

use clap::ValueHint;

use super::args::Tier;
use super::error::{CliError, Exit};
use super::simd;
use super::stdio::{print, say};
use super::threads::pool;
use crate::describe::words::suggest;
use crate::intersect::TierName;
use crate::measure::verify::{Effort, Family, FamilyReport, Report, table, verify_family};
use crate::output;

/// Arguments of `octray verify`.
#[derive(Debug, clap::Args)]
pub struct VerifyArgs {
    /// Rays a family; more find rarer faults
    #[arg(long, value_name = "N", default_value_t = 20_000, value_parser = clap::value_parser!(u32).range(1..))]
    pub rays: u32,
    /// Families of hard cases, separated by commas [default: all]
    #[arg(long, value_name = "FAMILY", value_delimiter = ',')]
    pub family: Vec<String>,
    /// Tiers, separated by commas
    #[arg(long, value_name = "TIER", value_delimiter = ',', default_values = ["fast", "watertight", "exact"])]
    pub tier: Vec<Tier>,
    /// Number that chooses the rays
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Threads; 0 for all that this process may use
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=4096))]
    pub threads: u16,
    /// Write everything that was measured to this file, with an example of each kind of error
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub json: Option<PathBuf>,
    /// List the families and stop
    #[arg(long)]
    pub list: bool,
}

/// Verifies as `args` say.
pub fn run(args: &VerifyArgs) -> Result<(), CliError> {
    if args.list {
        return print(list().as_bytes());
    }
    let families = families(&args.family)?;
    if let Some(path) = &args.json {
        output::check_writable(path)?;
    }
    let report = pool(args.threads)?.install(|| measure(args, &families));
    print(table(&report).as_bytes())?;
    if let Some(path) = &args.json {
        let json = serde_json::to_string_pretty(&report)
            .map_err(|error| CliError::new(Exit::Failed, "the report is no JSON").because(error))?;
        output::write_atomically(path, (json + "\n").as_bytes())?;
    }
    verdict(&report)
}

fn list() -> String {
    let width = Family::all().map(|family| family.name.len()).max().unwrap_or(0);
    Family::all().map(|family| format!("{:width$}  {}\n", family.name, family.about)).collect()
}

fn families(names: &[String]) -> Result<Vec<&'static Family>, CliError> {
    if names.is_empty() {
        return Ok(Family::all().collect());
    }
    let family = |name: &String| {
        let known: Vec<&str> = Family::all().map(|family| family.name).collect();
        let help = || format!("no family is called `{name}`\n  help: {}", suggest(name, &known));
        Family::named(name).ok_or_else(|| CliError::new(Exit::Usage, help()))
    };
    names.iter().map(family).collect()
}

fn measure(args: &VerifyArgs, families: &[&'static Family]) -> Report {
    let effort = Effort { rays: args.rays as usize, seed: args.seed };
    let mut tiers: Vec<TierName> = args.tier.iter().copied().map(TierName::from).collect();
    tiers.dedup();
    let of = |family: &&'static Family| -> Vec<FamilyReport> {
        say(family.name);
        verify_family(family, &tiers, effort)
    };
    Report {
        octray: simd::VERSION.into(),
        rays: effort.rays,
        seed: effort.seed,
        families: families.iter().flat_map(of).collect(),
    }
}

fn verdict(report: &Report) -> Result<(), CliError> {
    let broken: Vec<String> = report.families.iter().flat_map(FamilyReport::breaches).collect();
    if broken.is_empty() {
        return Ok(());
    }
    broken.iter().for_each(|breach| say(breach));
    Err(CliError::new(Exit::Regression, format!("{} documented bounds are broken", broken.len())))
}
