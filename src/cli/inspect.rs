//! `octray inspect`: what a scene holds and which stages it needs.

use super::args::SceneArgs;
use super::error::CliError;
use super::{pipeline, stdio};

/// Prints what the scene holds.
pub fn run(args: &SceneArgs) -> Result<(), CliError> {
    let scene = pipeline::open(&args.scene, &args.assignments)?;
    stdio::print(pipeline::inspect(&scene).as_bytes())
}
