//! Many pictures as a user renders them: planned, interrupted, resumed, split, merged, and always the same bytes.

mod checks;
mod crash;
mod disk;
mod job;
mod progress;
mod readme;
mod refusal;
mod schema;
mod seeds;
mod shards;
mod sharing;
mod wrappers;

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output};

use tempfile::TempDir;

/// Four small pictures with values beside colour, each also as PNG.
pub const SMALL: &str = r#"
scene = "seed"
size = [70, 40]
spp = 40
frames = "1-4"
[[keyframes]]
key = "camera.fov_deg"
frames = [1, 4]
values = [30, 60]
[[output]]
path = "a/turn.####.exr"
aovs = ["depth", "shading_normal", "object_id", "sample_count"]
[[output]]
path = "turn.####.png"
"#;

/// A folder with a job file.
pub fn folder(job: &str) -> TempDir {
    let folder = TempDir::new().unwrap();
    std::fs::write(folder.path().join("turn.toml"), job).unwrap();
    folder
}

/// The program in a folder, ready to start; nothing of a scheduler around it.
pub fn command(folder: &Path, args: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_octray"));
    command.current_dir(folder).args(args.split_whitespace());
    for name in ["OCTRAY_SHARD", "SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX", "AWS_BATCH_JOB_ARRAY_INDEX"] {
        command.env_remove(name);
    }
    command
}

/// Runs the program.
pub fn octray(folder: &Path, args: &str) -> Output {
    command(folder, args).output().unwrap()
}

/// All that it said.
pub fn told(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

/// Runs the program, which must succeed.
pub fn done(folder: &Path, args: &str) -> String {
    let output = octray(folder, args);
    assert!(output.status.success(), "octray {args}: {}", told(&output));
    told(&output)
}

/// Runs the program, which must fail with this exit code and say these words.
pub fn fails(folder: &Path, args: &str, code: i32, words: &[&str]) -> String {
    let output = octray(folder, args);
    let said = told(&output);
    assert_eq!(output.status.code(), Some(code), "octray {args}: {said}");
    for word in words {
        assert!(said.contains(word), "octray {args}: `{word}` is not in: {said}");
    }
    said
}

/// All pictures below a folder with their bytes, without state and leftovers of killed processes.
pub fn pictures(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut waiting = vec![folder.to_owned()];
    while let Some(next) = waiting.pop() {
        for entry in std::fs::read_dir(&next).unwrap().map(Result::unwrap) {
            let (path, name) = (entry.path(), entry.file_name().into_string().unwrap());
            match path.is_dir() {
                true if !name.ends_with(".octray") => waiting.push(path),
                false if !name.starts_with(".octray-") => {
                    let below = path.strip_prefix(folder).unwrap().to_string_lossy().into_owned();
                    found.insert(below, std::fs::read(&path).unwrap());
                }
                _ => {}
            }
        }
    }
    found
}

/// Fails with the names of the files that differ.
#[track_caller]
pub fn assert_same(found: &BTreeMap<String, Vec<u8>>, expected: &BTreeMap<String, Vec<u8>>) {
    let names = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(found), names(expected));
    let differ: Vec<&String> = expected.keys().filter(|name| found[*name] != expected[*name]).collect();
    assert!(differ.is_empty(), "other bytes: {differ:?}");
}

/// What an undisturbed batch gives.
pub fn undisturbed(job: &str) -> BTreeMap<String, Vec<u8>> {
    let folder = folder(job);
    done(folder.path(), "batch turn.toml -o out --threads 1");
    pictures(&folder.path().join("out"))
}
