//! `octray man`: manual pages.

use clap::{Command, CommandFactory};
use clap_mangen::Man;

use super::args::{Args, ManArgs};
use super::error::{CliError, Exit};
use super::stdio;

/// Prints the page of the program or of one verb.
pub fn run(args: &ManArgs) -> Result<(), CliError> {
    let mut page = Vec::new();
    Man::new(command(args.verb.as_deref())?)
        .render(&mut page)
        .map_err(|error| CliError::new(Exit::Failed, "cannot make the manual page").because(error))?;
    stdio::print(&page)
}

fn command(verb: Option<&str>) -> Result<Command, CliError> {
    let mut program = Args::command();
    program.build();
    let Some(verb) = verb else { return Ok(program) };
    let unknown = || {
        let verbs: Vec<&str> = program.get_subcommands().map(Command::get_name).collect();
        CliError::new(Exit::Usage, format!("unknown verb `{verb}`; known are {}", verbs.join(", ")))
    };
    program.find_subcommand(verb).cloned().ok_or_else(unknown)
}
