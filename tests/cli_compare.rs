//! `octray compare` through the real binary.

use std::path::{Path, PathBuf};

use assert_cmd::Command;
use octray::film::{Film, Tone};
use octray::output::{Format, write_file};

fn octray(arguments: &[&str], code: i32) -> (String, String) {
    let mut command = Command::cargo_bin("octray").unwrap();
    let output = command.arg("compare").args(arguments).assert().code(code).get_output().clone();
    (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap())
}

/// A picture whose green grows to the right and by `more`.
fn picture(folder: &Path, name: &str, more: f32) -> PathBuf {
    let pixels = (0..12 * 8).map(|i| [0.25, (i % 12) as f32 / 24.0 + more, 0.5]).collect();
    let path = folder.join(name);
    let film = Film::from_pixels(12, 8, pixels).unwrap();
    write_file(&path, &film, Format::from_path(&path).unwrap(), Tone::default()).unwrap();
    path
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn pictures_of_every_format_are_like_themselves() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.png", "a.ppm", "a.pfm", "a.exr"] {
        let path = picture(folder.path(), name, 0.0);
        let (stdout, _) = octray(&[text(&path), text(&path), "--max-rmse", "0"], 0);
        assert_eq!(stdout, "rmse 0\nmse 0\npsnr inf\nmax 0\nflip 0\n", "{name}");
    }
}

#[test]
fn a_limit_that_is_passed_gives_exit_code_4() {
    let folder = tempfile::tempdir().unwrap();
    let (a, b) = (picture(folder.path(), "a.pfm", 0.0), picture(folder.path(), "b.exr", 0.125));
    let (stdout, _) = octray(&[text(&a), text(&b), "--metric", "max", "--max-rmse", "0.08"], 0);
    assert!(stdout.starts_with("max 0.125"), "{stdout}");
    let (stdout, stderr) = octray(&[text(&a), text(&b), "--metric", "rmse", "--max-rmse", "0.07"], 4);
    assert!(stdout.starts_with("rmse 0.0721") && stderr.contains("more than 0.07"), "{stdout}{stderr}");
}

#[test]
fn heatmaps_show_where() {
    let folder = tempfile::tempdir().unwrap();
    let (a, b) = (picture(folder.path(), "a.png", 0.0), picture(folder.path(), "b.png", 0.2));
    for (metric, name) in [("flip", "flip.png"), ("rmse", "rmse.exr")] {
        let map = folder.path().join(name);
        octray(&[text(&a), text(&b), "--metric", metric, "--heatmap", text(&map)], 0);
        assert!(octray::output::read_file(&map).is_ok());
    }
}

/// A difference of `inf` says by itself nothing of why.
#[test]
fn values_that_are_no_numbers_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let (a, b) = (picture(folder.path(), "a.pfm", 0.0), picture(folder.path(), "b.pfm", f32::NAN));
    let (stdout, stderr) = octray(&[text(&a), text(&b), "--max-rmse", "9"], 4);
    assert!(stdout.starts_with("rmse inf"), "{stdout}");
    let told = stderr.lines().find(|line| line.contains("NaN")).unwrap();
    assert!(told.contains("b.pfm: 96 of 288 values"), "{stderr}");
    let (_, stderr) = octray(&[text(&a), text(&a)], 0);
    assert_eq!(stderr, "");
}

#[test]
fn bad_input_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let a = picture(folder.path(), "a.png", 0.0);
    let small = folder.path().join("small.pfm");
    let one = Film::from_pixels(1, 1, vec![[0.0; 3]]).unwrap();
    write_file(&small, &one, Format::Pfm, Tone::default()).unwrap();
    let broken = folder.path().join("broken.png");
    std::fs::write(&broken, b"no picture").unwrap();
    for (second, more, code, part) in [
        (text(&small), &[][..], 3, "12x8 and 1x1"),
        (text(&broken), &[], 3, "broken.png"),
        ("nowhere.png", &[], 1, "nowhere.png"),
        ("a.jpg", &[], 2, "ppm, png, exr, pfm"),
        (text(&a), &["--metric", "ssim"], 2, "psnr"),
        (text(&a), &["--max-rmse=-1"], 2, "--max-rmse"),
        (text(&a), &["--heatmap", "/nowhere/at/all.png"], 1, "/nowhere/at/all.png"),
    ] {
        let (_, stderr) = octray(&[&[text(&a), second], more].concat(), code);
        assert!(stderr.contains(part), "{second} {more:?}: {part} in\n{stderr}");
    }
}
