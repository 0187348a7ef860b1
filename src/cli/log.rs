//! `--log FILE`: what was done and when, a line an event.

use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use super::error::{CliError, Exit};

/// Where events go, if anywhere.
pub(super) struct Log(Option<Arc<LogFile>>);

/// A file, and why events of it are missing, if they are.
struct LogFile {
    path: PathBuf,
    file: File,
    fault: OnceLock<io::Error>,
}

impl Log {
    /// Appends to a log file from now on.
    pub(super) fn begin(path: Option<&Path>) -> Result<Self, CliError> {
        let Some(path) = path else { return Ok(Self(None)) };
        let file = OpenOptions::new().create(true).append(true).open(path);
        let file = file.map_err(|cause| {
            CliError::new(Exit::Failed, format!("cannot write {}", path.display())).because(cause)
        })?;
        let log = Arc::new(LogFile { path: path.to_owned(), file, fault: OnceLock::new() });
        tracing_subscriber::fmt().with_writer(Arc::clone(&log)).with_target(false).with_ansi(false).init();
        Ok(Self(Some(log)))
    }

    /// How work ended, which is not well if its log has gaps: pictures are worth more than their log, so it went on.
    pub(super) fn judged<T>(&self, outcome: Result<T, CliError>) -> Result<T, CliError> {
        let Some((log, fault)) = self.0.as_ref().and_then(|log| Some((log, log.fault.get()?))) else {
            return outcome;
        };
        let gaps = format!("cannot write {}, events are missing there: {fault}", log.path.display());
        Err(match outcome {
            Ok(_) => CliError::new(Exit::Failed, format!("{gaps}; everything else is done")),
            Err(error) => CliError::new(error.exit(), format!("{error}\n{gaps}")),
        })
    }
}

/// Events are whole lines, each written at once. Those that cannot be written are noted and dropped.
impl Write for &LogFile {
    fn write(&mut self, event: &[u8]) -> io::Result<usize> {
        if let Err(fault) = (&self.file).write_all(event) {
            let _ = self.fault.set(fault);
        }
        Ok(event.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
