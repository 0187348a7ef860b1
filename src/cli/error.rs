//! The program's one error: what was tried, why it failed, and the exit code.

use std::error::Error;
use std::fmt;
use std::process::ExitCode;

use super::stdio::say;
use crate::batch::BatchError;
use crate::output::OutputError;

/// Why the program ends without success, as its exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Failed while running: files, memory, interrupted.
    Failed = 1,
    /// Wrong use of the command line.
    Usage = 2,
    /// A bad scene or asset, a damaged or changed file, or something incomplete.
    Scene = 3,
    /// Beyond a limit: slower than the baseline, a documented bound broken, pictures that differ by too much.
    Regression = 4,
    /// Stopped by a signal; the same command goes on from there.
    Stopped = 75,
}

/// Why a verb failed.
#[derive(Debug)]
pub struct CliError {
    exit: Exit,
    context: String,
    cause: Option<Box<dyn Error + Send + Sync>>,
    told: bool,
}

impl CliError {
    /// An error with this exit code and text.
    pub fn new(exit: Exit, context: impl Into<String>) -> Self {
        Self { exit, context: context.into(), cause: None, told: false }
    }

    /// An error whose text is that of `cause`.
    pub fn of(exit: Exit, cause: impl Error + Send + Sync + 'static) -> Self {
        let context = cause.to_string();
        // The text is already there; what lies below it is not, unless the text ends with it.
        let below = cause.source().map(chain).filter(|below| !context.ends_with(below)).map(Into::into);
        Self { exit, context, cause: below, told: false }
    }

    /// The error with the reason behind it.
    #[must_use]
    pub fn because(mut self, cause: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        self.cause = Some(cause.into());
        self
    }

    /// The same error, marked as already shown to the user.
    #[must_use]
    pub fn told(mut self) -> Self {
        self.told = true;
        self
    }

    fn tell(&self) {
        if !self.told {
            say(&format!("error: {self}"));
        }
    }

    /// The exit code.
    pub fn exit(&self) -> Exit {
        self.exit
    }
}

impl fmt::Display for CliError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.context)?;
        match &self.cause {
            Some(cause) => write!(f, ": {}", chain(cause.as_ref())),
            None => Ok(()),
        }
    }
}

impl Error for CliError {}

impl From<BatchError> for CliError {
    fn from(error: BatchError) -> Self {
        let exit = match error {
            BatchError::Output(error) => return error.into(),
            BatchError::Shard(_) => Exit::Usage,
            BatchError::Render(_) | BatchError::Panicked(_) => Exit::Failed,
            BatchError::Read { ref cause, .. } if cause.kind() != std::io::ErrorKind::NotFound => {
                Exit::Failed
            }
            _ => Exit::Scene,
        };
        Self::of(exit, error)
    }
}

impl From<OutputError> for CliError {
    fn from(error: OutputError) -> Self {
        let exit = match error {
            OutputError::UnknownFormat { .. } => Exit::Usage,
            OutputError::Malformed { .. } => Exit::Scene,
            OutputError::Write { .. } | OutputError::Read { .. } => Exit::Failed,
        };
        Self::of(exit, error)
    }
}

/// The exit code of a verb's outcome; tells the user what went wrong unless that was done.
pub fn exit_code(outcome: Result<(), CliError>) -> ExitCode {
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            error.tell();
            ExitCode::from(error.exit as u8)
        }
    }
}

/// Ends the program at once, from any thread, with this error.
pub(super) fn end_program(error: &CliError) -> ! {
    error.tell();
    std::process::exit(error.exit as i32)
}

/// The texts of an error and all behind it, but for those that the one before ends with.
fn chain(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut next = error.source();
    while let Some(cause) = next {
        let more = cause.to_string();
        if !text.ends_with(&more) {
            text.push_str(": ");
            text.push_str(&more);
        }
        next = cause.source();
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io;
    use std::path::PathBuf;

    #[test]
    fn every_cause_is_said_once() {
        let cause = io::Error::from(io::ErrorKind::StorageFull);
        let error = CliError::from(OutputError::Write { path: PathBuf::from("a.png"), cause });
        assert_eq!(error.to_string(), "cannot write a.png: no storage space");
        assert_eq!(error.exit(), Exit::Failed);
        let source = io::Error::from(io::ErrorKind::NotFound);
        let missing = crate::load::LoadError::Read { path: PathBuf::from("a.obj"), source };
        assert_eq!(CliError::of(Exit::Scene, missing).to_string(), "a.obj: cannot be read: entity not found");
        let error = CliError::new(Exit::Scene, "scene").because(error);
        assert_eq!(error.to_string(), "scene: cannot write a.png: no storage space");
    }

    #[test]
    fn exit_codes_have_their_numbers() {
        let codes = [Exit::Failed, Exit::Usage, Exit::Scene, Exit::Regression].map(|exit| exit as u8);
        assert_eq!(codes, [1, 2, 3, 4]);
        let unknown = OutputError::UnknownFormat { path: "a.jpg".into() };
        assert_eq!(CliError::from(unknown).exit(), Exit::Usage);
    }
}
