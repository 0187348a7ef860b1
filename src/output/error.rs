//! What can go wrong with picture files.

use std::io;
use std::path::PathBuf;

use super::format::Format;

/// Why a picture was not written or read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutputError {
    /// The file's name does not say a known format.
    #[error("{}: unknown picture format; known extensions are {}", path.display(), Format::NAMES.join(", "))]
    UnknownFormat {
        /// The name as given.
        path: PathBuf,
    },
    /// The picture could not be encoded or stored.
    #[error("cannot write {}", path.display())]
    Write {
        /// Where the picture was to go.
        path: PathBuf,
        /// What the system said.
        #[source]
        cause: io::Error,
    },
    /// The file could not be read.
    #[error("cannot read {}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        #[source]
        cause: io::Error,
    },
    /// The file was read but is not a picture that we understand.
    #[error("{}: {reason}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
}

impl OutputError {
    /// Whether the file's folder, or the file itself, is not there.
    pub(crate) fn is_not_found(&self) -> bool {
        matches!(self, Self::Write { cause, .. } | Self::Read { cause, .. } if cause.kind() == io::ErrorKind::NotFound)
    }
}
