//! What can go wrong with a batch.

use std::path::PathBuf;

use crate::describe::DescribeError;
use crate::load::LoadError;
use crate::output::OutputError;
use crate::scene::CompileError;
use crate::wavefront::RenderError;

/// Why a batch cannot go on.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BatchError {
    /// The job file or a scene says something impossible; the text names the place.
    #[error("{0}")]
    Job(String),
    /// A picture of the job is no valid scene.
    #[error("{picture}: {source}")]
    Picture {
        /// Which picture.
        picture: String,
        /// What is wrong with it.
        source: DescribeError,
    },
    /// The scene is no valid scene.
    #[error(transparent)]
    Describe(#[from] DescribeError),
    /// A mesh or texture.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// A description cannot become a scene.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// A file cannot be read.
    #[error("cannot read {}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        #[source]
        cause: std::io::Error,
    },
    /// A file that octray wrote is not what it should be.
    #[error("{}: {reason}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong with it, and what to do.
        reason: String,
    },
    /// Several such files, the first of them named.
    #[error("{}", .0.join("\n"))]
    ManyDamaged(Vec<String>),
    /// Something is not what it was when the plan was made or the work begun.
    #[error("{}", .0.join("\n"))]
    Changed(Vec<String>),
    /// A shard that the plan does not have, or none where one is needed.
    #[error("{0}")]
    Shard(String),
    /// A file cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The program panicked.
    #[error("a fault of octray, please report it: {0}")]
    Panicked(String),
    /// Threads cannot be started.
    #[error(transparent)]
    Render(#[from] RenderError),
}

impl BatchError {
    /// The text with its cause.
    pub(super) fn told(&self) -> String {
        match std::error::Error::source(self) {
            Some(cause) if !self.to_string().ends_with(&cause.to_string()) => format!("{self}: {cause}"),
            _ => self.to_string(),
        }
    }

    /// A file could not be read.
    pub(super) fn read(path: impl Into<PathBuf>, cause: std::io::Error) -> Self {
        Self::Read { path: path.into(), cause }
    }

    /// A file of ours is not whole or not ours.
    pub(super) fn damaged(path: impl Into<PathBuf>, reason: impl Into<String>) -> Self {
        Self::Damaged { path: path.into(), reason: reason.into() }
    }
}
