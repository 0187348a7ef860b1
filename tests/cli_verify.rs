//! `octray verify` through the real binary, small.

use assert_cmd::Command;

fn verify(arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("octray").unwrap();
    command.arg("verify").args(arguments);
    command
}

fn stdout_of(arguments: &[&str]) -> String {
    String::from_utf8(verify(arguments).assert().code(0).get_output().stdout.clone()).unwrap()
}

#[test]
fn families_are_listed_with_a_line_each() {
    let list = stdout_of(&["--list"]);
    assert!(list.lines().count() >= 30, "{list}");
    for family in ["closed-inside", "slivers", "ground", "rims", "box-planes", "glass-chain"] {
        assert!(list.lines().any(|line| line.starts_with(&format!("{family} "))), "{family} in\n{list}");
    }
}

#[test]
fn a_row_for_each_family_and_tier_with_a_verdict() {
    let table = stdout_of(&["--rays", "300", "--family", "closed-inside,spheres,leaving"]);
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split_whitespace().collect()).collect();
    for (family, tier, verdict) in [
        ("closed-inside", "fast", "holds"),
        ("spheres", "fast", "measured"),
        ("closed-inside", "watertight", "holds"),
        ("spheres", "exact", "holds"),
        ("leaving", "watertight", "holds"),
    ] {
        let found = rows.iter().any(|row| row.starts_with(&[family, tier]) && row.last() == Some(&verdict));
        assert!(found, "{family} {tier} {verdict} in\n{table}");
    }
}

#[test]
fn every_family_keeps_its_bounds_in_a_short_run() {
    let table = stdout_of(&["--rays", "200"]);
    assert!(!table.contains("BROKEN"), "{table}");
}

#[test]
fn the_report_is_written_whole() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("report.json");
    let path = file.to_str().unwrap();
    stdout_of(&[
        "--rays",
        "200",
        "--family",
        "triangle-edges",
        "--tier",
        "fast",
        "--json",
        path,
        "--seed",
        "9",
    ]);
    let report: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(&file).unwrap()).unwrap();
    assert_eq!((&report["seed"], &report["rays"]), (&9.into(), &200.into()));
    let family = &report["families"][0];
    assert_eq!(family["tier"], "fast");
    let rate = family["rates"].as_array().unwrap().iter().find(|rate| rate["what"] == "false miss").unwrap();
    assert!(
        rate["count"].as_u64().unwrap() > 0 && rate["example"].as_str().unwrap().contains("Triangle"),
        "{rate}"
    );
}

#[test]
fn wrong_use_is_told() {
    for (arguments, code, part) in [
        (&["--family", "cubes"][..], 2, "closed-inside"),
        (&["--tier", "sloppy"], 2, "watertight"),
        (&["--rays", "0"], 2, "--rays"),
        (&["--rays", "9", "--json", "/nowhere/at/all.json"], 1, "/nowhere/at/all.json"),
    ] {
        let output = verify(arguments).assert().code(code).get_output().stderr.clone();
        let error = String::from_utf8(output).unwrap();
        assert!(error.contains(part), "{arguments:?}: {part} in\n{error}");
    }
}
