//! `octray completions`: what a shell needs to complete the command line.

use clap::CommandFactory;

use super::args::{Args, CompletionsArgs};
use super::error::CliError;
use super::stdio;

/// Prints the script of a shell.
pub fn run(args: &CompletionsArgs) -> Result<(), CliError> {
    // In memory first, because the generator panics when its writer fails.
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Args::command(), "octray", &mut script);
    stdio::print(&script)
}
