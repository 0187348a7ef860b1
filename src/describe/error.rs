//! What can be wrong with a scene file, and how it is told.

use super::Fault;
use std::fmt;
use std::path::PathBuf;

/// Why there is no scene.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DescribeError {
    /// The file cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file is not text.
    #[error("{}: is not a scene file: byte {offset} is not UTF-8 text", path.display())]
    NotText {
        /// The file.
        path: PathBuf,
        /// Place of the first byte that is not text.
        offset: usize,
    },
    /// Something in the file or in a `--set` is wrong; all that was found.
    #[error("{}", list(.0))]
    Invalid(Vec<Diagnostic>),
    /// Something in a scene made or changed by code is wrong; all that was found.
    #[error("{}", list(.0))]
    Faults(Vec<Fault>),
    /// The part after the colon of a built-in scene's name makes no sense.
    #[error("built-in scene `{name}`: {message}")]
    Builtin {
        /// The name as given.
        name: String,
        /// What is wrong with it.
        message: String,
    },
}

/// One thing wrong, and where.
///
/// Shown as `file:line:column: message`, the line itself with a mark under the place, and what may have been meant.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// The file or the `--set` that it is in.
    pub origin: Origin,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The whole line.
    pub source_line: String,
    /// What is wrong.
    pub message: String,
    /// What may have been meant.
    pub help: Option<String>,
}

/// Where a wrong key or value was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Origin {
    /// In the scene file of this name.
    File(String),
    /// In this `--set` argument.
    Set(String),
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.origin {
            Origin::File(name) => {
                writeln!(f, "{name}:{}:{}: {}", self.line, self.column, self.message)?;
                self.show_line(f)?;
            }
            Origin::Set(argument) => write!(f, "--set {argument}: {}", self.message)?,
        }
        self.help.as_ref().map_or(Ok(()), |help| write!(f, "\n  help: {help}"))
    }
}

impl Diagnostic {
    fn show_line(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // A line may be a whole mesh: show only what is near the place.
        let start = self.column.saturating_sub(60);
        let shown: String = self.source_line.chars().skip(start).take(100).collect();
        let gutter = self.line.to_string().len();
        let before = self.column.saturating_sub(1 + start);
        write!(f, "{} | {shown}\n{:gutter$} | {:before$}^", self.line, "", "")
    }
}

fn list<T: fmt::Display>(items: &[T]) -> String {
    items.iter().map(T::to_string).collect::<Vec<_>>().join("\n")
}
