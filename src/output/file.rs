//! Files that appear whole or not at all.
//!
//! Bytes go to a temporary file beside the target, which is then renamed over it: a reader, a full disk or a stopped
//! program never sees half a picture. The picture is encoded before, so the temporary file lives only for one write.

use std::fs::{self, File, OpenOptions, Permissions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::{Format, OutputError, Written, encode};
use crate::film::{Film, Tone};

/// How many symbolic links are followed, as in Linux.
const MAX_LINKS: usize = 40;

/// Writes `film` to the file at `path`, replacing it in one step.
///
/// A target that is not a regular file (a device, a pipe) is written directly.
///
/// **Errors**: [`OutputError::Write`] with what the system said; a regular file that was there is then unchanged.
pub fn write_file(path: &Path, film: &Film, format: Format, tone: Tone) -> Result<Written, OutputError> {
    let cannot_write = |cause| OutputError::Write { path: path.to_owned(), cause };
    let (bytes, written) = to_bytes(film, format, tone).map_err(cannot_write)?;
    write_atomically(path, &bytes)?;
    Ok(written)
}

/// Writes `film` to standard output.
///
/// **Errors**: [`OutputError::Write`], also when the reader has gone.
pub fn write_stdout(film: &Film, format: Format, tone: Tone) -> Result<Written, OutputError> {
    let cannot_write = |cause| OutputError::Write { path: "standard output".into(), cause };
    let (bytes, written) = to_bytes(film, format, tone).map_err(cannot_write)?;
    let mut stdout = io::stdout().lock();
    stdout.write_all(&bytes).and_then(|()| stdout.flush()).map_err(cannot_write)?;
    Ok(written)
}

/// Replaces the file at `path` by `bytes` in one step, as [`write_file`].
///
/// **Errors**: [`OutputError::Write`].
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    target_of(path)
        .and_then(|target| store(&target, |file| file.write_all(bytes)))
        .map_err(|cause| OutputError::Write { path: path.to_owned(), cause })
}

/// Fails if a file could not be written at `path`, without changing anything there: to be asked before hours of work.
///
/// **Errors**: [`OutputError::Write`].
pub fn check_writable(path: &Path) -> Result<(), OutputError> {
    let check = |target| match target {
        Target::Special(_) => Ok(()),
        Target::Regular(target) => beside(&target).map(drop),
    };
    target_of(path).and_then(check).map_err(|cause| OutputError::Write { path: path.to_owned(), cause })
}

/// Where bytes go.
enum Target {
    /// A device or pipe.
    Special(PathBuf),
    /// A regular file, there or not; links are resolved.
    Regular(PathBuf),
}

fn to_bytes(film: &Film, format: Format, tone: Tone) -> io::Result<(Vec<u8>, Written)> {
    let mut bytes = Vec::new();
    let nan_values = encode(film, format, tone, &mut bytes)?;
    let size_bytes = bytes.len() as u64;
    Ok((bytes, Written { size_bytes, nan_values }))
}

fn target_of(path: &Path) -> io::Result<Target> {
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
        Ok(found) if !found.is_file() || is_standard_stream(path) => Ok(Target::Special(path.to_owned())),
        Ok(_) => resolve_links(path).map(Target::Regular),
        Err(error) if error.kind() == io::ErrorKind::NotFound => resolve_links(path).map(Target::Regular),
        Err(error) => Err(error),
    }
}

/// Whether `path` names a file that a process has open: renaming over it would not reach the process.
fn is_standard_stream(path: &Path) -> bool {
    ["/dev/stdout", "/dev/stderr", "/dev/fd", "/proc"].iter().any(|stream| path.starts_with(stream))
}

/// The file at the end of a chain of symbolic links, which need not exist.
fn resolve_links(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..MAX_LINKS {
        match fs::read_link(&path) {
            Ok(target) => path = folder_of(&path).join(target),
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::other("too many symbolic links"))
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

/// Lets `fill` write the target's new content.
fn store(target: &Target, fill: impl FnOnce(&mut File) -> io::Result<()>) -> io::Result<()> {
    match target {
        Target::Special(path) => {
            let mut file = OpenOptions::new().write(true).truncate(true).open(path)?;
            fill(&mut file)?;
            file.flush()
        }
        Target::Regular(path) => {
            let mut temporary = beside(path)?;
            fill(temporary.as_file_mut())?;
            // Errors that a file system keeps for closing show here, while the old file is still in place.
            temporary.as_file().sync_all()?;
            temporary.persist(path)?;
            Ok(())
        }
    }
}

/// A temporary file in the folder of `path`, with the permissions that the file there has or would get.
fn beside(path: &Path) -> io::Result<tempfile::NamedTempFile> {
    let existing = match OpenOptions::new().write(true).open(path) {
        Ok(file) => Some(file.metadata()?.permissions()),
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        // A rename would succeed, yet the file is write-protected.
        Err(error) => return Err(error),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".octray-").suffix(".tmp");
    if let Some(permissions) = new_file_permissions() {
        builder.permissions(permissions);
    }
    let temporary = builder.tempfile_in(folder_of(path))?;
    if let Some(permissions) = existing {
        temporary.as_file().set_permissions(permissions)?;
    }
    Ok(temporary)
}

/// What a new file asks for before the system takes away what the user's mask forbids.
#[cfg(unix)]
fn new_file_permissions() -> Option<Permissions> {
    Some(std::os::unix::fs::PermissionsExt::from_mode(0o666))
}

#[cfg(not(unix))]
fn new_file_permissions() -> Option<Permissions> {
    None
}

#[cfg(test)]
mod tests;
