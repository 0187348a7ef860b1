//! The README's example does what it says.

use super::{done, folder, pictures};

/// The job file that the README shows.
pub(crate) fn job() -> String {
    let readme = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/README.md")).unwrap();
    let begin = readme.find("cat > turn.toml <<'END'\n").expect("the README writes turn.toml");
    let text = readme[begin..].split_once('\n').unwrap().1;
    text.split_once("\nEND\n").expect("the job ends").0.to_owned()
}

#[test]
fn the_turntable_has_48_frames_that_turn() {
    let folder = folder(&job());
    let path = folder.path();
    let planned = done(path, "plan turn.toml --shards 48");
    assert!(planned.contains("48 pictures, 48 units, 48 shards"), "{planned}");
    for shard in [0, 12] {
        done(path, &format!("run turn.plan --shard {shard}/48 -o out"));
    }
    let found = pictures(&path.join("out"));
    assert!(found["turn.0001.png"] != found["turn.0013.png"]);
    let camera = |frame: &str| -> serde_json::Value { serde_json::from_slice(&found[frame]).unwrap() };
    let [first, quarter] = ["turn.0001.camera.json", "turn.0013.camera.json"].map(camera);
    let position = |camera: &serde_json::Value| -> Vec<f64> {
        (0..3).map(|row| camera["camera_to_world"][row][3].as_f64().unwrap()).collect()
    };
    let (a, b) = (position(&first), position(&quarter));
    assert!(
        (a[0] * b[0] + a[2] * b[2]).abs() < 1e-9 && (a[1] - b[1]).abs() < 1e-9,
        "a quarter of a turn: {a:?} {b:?}"
    );
}
