//! Work of other jobs in the same output folder.

use std::borrow::Cow;
use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

use super::{BatchError, Plan};

/// Fails if pictures of another job in the output folder would be replaced. `own` is where the state of `plan` lies.
pub(super) fn check(output: &Path, own: &Path, plan: &Plan) -> Result<(), BatchError> {
    let others = others(output, own);
    if others.is_empty() {
        return Ok(());
    }
    let ours: HashSet<Cow<str>> = paths(plan).collect();
    for state in others {
        // A plan that cannot be read has nothing that could be resumed.
        let Ok(other) = Plan::read(&state.join("plan.json")) else { continue };
        let shared = paths(&other).find(|path| ours.contains(path));
        if let Some(path) = shared {
            return Err(BatchError::Changed(vec![
                format!("{} belongs to another job, of {}", output.join(&*path).display(), state.display()),
                "take another folder with -o, or other paths, or replace it with --force".into(),
            ]));
        }
    }
    Ok(())
}

/// The files of all pictures, those of their cameras too.
fn paths(plan: &Plan) -> impl Iterator<Item = Cow<'_, str>> {
    let files = plan.pictures.iter().flat_map(|picture| &picture.outputs);
    files.flat_map(|file| [Some(Cow::from(&file.path)), file.camera_path().map(Cow::from)]).flatten()
}

/// The states of other jobs.
fn others(output: &Path, own: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(output).into_iter().flatten().flatten().map(|entry| entry.path());
    let is_state = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "octray") && path != own;
    let mut found: Vec<PathBuf> = entries.filter(is_state).collect();
    found.sort();
    found
}
