//! Valgrind around one case.

use std::path::PathBuf;
use std::process::Command;

use crate::cases::Case;

/// Makes this program run the case whose name follows.
pub(crate) const RUN: &str = "--run";

/// Where the profile of a case is kept, for `callgrind_annotate`.
pub(crate) fn profile(name: &str) -> PathBuf {
    let name = name.replace([' ', ':'], "-");
    PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("callgrind.{name}.out"))
}

/// Instructions that a case takes.
///
/// **Errors:** Valgrind is not there, or the case failed in it; what it said.
pub(crate) fn count(case: &Case) -> Result<u64, String> {
    if cfg!(target_feature = "avx512f") {
        return Err("Valgrind knows no AVX-512: count by `cargo instructions`".into());
    }
    let name = case.name();
    let (program, profile) = (std::env::current_exe().map_err(|error| error.to_string())?, profile(&name));
    let mut valgrind = Command::new("valgrind");
    valgrind.arg("--tool=callgrind").arg(format!("--callgrind-out-file={}", profile.display()));
    valgrind.args(case.counted_function().map(|function| format!("--toggle-collect={function}")));
    // Else threads that look for work on a machine with many of them count too.
    let run = valgrind.arg(program).args([RUN, &name]).env("RAYON_NUM_THREADS", "1").output();
    let run = run.map_err(|error| format!("valgrind cannot be started: {error}"))?;
    if !run.status.success() {
        return Err(format!("{name}: {}\n{}", run.status, String::from_utf8_lossy(&run.stderr)));
    }
    let text =
        std::fs::read_to_string(&profile).map_err(|error| format!("{}: {error}", profile.display()))?;
    total(&text).filter(|&count| count > 0).ok_or_else(|| format!("{}: counts nothing", profile.display()))
}

/// The sum over a profile.
fn total(profile: &str) -> Option<u64> {
    profile.lines().find_map(|line| line.strip_prefix("totals: "))?.trim().parse().ok()
}
