//! The schema of job files says what the parser says.

use super::{done, fails, folder};

/// A job with every key that there is.
const EVERY_KEY: &str = r#"
scene = "seed"
size = [16, 12]
spp = 1
max_depth = 2
seed = 7
seed_mode = "per_picture"
tier = "exact"
build_quality = "high"
frames = "1-2"
sweep_mode = "product"
[set]
"camera.fov_deg" = 40
[sweep]
"render.sampler" = { list = ["random", "sobol"] }
"material.glass.ior" = { range = [1.2, 1.5, 0.2] }
"render.exposure" = { linspace = [0, 1, 2] }
[[camera]]
name = "left"
set = { position = [-4, 2, -8] }
[[keyframes]]
key = "camera.fov_deg"
frames = [1, 2]
values = [30, 60]
interpolation = "catmull_rom"
[[keyframes]]
key = "camera.look_at"
frames = [1]
values = [[0, 1, 0]]
interpolation = "linear"
[[output]]
path = "{name}/{camera}/{sweep}.####.exr"
aovs = ["depth", "sample_count"]
camera_json = false
"#;

fn schema() -> serde_json::Value {
    let folder = tempfile::TempDir::new().unwrap();
    serde_json::from_str(&done(folder.path(), "schema job")).unwrap()
}

fn json(job: &str) -> serde_json::Value {
    serde_json::to_value(toml::from_str::<toml::Table>(job).unwrap()).unwrap()
}

#[test]
fn good_jobs_are_valid() {
    let validator = jsonschema::validator_for(&schema()).unwrap();
    for job in [&super::readme::job(), EVERY_KEY, super::SMALL] {
        let job_folder = folder(job);
        done(job_folder.path(), "plan turn.toml");
        let faults: Vec<String> = validator.iter_errors(&json(job)).map(|e| e.to_string()).collect();
        assert!(faults.is_empty(), "{faults:?} in {job}");
    }
}

/// A job that forgot a key of the schema would not notice when that key is gone.
#[test]
fn the_job_with_every_key_has_every_key() {
    let (schema, job) = (schema(), json(EVERY_KEY));
    let keys = |of: &serde_json::Value| -> Vec<String> {
        of["properties"].as_object().unwrap().keys().cloned().collect()
    };
    for key in keys(&schema) {
        assert!(job.get(&key).is_some(), "{key} at the top");
    }
    for (list, name) in [("camera", "JobCamera"), ("keyframes", "Keyframes"), ("output", "Output")] {
        for key in keys(&schema["$defs"][name]) {
            assert!(job[list][0].get(&key).is_some(), "{key} in {list}");
        }
    }
}

/// A number is a number, with or without a point.
#[test]
fn scenes_may_be_written_in_whole_numbers() {
    let folder = tempfile::TempDir::new().unwrap();
    let schema = serde_json::from_str(&done(folder.path(), "schema")).unwrap();
    let validator = jsonschema::validator_for(&schema).unwrap();
    for name in ["seed", "cornell", "glass", "spheres", "instances"] {
        let scene = done(folder.path(), &format!("scenes --write {name}"));
        let whole = [",", "]", " ", "\n"]
            .iter()
            .fold(scene.clone(), |text, after| text.replace(&format!(".0{after}"), after));
        assert!(whole.len() < scene.len(), "{name} has no whole number");
        std::fs::write(folder.path().join("whole.toml"), &whole).unwrap();
        assert!(validator.is_valid(&json(&whole)), "{name}");
        for (scene, file) in [("whole.toml", "whole.ppm"), (name, "scene.ppm")] {
            done(folder.path(), &format!("render {scene} --size 12x8 --spp 1 -o {file}"));
        }
        let bytes = |file: &str| std::fs::read(folder.path().join(file)).unwrap();
        assert!(bytes("whole.ppm") == bytes("scene.ppm"), "{name}");
    }
}

#[test]
fn what_the_parser_refuses_the_schema_refuses() {
    let validator = jsonschema::validator_for(&schema()).unwrap();
    let job = "scene = \"seed\"\nframes = \"1-2\"\n";
    let output = "[[output]]\npath = \"a.exr\"\n";
    let more = [
        "scene = 3",
        "sise = [4, 3]",
        "size = [4]",
        "size = [4, 3, 2]",
        "size = [4, -3]",
        "size = \"4x3\"",
        "spp = -1",
        "spp = 1.5",
        "max_depth = -1",
        "seed = -1",
        "seed_mode = \"random\"",
        "tier = \"quick\"",
        "build_quality = 1",
        "frames = 7",
        "sweep_mode = \"all\"",
        "set = 3",
        "sweep = { \"camera.fov_deg\" = [1, 2] }",
        "sweep = { \"camera.fov_deg\" = { linspace = [1, 2] } }",
        "sweep = { \"camera.fov_deg\" = { list = [1], range = [1, 2] } }",
        "camera = [{ nam = \"left\" }]",
        "keyframes = [{ key = \"camera.fov_deg\", frames = [1] }]",
        "keyframes = [{ key = \"camera.fov_deg\", frames = [1], values = [1], interpolation = \"cubic\" }]",
        "output = []",
        "output = [{ path = \"a.exr\", aovs = [\"normal\"] }]",
        "output = [{ aovs = [] }]",
    ];
    for line in more {
        let (key, _) = line.split_once(' ').unwrap();
        let kept = job.lines().filter(|kept| !kept.starts_with(&format!("{key} ")));
        let mut text: String = kept.map(|line| format!("{line}\n")).collect();
        text += &format!("{line}\n{}", if key == "output" { "" } else { output });
        refused_by_both(&validator, &text);
    }
    refused_by_both(&validator, output);
    refused_by_both(&validator, job);
}

fn refused_by_both(validator: &jsonschema::Validator, job: &str) {
    assert!(!validator.is_valid(&json(job)), "the schema lets this pass: {job}");
    fails(folder(job).path(), "plan turn.toml", 3, &[]);
}
