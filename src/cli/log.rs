//! `--log FILE`: what was done and when, a line an event.

use std::fs::OpenOptions;
use std::path::Path;
use std::sync::Mutex;

use super::error::{CliError, Exit};

/// Appends to a log file from now on.
pub(super) fn begin(path: Option<&Path>) -> Result<(), CliError> {
    let Some(path) = path else { return Ok(()) };
    let file = OpenOptions::new().create(true).append(true).open(path);
    let file = file.map_err(|cause| {
        CliError::new(Exit::Failed, format!("cannot write {}", path.display())).because(cause)
    })?;
    tracing_subscriber::fmt().with_writer(Mutex::new(file)).with_target(false).init();
    Ok(())
}
