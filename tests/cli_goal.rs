//! `octray render --max-error` and `--time-limit` through the real binary.

mod common;

use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::time::{Duration, Instant};

use assert_cmd::Command;
use octray::describe::builtin;
use octray::film::Film;
use octray::output::{Picture, read_file};
use octray::scene::Scene;
use octray::wavefront::{Goal, Progress, RenderError, RenderOptions};
use serde_json::Value;

/// Renders to a file of floats; gives the picture and the event `done`.
fn render(folder: &Path, args: &str) -> (Film, Value) {
    let mut command = Command::cargo_bin("octray").unwrap();
    let args = args.split_whitespace().chain(["-o", "a.pfm", "--progress", "json"]);
    let output = command.current_dir(folder).arg("render").args(args).output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{told}");
    let done = serde_json::from_str(told.lines().last().unwrap()).unwrap();
    let Picture::Light(film) = read_file(&folder.join("a.pfm")).unwrap() else { panic!("pfm holds light") };
    (film, done)
}

fn rmse(a: &Film, b: &Film) -> f64 {
    let squares = a.pixels.iter().flatten().zip(b.pixels.iter().flatten());
    let sum: f64 = squares.map(|(a, b)| f64::from(a - b).powi(2)).sum();
    (sum / (3 * a.pixels.len()) as f64).sqrt()
}

#[test]
fn an_error_is_reached_with_the_same_bytes_for_any_threads_and_crop() {
    let folder = tempfile::tempdir().unwrap();
    let line = "glass --size 45x35 --max-error 0.02";
    let (film, done) = render(folder.path(), &format!("{line} --threads 1"));
    for threads in ["2", "7"] {
        let (other, told) = render(folder.path(), &format!("{line} --threads {threads}"));
        assert_eq!((&film, &done["reached"]), (&other, &told["reached"]), "{threads} threads");
    }
    let (part, _) = render(folder.path(), &format!("{line} --crop 7,3,30,20"));
    for (x, y) in (0..20).flat_map(|y| (0..30).map(move |x| (x, y))) {
        assert_eq!(part.pixel(x, y), film.pixel(7 + x, 3 + y), "at {x}, {y}");
    }
    let reached = &done["reached"];
    assert!(reached["rmse_estimate"].as_f64().unwrap() <= 0.02, "{reached}");
    assert!(reached["samples_fewest"].as_u64() < reached["samples_most"].as_u64(), "{reached}");
    assert_eq!(reached["pixels_above"], 0);
}

#[test]
fn pictures_are_as_near_the_truth_as_was_asked() {
    let folder = tempfile::tempdir().unwrap();
    for (scene, kind) in [
        ("seed", ""),
        ("seed", "--set render.sampler=random"),
        ("glass", "--set render.filter.kind=mitchell"),
    ] {
        let line = format!("{scene} --size 48x36 {kind}");
        let (truth, _) = render(folder.path(), &format!("{line} --spp 1024 --seed 9"));
        let mut samples = 0;
        for limit in [0.04, 0.01] {
            let (film, done) = render(folder.path(), &format!("{line} --max-error {limit}"));
            let error = rmse(&film, &truth);
            assert!(error <= limit, "{scene}: {error} rather than {limit}: {done}");
            let taken = done["samples"].as_u64().unwrap();
            assert!(taken > samples, "{scene}: a smaller error needs more samples");
            samples = taken;
        }
    }
}

#[test]
fn samples_taken_in_rounds_are_those_taken_at_once() {
    let folder = tempfile::tempdir().unwrap();
    for spp in [1, 7, 40] {
        let line = format!("glass --size 33x21 --spp {spp} --set render.filter.kind=mitchell");
        let (whole, done) = render(folder.path(), &line);
        assert_eq!(done["reached"], Value::Null);
        let (rounds, done) = render(folder.path(), &format!("{line} --time-limit 1e9"));
        assert_eq!(rounds, whole, "{spp} samples");
        assert_eq!(
            (&done["reached"]["samples_fewest"], &done["reached"]["samples_most"]),
            (&spp.into(), &spp.into())
        );
    }
}

#[test]
fn time_ends_a_render_with_a_whole_picture() {
    let folder = tempfile::tempdir().unwrap();
    let (truth, _) = render(folder.path(), "seed --size 96x72 --spp 256 --seed 5");
    let begun = Instant::now();
    let (film, done) = render(folder.path(), "seed --size 96x72 --time-limit 1");
    // Endless without a limit; how near a second it ends is the machine's affair.
    assert!(begun.elapsed() < Duration::from_secs(60));
    assert!(done["render_s"].as_f64().unwrap() >= 1.0, "all of the time is used: {done}");
    assert!(done["reached"]["samples_fewest"].as_u64().unwrap() >= 1);
    assert!(rmse(&film, &truth) < 0.2, "{done}");
    assert_eq!(done["reached"]["first_sample_late"], false);
    let (film, done) = render(folder.path(), "seed --size 96x72 --time-limit 1e-9");
    assert_eq!(done["reached"]["first_sample_late"], true, "the limit was not kept, and that is said");
    assert_eq!(
        (&done["reached"]["samples_fewest"], &done["reached"]["rmse_estimate"]),
        (&1.into(), &Value::Null)
    );
    assert!(rmse(&film, &truth) < 0.5, "no pixel is left out");
}

#[test]
fn a_limit_too_short_for_one_sample_is_remarked() {
    let folder = tempfile::tempdir().unwrap();
    let told = |limit: &str| {
        let mut command = Command::cargo_bin("octray").unwrap();
        let args = ["render", "seed", "--size", "48x36", "--spp", "4", "-o", "a.png", "--time-limit", limit];
        let output = command.current_dir(folder.path()).args(args).output().unwrap();
        assert!(output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    let remark = "the time limit was over before each pixel had its first sample";
    assert!(told("1e-9").contains(remark));
    assert!(!told("1e9").contains(remark));
}

/// The first pass over a large picture may take long.
#[test]
fn a_cancelled_render_does_not_finish_its_first_pass() {
    let scene = Scene::compile(&builtin("seed").unwrap().unwrap()).unwrap();
    let (cancel, first, last) = (AtomicBool::new(false), AtomicU64::new(0), AtomicU64::new(0));
    let progress = |progress: Progress| {
        if !cancel.swap(true, Relaxed) {
            first.store(progress.rays, Relaxed);
        }
        last.store(progress.rays, Relaxed);
    };
    let goal = Some(Goal { max_error: None, time_limit: Some(Duration::from_secs(3600)) });
    let options = RenderOptions {
        threads: 1,
        progress: Some(&progress),
        cancel: Some(&cancel),
        goal,
        ..RenderOptions::default()
    };
    assert!(matches!(octray::wavefront::render(&scene, &options), Err(RenderError::Cancelled)));
    assert!(first.load(Relaxed) > 0);
    assert_eq!(first.into_inner(), last.into_inner(), "no ray was traced after the first tile");
}

#[test]
fn goals_that_make_no_sense_are_refused() {
    for bad in ["--max-error=0", "--max-error=-1", "--time-limit=0", "--time-limit=soon"] {
        let output = Command::cargo_bin("octray").unwrap().args(["render", "seed", bad]).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{bad:?}");
        assert!(String::from_utf8_lossy(&output.stderr).contains("expected a number"), "{bad:?}");
    }
}
