//! Instructions that rays, trees and pictures take, counted by Valgrind: on a busy machine as on an idle one, to within
//! some hundred-thousandths.
//!
//! `cargo instructions` counts them all and fails where there are more than `counts.toml` says, `cargo instructions
//! --renew` writes that file. (`.cargo/config.toml` tells what it stands for: Valgrind knows no AVX-512, so the build is
//! one for CPUs with AVX2.)

mod callgrind;
mod cases;
#[path = "../common/mod.rs"]
mod common;
mod counts;

use std::process::ExitCode;

use cases::{Case, all};
use counts::Counts;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match arguments[..] {
        [] => counted().and_then(|counts| counts.guard(&Counts::read()?)),
        ["--renew"] => counted().and_then(|counts| counts.write()),
        // Without counting: shows that each runs.
        ["--test"] => all().iter().try_for_each(|case| {
            case.run();
            Ok(())
        }),
        [callgrind::RUN, name] => run(name),
        _ => Err(format!("expected nothing or --renew, not {}", arguments.join(" "))),
    };
    done.map_or_else(
        |error| {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        },
        |()| ExitCode::SUCCESS,
    )
}

/// The one case that this process was started for.
fn run(name: &str) -> Result<(), String> {
    let all = all();
    all.iter().find(|case| case.name() == name).ok_or_else(|| format!("no case {name}"))?.run();
    Ok(())
}

/// Counts all cases, one process each.
fn counted() -> Result<Counts, String> {
    let count = |case: &Case| Ok((case.name(), callgrind::count(case)?));
    Ok(Counts::new(all().iter().map(count).collect::<Result<_, String>>()?))
}
