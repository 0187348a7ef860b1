//! `octray bench` through the real binary, small.

use std::path::Path;

use assert_cmd::Command;

/// `octray bench` at a small size with further arguments.
fn bench(arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("octray").unwrap();
    command.args(["bench", "--size", "64x64", "--runs", "2"]).args(arguments).env_remove("OCTRAY_EMBREE");
    command
}

fn stdout_of(arguments: &[&str]) -> String {
    String::from_utf8(bench(arguments).assert().code(0).get_output().stdout.clone()).unwrap()
}

fn stderr_of(arguments: &[&str], code: i32) -> String {
    String::from_utf8(bench(arguments).assert().code(code).get_output().stderr.clone()).unwrap()
}

fn path(file: &Path) -> &str {
    file.to_str().unwrap()
}

#[test]
fn a_row_for_each_scene_and_class_and_the_means() {
    let table = stdout_of(&["seed", "terrain:2000@outside", "--classes", "primary,ao"]);
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split_whitespace().collect()).collect();
    let has = |start: &[&str]| rows.iter().any(|row| row.starts_with(start));
    for start in [
        &["scene", "class", "rays", "hit", "octray"][..],
        &["seed", "primary", "4096"],
        &["seed", "ao"],
        &["terrain-2000@outside", "primary", "4096"],
        &["geometric", "mean", "primary"],
        &["scene", "build"],
        &["seed", "octray,"],
    ] {
        assert!(has(start), "{start:?} in\n{table}");
    }
    assert!(!table.contains("diffuse"), "{table}");
}

#[test]
fn bare_meshes_and_all_tiers() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = folder.path().join("slab.obj");
    std::fs::write(&mesh, "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0.5 1 0.5\nf 1 2 3 4\nf 1 2 5\nf 3 4 5\n")
        .unwrap();
    for tier in ["fast", "watertight", "exact"] {
        let table = stdout_of(&[path(&mesh), "--tier", tier, "--threads", "2"]);
        assert!(table.contains("slab@outside") && table.contains(tier), "{table}");
    }
    let table = stdout_of(&[&format!("{}@inside", path(&mesh)), "--classes", "primary"]);
    assert!(table.contains("slab@inside"), "{table}");
}

#[test]
fn a_report_is_written_and_compared_with() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("then.json");
    let arguments = ["cornell", "--classes", "primary,shadow"];
    stdout_of(&[&arguments[..], &["--json", path(&file)]].concat());
    let text = std::fs::read_to_string(&file).unwrap();
    let report: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(report["settings"]["size"], serde_json::json!([64, 64]));
    assert_eq!(report["scenes"][0]["classes"][1]["class"], "shadow");
    assert!(report["scenes"][0]["classes"][0]["engines"][0]["mrays_s"]["median"].as_f64().unwrap() > 0.0);

    // Rates that no machine reaches, and rates that every machine reaches.
    for (factor, code, word) in [(1e6, 4, "slower"), (1e-6, 0, "faster")] {
        let mut then = report.clone();
        for class in then["scenes"][0]["classes"].as_array_mut().unwrap() {
            for rate in class["engines"][0]["mrays_s"].as_object_mut().unwrap().values_mut() {
                *rate = (rate.as_f64().unwrap() * factor).into();
            }
        }
        std::fs::write(&file, then.to_string()).unwrap();
        let output = bench(&[&arguments[..], &["--baseline", path(&file)]].concat())
            .assert()
            .code(code)
            .get_output()
            .clone();
        assert!(String::from_utf8(output.stdout).unwrap().contains(word), "{word}");
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(errors.contains("2 of 2 classes of rays became slower"), code == 4, "{errors}");
    }
}

#[test]
fn bad_baselines_are_told_with_their_line() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("bad.json");
    std::fs::write(&file, "{\n  \"octray\": 1\n}\n").unwrap();
    let error = stderr_of(&["seed", "--baseline", path(&file)], 3);
    assert!(error.contains("bad.json:2:") && error.contains("expected a string"), "{error}");
    let error = stderr_of(&["seed", "--baseline", path(&folder.path().join("none.json"))], 1);
    assert!(error.contains("cannot read") && error.contains("none.json"), "{error}");

    stdout_of(&["seed", "--classes", "primary", "--json", path(&file)]);
    let error = stderr_of(&["seed", "--classes", "primary", "--tier", "fast", "--baseline", path(&file)], 2);
    assert!(error.contains("tier watertight") && error.contains("tier fast"), "{error}");
    let error = stderr_of(&["cornell", "--classes", "primary", "--baseline", path(&file)], 2);
    assert!(error.contains("none of the scenes"), "{error}");
}

#[test]
fn wrong_use_and_bad_scenes() {
    for (arguments, code, part) in [
        (&["--classes", "mirror"][..], 2, "reflect"),
        (&["--view", "above"], 2, "inside"),
        (&["--runs", "0"], 2, "--runs"),
        (&["--embree", "/nowhere"], 2, "--peers"),
        (&["--peers=optix"], 2, "embree"),
        (&["no-such-scene"], 2, "no built-in scene"),
        (&["nowhere.obj"], 3, "nowhere.obj"),
        (&["seed", "--json", "/nowhere/at/all.json"], 1, "/nowhere/at/all.json"),
    ] {
        let error = stderr_of(arguments, code);
        assert!(error.contains(part), "{arguments:?}: {part} in\n{error}");
    }
}

#[cfg(not(feature = "peers"))]
#[test]
fn peers_need_a_build_with_them() {
    assert!(stderr_of(&["seed", "--peers"], 2).contains("--features peers"));
}

#[cfg(feature = "peers")]
mod peers {
    use super::*;

    #[test]
    fn crates_stand_beside_octray_without_embree() {
        let table = stdout_of(&["terrain:2000", "--peers"]);
        assert!(table.contains("obvhs") && table.contains("bvh") && table.contains("octray is"), "{table}");
        let table = stdout_of(&["terrain:2000", "--classes", "primary", "--peers=obvhs"]);
        assert!(table.contains("obvhs") && !table.contains("  bvh  "), "{table}");
        let error = stderr_of(&["spheres", "--classes", "primary", "--peers"], 0);
        assert!(error.contains("without Embree") && error.contains("without obvhs"), "{error}");
    }

    #[test]
    fn a_path_without_embree_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let error = stderr_of(&["seed", "--peers", "--embree", path(folder.path())], 1);
        assert!(error.contains("libembree4"), "{error}");
    }

    /// Embree answers as octray does on every kind of primitive, in every mode.
    #[test]
    fn embree_finds_the_same_hits() {
        let Some(embree) = std::env::var_os("OCTRAY_EMBREE") else {
            return println!("skipped: OCTRAY_EMBREE names no Embree");
        };
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("report.json");
        for scene in ["spheres", "terrain:2000", "seed"] {
            bench(&[scene, "--peers", "--json", path(&file)]).env("OCTRAY_EMBREE", &embree).assert().code(0);
            let report: serde_json::Value =
                serde_json::from_str(&std::fs::read_to_string(&file).unwrap()).unwrap();
            for class in report["scenes"][0]["classes"].as_array().unwrap() {
                let embree: Vec<_> =
                    class["engines"].as_array().unwrap().iter().filter(|e| e["engine"] == "embree").collect();
                assert_eq!(embree.len(), 6);
                // Embree rounds more on spheres and cylinders: a few rays that graze them.
                let most = class["rays"].as_u64().unwrap() / 500;
                for engine in embree {
                    assert!(engine["differs"]["hits"].as_u64().unwrap() <= most, "{scene}: {class}");
                }
            }
        }
    }
}

#[test]
fn costs_over_size_are_fitted_and_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let (plot, json) = (folder.path().join("size.svg"), folder.path().join("size.json"));
    let scenes = ["terrain:200", "terrain:800", "terrain:3200"];
    let wanted = ["--classes", "primary", "--plot", path(&plot), "--json", path(&json)];
    let table = stdout_of(&[&scenes[..], &wanted].concat());
    for name in ["build", "memory", "primary"] {
        let law = |line: &&str| line.starts_with(name) && (line.contains("n^") || line.contains("log2 n"));
        assert!(table.lines().any(|line| law(&line)), "{name} in\n{table}");
    }
    let report: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(&json).unwrap()).unwrap();
    let points = report["scaling"]["curves"][1]["points"].as_array().unwrap();
    let stored = &report["scenes"][2]["builds"][0]["bytes_a_prim"];
    assert!(points.len() == 3 && points[2]["cost"] == *stored, "{points:?}");
    let svg = std::fs::read_to_string(&plot).unwrap();
    assert_eq!(roxmltree::Document::parse(&svg).unwrap().root_element().tag_name().name(), "svg");
}

/// Two scenes are refused at once; three of two sizes once that is known, with all that was measured kept.
#[test]
fn too_few_sizes_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (plot, json) = (folder.path().join("size.svg"), folder.path().join("size.json"));
    let wanted = ["--classes", "primary", "--plot", path(&plot), "--json", path(&json)];
    let few = stderr_of(&[&["terrain:200", "terrain:800"], &wanted[..]].concat(), 2);
    assert!(few.contains("at least 3") && few.contains("found 2") && !json.exists(), "{few}");
    let same = stderr_of(&[&["terrain:200", "terrain:800", "terrain:200"], &wanted[..]].concat(), 2);
    assert!(same.contains("found 2") && json.exists() && !plot.exists(), "{same}");
}
