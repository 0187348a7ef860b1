//! Counts as they were when somebody last looked at them, and what has become of them.

use std::collections::BTreeMap;
use std::process::Command;

use serde::{Deserialize, Serialize};

use crate::callgrind::profile;

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/instructions/counts.toml");
const HEAD: &str =
    "# Instructions of each case of benches/instructions; written by `cargo instructions --renew`.\n\n";

/// A case may take this many times its committed instructions: what inlining moves by chance is less.
const LIMIT: f64 = 1.05;

#[derive(Serialize, Deserialize)]
pub(crate) struct Counts {
    /// What `rustc --version` says. Others make other code of the same text.
    compiler: String,
    instructions: BTreeMap<String, u64>,
}

impl Counts {
    pub(crate) fn new(instructions: BTreeMap<String, u64>) -> Self {
        let version = Command::new("rustc").arg("--version").output().map(|output| output.stdout);
        let version = String::from_utf8_lossy(&version.unwrap_or_default()).trim().to_owned();
        Self { compiler: version, instructions }
    }

    pub(crate) fn read() -> Result<Self, String> {
        let text = std::fs::read_to_string(FILE).map_err(|error| format!("{FILE}: {error}"))?;
        toml::from_str(&text).map_err(|error| format!("{FILE}: {error}"))
    }

    pub(crate) fn write(&self) -> Result<(), String> {
        let text = HEAD.to_owned() + &toml::to_string(self).map_err(|error| error.to_string())?;
        std::fs::write(FILE, text).map_err(|error| format!("{FILE}: {error}"))?;
        println!("{FILE}: {} counts of {}", self.instructions.len(), self.compiler);
        Ok(())
    }

    /// Prints every count beside the committed one.
    ///
    /// **Errors:** the cases that take too many instructions, or that have no committed count; with another compiler
    /// none, as it may be its doing.
    pub(crate) fn guard(&self, committed: &Self) -> Result<(), String> {
        println!("{:<24}{:>14}{:>14}{:>8}", "instructions of", "committed", "now", "ratio");
        let beyond: Vec<&str> =
            self.instructions.iter().filter_map(|(name, &now)| committed.told(name, now)).collect();
        let Some(first) = beyond.first() else { return Ok(()) };
        let error = format!(
            "beyond {LIMIT} times the committed count, or without one: {}\n`callgrind_annotate {}` tells where; if it is \
             meant, `cargo instructions --renew`",
            beyond.join(", "),
            profile(first).display()
        );
        if self.compiler == committed.compiler {
            return Err(error);
        }
        println!("warning: {error}");
        println!("counts were taken with {}, this is {}: nothing fails", committed.compiler, self.compiler);
        Ok(())
    }

    /// Prints a line; gives the name back if the count is too high.
    fn told<'a>(&self, name: &'a str, now: u64) -> Option<&'a str> {
        let Some(&committed) = self.instructions.get(name) else {
            println!("{name:<24}{:>14}{now:>14}", "none");
            return Some(name);
        };
        let ratio = now as f64 / committed as f64;
        let remark = match ratio {
            r if r > LIMIT => "  MORE",
            r if r < 1.0 / LIMIT => "  less: renew the counts",
            _ => "",
        };
        println!("{name:<24}{committed:>14}{now:>14}{ratio:>8.3}{remark}");
        (ratio > LIMIT).then_some(name)
    }
}
