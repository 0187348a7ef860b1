//! Pictures to files, and back for comparing.
//!
//! A film becomes bytes by [`encode`]; [`write_file`] puts them in place in one step, so that a target is either the
//! old file or the whole new one.

mod camera;
mod encode;
mod error;
mod exr;
mod file;
mod format;
mod netpbm;
mod pfm;
mod png;
mod ppm;
mod read;

pub use camera::{camera_json, camera_path};
pub use encode::encode;
pub use error::OutputError;
pub use file::{check_writable, write_atomically, write_file, write_stdout};
pub use format::Format;
pub use read::{Picture, decode, read_file};

/// What writing a picture gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Written {
    /// Size of the encoded picture.
    pub size_bytes: u64,
    /// Channel values that were not a number and were written as 0; float formats keep them and count none.
    pub nan_values: u64,
}
