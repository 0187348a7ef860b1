//! Paths of one folder as seen from another.

use std::io;
use std::path::{Component, Path, PathBuf};

/// `folder` as seen from `from`, by their names alone; as it is where they have nothing in common.
pub(super) fn relative(folder: &Path, from: &Path) -> io::Result<PathBuf> {
    let [folder, from] = [plain(folder)?, plain(from)?];
    let shared = folder.components().zip(from.components()).take_while(|(a, b)| a == b).count();
    let up = from.components().skip(shared).map(|_| Component::ParentDir);
    Ok(up.chain(folder.components().skip(shared)).collect())
}

/// Absolute and without dots.
fn plain(path: &Path) -> io::Result<PathBuf> {
    let path = if path == Path::new("") { Path::new(".") } else { path };
    let mut plain = PathBuf::new();
    for part in std::path::absolute(path)?.components() {
        match part {
            Component::ParentDir => drop(plain.pop()),
            Component::CurDir => {}
            part => plain.push(part),
        }
    }
    Ok(plain)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_seen_from_each_other() {
        let seen = |folder: &str, from: &str| relative(Path::new(folder), Path::new(from)).unwrap();
        assert_eq!(seen("/a/b", "/a/b"), Path::new(""));
        assert_eq!(seen("/a/b/c", "/a/b"), Path::new("c"));
        assert_eq!(seen("/a/jobs", "/a/plans/x"), Path::new("../../jobs"));
        assert_eq!(seen("x/../y", ""), Path::new("y"));
    }
}
