//! Samples that are no numbers are counted, however the work is cut and wherever it was interrupted.

use std::path::Path;

use serde_json::Value;

use super::{done, folder};

/// Light that grows beyond all numbers between two sides of a glass ball, two pictures.
const JOB: &str = r#"
scene = "seed"
size = [70, 40]
spp = 32
frames = "1-2"
[set]
"material.glass.tint" = 1e18
"material.glass.attenuation" = 1e18
"background.color" = 0
[[keyframes]]
key = "camera.fov_deg"
frames = [1, 2]
values = [30, 60]
[[output]]
path = "a.#.exr"
"#;

fn last_line(folder: &Path, args: &str) -> Value {
    let said = done(folder, &format!("{args} --progress json"));
    serde_json::from_str(said.lines().last().unwrap()).unwrap()
}

/// What single renders count.
fn expected(folder: &Path) -> [u64; 2] {
    ["30", "60"].map(|fov| {
        let sets =
            "--set material.glass.tint=1e18 --set material.glass.attenuation=1e18 --set background.color=0";
        let args = format!("render seed --size 70x40 --spp 32 {sets} --set camera.fov_deg={fov} -o one.exr");
        last_line(folder, &args)["nan_samples"].as_u64().unwrap()
    })
}

fn recorded(state: &Path, unit: u64) -> u64 {
    let record = std::fs::read(state.join(format!("0000/{unit:07}.json"))).unwrap();
    serde_json::from_slice::<Value>(&record).unwrap()["nan_samples"].as_u64().unwrap()
}

#[test]
fn samples_that_are_no_numbers_are_counted() {
    let folder = folder(JOB);
    let path = folder.path();
    let expected = expected(path);
    let all = expected[0] + expected[1];
    assert!(expected.iter().all(|&count| count > 0), "{expected:?}");
    for split in ["frames", "tiles", "samples"] {
        let batch = format!("batch turn.toml -o {split} --split {split}");
        assert_eq!(last_line(path, &batch)["nan_samples"], all, "{split}");
        assert_eq!(last_line(path, &batch)["nan_samples"], all, "{split}, all done before");
    }
    let state = path.join("frames/turn.octray");
    assert_eq!([recorded(&state, 0), recorded(&state, 1)], expected);
    assert!(done(path, "batch turn.toml -o frames").contains("samples were not a number"));
    done(path, "plan turn.toml");
    let status: Value = serde_json::from_str(&done(path, "status turn.plan -o frames --json")).unwrap();
    assert_eq!(status["nan_samples"], all);
}

#[test]
fn a_checkpoint_keeps_the_count() {
    let folder = folder(&JOB.replace("1-2", "1"));
    let path = folder.path();
    let whole = last_line(path, "batch turn.toml -o whole --threads 1")["nan_samples"].as_u64().unwrap();
    let batch = "batch turn.toml -o out --threads 1 --checkpoint-every 0";
    for _ in 0..3 {
        let mut child = super::command(path, batch).stderr(std::process::Stdio::null()).spawn().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(15));
        child.kill().unwrap();
        child.wait().unwrap();
    }
    assert!(whole > 0);
    assert_eq!(last_line(path, batch)["nan_samples"], whole);
}
