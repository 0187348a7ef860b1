//! Killed, stopped, started again: nothing is lost, and nothing shows.

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use super::{assert_same, command, done, folder, pictures, told, undisturbed};

/// Enough work to be interrupted often.
const LONG: &str = r#"
scene = "seed"
size = [128, 96]
spp = 128
frames = "1-4"
[[keyframes]]
key = "camera.fov_deg"
frames = [1, 4]
values = [30, 60]
[[output]]
path = "turn.####.exr"
aovs = ["depth", "object_id"]
"#;

fn start(folder: &Path, args: &str) -> Child {
    command(folder, args).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Waits until something of the work is kept.
fn wait_for_checkpoint(state: &Path, running: &mut Child) {
    while running.try_wait().unwrap().is_none() {
        let kept = std::fs::read_dir(state.join("0000")).into_iter().flatten().flatten();
        if kept.into_iter().any(|entry| entry.path().extension().is_some_and(|e| e == "checkpoint")) {
            return;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn killed_at_ten_moments_and_resumed_the_bytes_are_those_of_one_run() {
    let expected = undisturbed(LONG);
    for split in ["frames", "samples"] {
        let folder = folder(LONG);
        let batch = format!("batch turn.toml -o out --split {split} --checkpoint-every 0 --threads 2");
        let mut killed = 0;
        for k in 0..10u64 {
            let mut child = start(folder.path(), &batch);
            // Spread over start, first tiles and later ones.
            std::thread::sleep(Duration::from_millis(3 + (k * 2_654_435_761) % 120));
            child.kill().unwrap();
            killed += u32::from(!child.wait().unwrap().success());
        }
        assert!(killed >= 5, "{killed} of 10 were killed in the middle: more work is needed");
        done(folder.path(), &batch);
        assert_same(&pictures(&folder.path().join("out")), &expected);
    }
}

#[test]
fn signals_keep_what_is_done_and_say_so() {
    let expected = undisturbed(LONG);
    // `timeout` sends its signal to the process and to its group: twice is once then.
    for (signal, times) in [("TERM", 1), ("INT", 2), ("USR1", 1)] {
        let folder = folder(LONG);
        let batch = "batch turn.toml -o out --checkpoint-every 0 --threads 1";
        let mut child = start(folder.path(), batch);
        wait_for_checkpoint(&folder.path().join("out/turn.octray"), &mut child);
        let to = vec![child.id().to_string(); times];
        let sent = Command::new("kill").args(["-s", signal]).args(to).status().unwrap();
        assert!(sent.success(), "stopped too late to be told so");
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(75), "{signal}: {}", told(&output));
        assert!(told(&output).contains("of 4 units are done"), "{}", told(&output));
        done(folder.path(), batch);
        assert_same(&pictures(&folder.path().join("out")), &expected);
    }
}

#[test]
fn a_checkpoint_is_used_and_not_only_kept() {
    let folder = folder(&LONG.replace("1-4", "1").replace("spp = 128", "spp = 512"));
    let batch = "batch turn.toml -o out --checkpoint-every 0 --threads 1 --log log.txt";
    let mut child = start(folder.path(), batch);
    let state = folder.path().join("out/turn.octray");
    wait_for_checkpoint(&state, &mut child);
    child.kill().unwrap();
    child.wait().unwrap();
    done(folder.path(), batch);
    let log = std::fs::read_to_string(folder.path().join("log.txt")).unwrap();
    let opened: Vec<&str> = log.lines().filter(|line| line.contains("unit opened")).collect();
    assert_eq!(opened.len(), 2, "{log}");
    assert!(opened[0].contains("tiles=12") && !opened[1].contains("tiles=12"), "{opened:?}");
    assert!(!state.join("0000/0000000.checkpoint").exists(), "a finished unit needs none");
}

#[test]
fn finished_pictures_are_never_rendered_again() {
    let folder = folder(super::SMALL);
    done(folder.path(), "batch turn.toml -o out");
    let picture = folder.path().join("out/turn.0002.png");
    let written = |path: &Path| std::fs::metadata(path).unwrap().modified().unwrap();
    let before = written(&picture);
    assert!(done(folder.path(), "batch turn.toml -o out").contains("0 units done, 4 were done before"));
    assert_eq!(written(&picture), before);
    std::fs::remove_file(&picture).unwrap();
    assert!(done(folder.path(), "batch turn.toml -o out").contains("1 units done, 3 were done before"));
    assert!(picture.exists());
    assert!(
        done(folder.path(), "batch turn.toml -o out --force").contains("4 units done, 0 were done before")
    );
}
