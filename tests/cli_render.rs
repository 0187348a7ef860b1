//! `octray render` as a user runs it: where data goes, what is said, how it ends.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command as Plain, Output, Stdio};

use assert_cmd::Command;
use tempfile::TempDir;

const SMALL: [&str; 4] = ["--size", "16x12", "--spp", "1"];

fn octray(folder: &Path, args: &[&str], input: &str) -> Output {
    let mut command = Command::cargo_bin("octray").unwrap();
    command.current_dir(folder).args(args).write_stdin(input).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn without_arguments_the_seed_becomes_a_png_here() {
    let folder = TempDir::new().unwrap();
    let output = octray(folder.path(), &[&["render"][..], &SMALL].concat(), "");
    assert!(output.status.success() && output.stdout.is_empty(), "{}", text(&output.stderr));
    let picture = image::open(folder.path().join("seed.png")).unwrap();
    assert_eq!((picture.width(), picture.height()), (16, 12));
    let told = text(&output.stderr);
    for word in
        ["seed: 16x12", "camera", "Mrays/s", "build", "peak memory", "threads", "not a number", "seed.png"]
    {
        assert!(told.contains(word), "`{word}` is not in: {told}");
    }
}

#[test]
fn a_scene_from_standard_input_to_standard_output() {
    let folder = TempDir::new().unwrap();
    let scene = octray(folder.path(), &["scenes", "--write", "seed"], "");
    let from_text =
        octray(folder.path(), &[&["render", "-", "-o", "-"][..], &SMALL].concat(), &text(&scene.stdout));
    assert!(from_text.status.success(), "{}", text(&from_text.stderr));
    assert!(from_text.stdout.starts_with(b"P6\n16 12\n255\n"));
    assert_eq!(from_text.stdout.len(), 13 + 16 * 12 * 3);
    let by_name = octray(folder.path(), &[&["render", "seed", "-o", "-"][..], &SMALL].concat(), "");
    assert!(from_text.stdout == by_name.stdout, "the written scene is the built-in one");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_bare_obj_is_framed() {
    let folder = TempDir::new().unwrap();
    let obj = "v 100 0 0\nv 101 0 0\nv 100 2 0\nv 100 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    std::fs::write(folder.path().join("tetra.obj"), obj).unwrap();
    let output = octray(folder.path(), &["render", "tetra.obj", "--size", "32x24", "--spp", "4"], "");
    assert!(output.status.success(), "{}", text(&output.stderr));
    let picture = image::open(folder.path().join("tetra.png")).unwrap().to_rgb8();
    let colours: std::collections::HashSet<_> = picture.pixels().collect();
    assert!(colours.len() > 20, "{} colours: more than a background", colours.len());
}

#[test]
fn progress_as_json_ends_once() {
    let folder = TempDir::new().unwrap();
    for (scene, code, last) in [("seed", 0, "done"), ("no.toml", 3, "failed")] {
        let args = [&["render", scene, "--progress", "json"][..], &SMALL].concat();
        let output = octray(folder.path(), &args, "");
        let told = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{told}");
        let events: Vec<serde_json::Value> = told.lines().map(|l| serde_json::from_str(l).unwrap()).collect();
        let ends = events.iter().filter(|e| e["event"] == "done" || e["event"] == "failed").count();
        assert!(ends == 1 && events.last().unwrap()["event"] == last, "{told}");
    }
}

#[test]
fn quiet_and_colourless() {
    let folder = TempDir::new().unwrap();
    let output = octray(folder.path(), &[&["render", "-q"][..], &SMALL].concat(), "");
    assert!(output.status.success() && output.stderr.is_empty(), "{}", text(&output.stderr));
    let mut command = Command::cargo_bin("octray").unwrap();
    let output = command.env("NO_COLOR", "1").args(["render", "--no-such-flag"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(!output.stderr.contains(&0x1b), "{}", text(&output.stderr));
}

#[test]
fn flags_and_assignments_change_the_picture() {
    let folder = TempDir::new().unwrap();
    let bytes = |more: &[&str]| {
        let output = octray(folder.path(), &[&["render", "-q", "-o", "-"][..], &SMALL, more].concat(), "");
        assert!(output.status.success(), "{more:?}: {}", text(&output.stderr));
        output.stdout
    };
    let plain = bytes(&[]);
    assert_eq!(plain, bytes(&["--threads", "1"]));
    for change in
        [&["--seed", "7"][..], &["--max-depth", "0"], &["--set", "camera.fov_deg=20"], &["--crop", "1,1,8,8"]]
    {
        assert_ne!(plain, bytes(change), "{change:?}");
    }
}

/// A render of hours is told to end: it ends, says what is lost, and leaves no file behind.
#[cfg(unix)]
#[test]
fn signals_end_a_render_without_a_trace() {
    for signal in ["TERM", "INT"] {
        let folder = TempDir::new().unwrap();
        let mut child = Plain::new(assert_cmd::cargo::cargo_bin("octray"))
            .current_dir(folder.path())
            .args(["render", "seed", "--size", "2000x2000", "--spp", "512", "--progress", "json"])
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut told = BufReader::new(child.stderr.take().unwrap()).lines();
        // The first event says that rendering has begun.
        let first = told.next().unwrap().unwrap();
        assert!(first.contains("progress") || first.contains("warning"), "{first}");
        Plain::new("kill").args(["-s", signal, &child.id().to_string()]).status().unwrap();
        let rest: Vec<String> = told.map(Result::unwrap).collect();
        assert_eq!(child.wait().unwrap().code(), Some(1), "{signal}: {rest:?}");
        let last = rest.last().expect("says how it ended");
        for word in ["failed", "interrupted", "lost", "seed.png"] {
            assert!(last.contains(word), "`{word}` is not in: {last}");
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "{signal}: a file was left");
    }
}
