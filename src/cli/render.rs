//! `octray render`: a scene becomes a picture.

use std::sync::Arc;
use std::time::Instant;

use super::args::RenderArgs;
use super::destination::Destination;
use super::error::{CliError, Exit};
use super::memory;
use super::pipeline::{self, Opened, Progress, RenderError, RenderOptions, RenderReport};
use super::progress::Reporter;
use super::signals::Interrupt;
use super::simd;
use super::summary::Summary;
use super::threads::threads;
use crate::film::Film;

/// Renders as `args` say.
pub fn run(args: &RenderArgs) -> Result<(), CliError> {
    let reporter = Arc::new(Reporter::new(args.progress, args.quiet));
    match picture(args, &reporter) {
        Ok(summary) => {
            reporter.done(&summary);
            Ok(())
        }
        Err(error) => Err(reporter.failed(error)),
    }
}

fn picture(args: &RenderArgs, reporter: &Arc<Reporter>) -> Result<Summary, CliError> {
    let destination = Destination::of(args)?;
    destination.check()?;
    if let Some(advice) = simd::advice(simd::BUILT_FOR, simd::offered()) {
        reporter.warn(&advice);
    }
    let interrupt = Interrupt::install(end_at_once(reporter, &destination))?;
    let scene = pipeline::open(&args.scene.scene, &args.assignments(), args.threads)?;
    destination.check_planes(scene.scene.settings.aovs)?;
    let (film, report) = render(args, &scene, reporter, &interrupt, &destination)?;
    let summary = write(&scene, &film, report, &interrupt, &destination)?;
    destination.write_camera(&scene.scene, args.crop)?;
    Ok(summary)
}

fn render(
    args: &RenderArgs,
    scene: &Opened,
    reporter: &Reporter,
    interrupt: &Interrupt,
    destination: &Destination,
) -> Result<(Film, RenderReport), CliError> {
    let options = RenderOptions {
        threads: threads(args.threads),
        crop: args.crop,
        progress: Some(&|progress: Progress| reporter.advance(&progress)),
        cancel: Some(interrupt.flag()),
        goal: args.goal.goal(),
    };
    interrupt.defer(true);
    reporter.begin();
    pipeline::render(&scene.scene, &options).map_err(|error| match error {
        RenderError::Cancelled => interrupted(reporter, destination),
        error @ RenderError::Crop { .. } => CliError::of(Exit::Usage, error),
        error => CliError::of(Exit::Failed, error),
    })
}

fn write(
    scene: &Opened,
    film: &Film,
    report: RenderReport,
    interrupt: &Interrupt,
    destination: &Destination,
) -> Result<Summary, CliError> {
    // A regular file is finished even after a signal, which is quick; a pipe may never be read.
    interrupt.defer(!destination.may_block());
    let begun = Instant::now();
    let written = destination.write(film, scene.scene.settings.tone)?;
    Ok(Summary {
        scene: scene.name.clone(),
        size: [film.width, film.height],
        skipped_triangles: scene.scene.skipped_triangles,
        report,
        start_time: scene.start_time,
        load_time: scene.load_time,
        build_time: scene.scene.times.build,
        write_time: begun.elapsed(),
        output: destination.to_string(),
        written,
        peak_memory_bytes: memory::peak_bytes(),
    })
}

/// What to do on a signal that nobody waits for.
fn end_at_once(
    reporter: &Arc<Reporter>,
    destination: &Destination,
) -> impl Fn() -> CliError + Send + 'static {
    let (reporter, destination) = (Arc::clone(reporter), destination.clone());
    move || reporter.failed(interrupted(&reporter, &destination))
}

/// Says what is lost.
fn interrupted(reporter: &Reporter, destination: &Destination) -> CliError {
    let (percent, elapsed) = (reporter.percent_done(), super::human::time(reporter.elapsed()));
    let lost = format!("{percent} % of the picture ({elapsed} of rendering) is lost");
    CliError::new(Exit::Failed, format!("interrupted: {lost}, {destination} is not written"))
}
