//! The `octray` program: arguments, one match, exit code.

use std::process::ExitCode;

use clap::Parser;
use octray::cli::{
    Args, Verb, batch, begin, bench, compare, completions, exit_code, inspect, man, render, scenes, schema,
    tradeoff, verify,
};

fn main() -> ExitCode {
    begin();
    exit_code(match Args::parse().verb {
        Verb::Render(args) => render::run(&args),
        Verb::Batch(args) => batch::run_job(&args),
        Verb::Plan(args) => batch::plan(&args),
        Verb::Run(args) => batch::run_plan(&args),
        Verb::Merge(args) => batch::merge(&args),
        Verb::Status(args) => batch::status(&args),
        Verb::Inspect(args) => inspect::run(&args),
        Verb::Bench(args) => bench::run(&args),
        Verb::Verify(args) => verify::run(&args),
        Verb::Compare(args) => compare::run(&args),
        Verb::Tradeoff(args) => tradeoff::run(&args),
        Verb::Scenes(args) => scenes::run(&args),
        Verb::Schema(args) => schema::run(&args),
        Verb::Completions(args) => completions::run(&args),
        Verb::Man(args) => man::run(&args),
    })
}
