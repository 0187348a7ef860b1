//! `octray bench`: rays a second of scenes, here and in other ray tracers, and how costs grow with size.

mod peers;

use std::path::{Path, PathBuf};

use clap::ValueHint;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use rayon::ThreadPool;

use super::args::{BuildQuality, Tier, parse_size};
use super::error::{CliError, Exit};
use super::source::SceneSource;
use super::stdio::{print, say};
use super::threads::pool;
use super::{pipeline, simd};
use crate::accel::Quality;
use crate::describe::is_file_name;
use crate::measure::bench::{
    Baseline, BaselineError, Class, Counters, Options, Report, Scaling, SceneReport, Settings, Subject,
    TooFewSizes, View, bench_scene, box_tests_a_second, comparison_table, scaling_plot, table,
};
use crate::output;
use peers::Peers;

/// What is measured when no scene is named.
const SCENES: [&str; 3] = ["terrain:200000", "instances", "spheres"];

/// Other ray tracers.
const PEERS: [&str; 3] = ["embree", "obvhs", "bvh"];

/// Arguments of `octray bench`.
#[derive(Debug, clap::Args)]
pub struct BenchArgs {
    /// Scenes as `octray render` takes them; with @scene, @outside or @inside at the end to choose the view of one
    /// [default: terrain:200000 instances spheres]
    #[arg(value_name = "SCENE", value_hint = ValueHint::FilePath)]
    pub scenes: Vec<String>,
    /// Classes of rays, separated by commas
    #[arg(long, value_name = "CLASS", value_delimiter = ',', default_values = Class::NAMES,
          value_parser = PossibleValuesParser::new(Class::NAMES).try_map(|name| name.parse::<Class>()))]
    pub classes: Vec<Class>,
    /// How exactly rays are intersected
    #[arg(long, default_value = "watertight")]
    pub tier: Tier,
    /// How much work goes into building the tree
    #[arg(long, value_name = "QUALITY", default_value = "balanced")]
    pub build_quality: BuildQuality,
    /// Threads that ask rays; 0 for all that this process may use
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(0..=4096))]
    pub threads: u16,
    /// Width and height in pixels of the picture that camera rays sample
    #[arg(long, value_name = "WxH", default_value = "1024x1024", value_parser = parse_size)]
    pub size: [u32; 2],
    /// How often each engine is timed
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub runs: u16,
    /// Where camera rays start: at the scene's camera, outside the bounds, or in their middle along the longest axis
    /// [default: outside for meshes, scene for the rest]
    #[arg(long, value_name = "VIEW",
          value_parser = PossibleValuesParser::new(View::NAMES).try_map(|name| name.parse::<View>()))]
    pub view: Option<View>,
    /// Write everything that was measured to this file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub json: Option<PathBuf>,
    /// Fit laws to what building, memory and rays cost over the number of primitives, for three scenes of different sizes
    /// or more, and draw them to this SVG file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub plot: Option<PathBuf>,
    /// Compare with a file that --json wrote; exit 4 if a class of rays became slower by more than the noise
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub baseline: Option<PathBuf>,
    /// Time other ray tracers too, on the same rays: all that there are, or those after an equals sign
    #[arg(long, value_name = "NAME", num_args = 0.., require_equals = true, value_delimiter = ',',
          default_missing_values = PEERS, value_parser = PossibleValuesParser::new(PEERS))]
    pub peers: Vec<String>,
    /// Embree 4: its library, or a folder that holds it [default: the variable OCTRAY_EMBREE]
    #[arg(long, value_name = "PATH", requires = "peers", value_hint = ValueHint::AnyPath)]
    pub embree: Option<PathBuf>,
}

/// Measures as `args` say.
pub fn run(args: &BenchArgs) -> Result<(), CliError> {
    for path in args.json.iter().chain(&args.plot) {
        output::check_writable(path)?;
    }
    if args.plot.is_some() {
        Scaling::expects(scenes(args).len()).map_err(too_few)?;
    }
    let baseline = args.baseline.as_deref().map(Baseline::read).transpose().map_err(unusable)?;
    let pool = pool(args.threads)?;
    let peers = Peers::open(args)?;
    announce(&pool);
    let mut report = measure(args, &pool, &peers)?;
    print(table(&report).as_bytes())?;
    let drawn = args.plot.as_deref().map_or(Ok(()), |path| scale(&mut report, path));
    if let Some(path) = &args.json {
        output::write_atomically(path, to_json(&report)?.as_bytes())?;
    }
    // What was measured is kept, whatever it was not good for.
    drawn?;
    baseline.map_or(Ok(()), |baseline| compare(&baseline, &report))
}

/// Adds laws to the report, prints and draws them.
fn scale(report: &mut Report, path: &Path) -> Result<(), CliError> {
    let scaling = Scaling::of(report).map_err(too_few)?;
    print(format!("\n{}", scaling.table()).as_bytes())?;
    let svg = scaling_plot(&scaling)
        .map_err(|error| CliError::new(Exit::Failed, "no plot can be drawn").because(error.to_string()))?;
    report.scaling = Some(scaling);
    Ok(output::write_atomically(path, svg.as_bytes())?)
}

fn too_few(error: TooFewSizes) -> CliError {
    CliError::new(Exit::Usage, "--plot has too few sizes").because(error)
}

/// What readers of the numbers should know about this machine.
fn announce(pool: &ThreadPool) {
    if let Some(advice) = simd::advice(simd::BUILT_FOR, simd::offered()) {
        say(&format!("warning: {advice}"));
    }
    if pool.current_num_threads() > 1 {
        say("several threads: rates are by wall time, and nothing is read from hardware counters");
    } else if let Err(reason) = Counters::open() {
        say(&reason);
    }
}

fn measure(args: &BenchArgs, pool: &ThreadPool, peers: &Peers) -> Result<Report, CliError> {
    let options = Options {
        classes: args.classes.clone(),
        tier: args.tier.into(),
        size: args.size,
        runs: usize::from(args.runs),
        peak_box_tests_s: pool.install(box_tests_a_second),
    };
    let scenes: Result<_, CliError> =
        scenes(args).iter().map(|text| scene(text, args, &options, pool, peers)).collect();
    Ok(Report {
        octray: simd::VERSION.into(),
        settings: Settings {
            tier: options.tier.name().into(),
            build_quality: Quality::from(args.build_quality).name().into(),
            threads: pool.current_num_threads(),
            size: options.size,
            runs: options.runs,
        },
        peak_box_tests_s: options.peak_box_tests_s,
        scenes: scenes?,
        scaling: None,
    })
}

/// The scenes that were named, or the usual ones.
fn scenes(args: &BenchArgs) -> Vec<String> {
    if args.scenes.is_empty() { SCENES.map(String::from).to_vec() } else { args.scenes.clone() }
}

fn scene(
    text: &str,
    args: &BenchArgs,
    options: &Options,
    pool: &ThreadPool,
    peers: &Peers,
) -> Result<SceneReport, CliError> {
    let (name, own_view) = view_of(text).map_err(|error| CliError::new(Exit::Usage, error))?;
    let Ok(source) = SceneSource::parse(name);
    let usual = if source.is_mesh() { View::Outside } else { View::Scene };
    let view = own_view.or(args.view).unwrap_or(usual);
    say(&format!("{source}: loading"));
    let compiled = pool.install(|| pipeline::open_bare(&source, options.size))?;
    let stem = source.stem();
    let quality = args.build_quality.into();
    let subject = pool.install(|| Subject::with_quality(stem, compiled, view, quality)).ok_or_else(|| {
        CliError::new(Exit::Scene, format!("{source}: nothing to measure: there is nothing but planes"))
    })?;
    let peer_scenes = peers.scenes(&subject, options.tier, pool.current_num_threads());
    bench_scene(&subject, &peer_scenes, options, pool, &say)
        .map_err(|error| CliError::of(Exit::Failed, error))
}

/// `sponza.obj@inside` is `sponza.obj` seen from inside; a file may have an `@` in its own name.
fn view_of(text: &str) -> Result<(&str, Option<View>), String> {
    match text.rsplit_once('@') {
        Some((name, view)) if !is_file_name(view) => match view.parse() {
            Ok(view) => Ok((name, Some(view))),
            Err(_) if Path::new(text).exists() => Ok((text, None)),
            Err(error) => Err(error),
        },
        _ => Ok((text, None)),
    }
}

fn to_json(report: &Report) -> Result<String, CliError> {
    serde_json::to_string_pretty(report)
        .map(|text| text + "\n")
        .map_err(|error| CliError::new(Exit::Failed, "cannot write the report").because(error))
}

fn compare(baseline: &Baseline, report: &Report) -> Result<(), CliError> {
    let comparisons = baseline.compare(report).map_err(unusable)?;
    print(format!("\n{}", comparison_table(&comparisons)).as_bytes())?;
    match comparisons.iter().filter(|c| c.is_regression()).count() {
        0 => Ok(()),
        slower => {
            let text = format!("{slower} of {} classes of rays became slower", comparisons.len());
            Err(CliError::new(Exit::Regression, text))
        }
    }
}

fn unusable(error: BaselineError) -> CliError {
    let exit = match error {
        BaselineError::Read { .. } => Exit::Failed,
        BaselineError::Malformed { .. } => Exit::Scene,
        _ => Exit::Usage,
    };
    CliError::of(exit, error)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_stands_behind_the_scene() {
        assert_eq!(view_of("a/sponza.obj@inside"), Ok(("a/sponza.obj", Some(View::Inside))));
        assert_eq!(view_of("seed"), Ok(("seed", None)));
        assert_eq!(view_of("me@home.obj"), Ok(("me@home.obj", None)));
        assert!(view_of("a/sponza.obj@insid").unwrap_err().contains("inside"));
    }
}
