//! What the README shows is so: its scene renders, its mistake is told in those words. Its job: `tests/batch/readme.rs`.

use std::fs;
use std::path::Path;
use std::process::Output;

use assert_cmd::Command;
use tempfile::TempDir;

const README: &str = include_str!("../README.md");

/// The block of the README that begins with a line.
fn block(first: &str) -> &'static str {
    let begin =
        README.find(&format!("```toml\n{first}")).or_else(|| README.find(&format!("```text\n{first}")));
    let text = &README[begin.expect("the README has the block")..].split_once('\n').unwrap().1;
    text.split_once("```").expect("the block ends").0
}

fn octray(folder: &Path, args: &str) -> Output {
    let mut command = Command::cargo_bin("octray").unwrap();
    command.current_dir(folder).args(args.split(' ')).output().unwrap()
}

#[test]
fn its_scene_renders() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("my.toml"), block("[camera]")).unwrap();
    let output = octray(folder.path(), "render my.toml -o my.png --size 64x48 --spp 1");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let picture = image::open(folder.path().join("my.png")).unwrap().to_rgb8();
    let colors: std::collections::HashSet<_> = picture.pixels().collect();
    assert!(colors.len() > 500, "{} colours", colors.len());
}

#[test]
fn its_mistake_is_told_so() {
    let folder = TempDir::new().unwrap();
    let seed = octray(folder.path(), "scenes --write seed").stdout;
    let seed = String::from_utf8(seed).unwrap();
    let at = seed.rfind("radius = 0.8").expect("a cylinder of that radius");
    fs::write(folder.path().join("my.toml"), format!("{}radus{}", &seed[..at], &seed[at + 6..])).unwrap();
    let output = octray(folder.path(), "inspect my.toml");
    assert_eq!(output.status.code(), Some(3));
    assert_eq!(String::from_utf8(output.stderr).unwrap().trim(), block("error: my.toml").trim());
}
