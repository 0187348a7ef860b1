//! Arguments as typed.

use super::*;
use clap::CommandFactory;

fn render(line: &str) -> RenderArgs {
    match Args::parse_from(["octray", "render"].into_iter().chain(line.split_whitespace())).verb {
        Verb::Render(args) => *args,
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_command_is_consistent() {
    Args::command().debug_assert();
}

#[test]
fn sizes_and_crops() {
    assert_eq!(parse_size("640x480"), Ok([640, 480]));
    for bad in ["", "640", "0x480", "640x0", "x", "-1x5", "1e3x5", "640x480x3", "5000000000x1"] {
        assert!(parse_size(bad).is_err(), "{bad}");
    }
    assert_eq!(render::parse_crop("0,1, 20,30"), Ok([0, 1, 20, 30]));
    for bad in ["", "1,2,3", "1,2,3,0", "1,2,0,4", "1,2,3,4,5", "-1,2,3,4"] {
        assert!(render::parse_crop(bad).is_err(), "{bad}");
    }
}

#[test]
fn assignments_keep_what_follows_the_first_sign() {
    let pair = |key: &str, value: &str| Ok((key.to_owned(), value.to_owned()));
    assert_eq!(parse_assignment("material.0.name=a=b"), pair("material.0.name", "a=b"));
    assert_eq!(parse_assignment("camera.fov_deg = 40"), pair("camera.fov_deg", "40"));
    for bad in ["", "=", "=4", "camera"] {
        assert!(parse_assignment(bad).is_err(), "{bad}");
    }
}

#[test]
fn flags_are_short_for_assignments_and_come_last() {
    let args = render(
        "a.toml --spp 4 --set render.spp=9 --size 3x2 --seed 7 --max-depth 0 --tier exact --build-quality high",
    );
    let assignments: Vec<String> =
        args.assignments().iter().map(|(key, value)| format!("{key}={value}")).collect();
    assert_eq!(
        assignments,
        [
            "render.spp=9",
            "render.size=[3, 2]",
            "render.spp=4",
            "render.max_depth=0",
            "render.seed=7",
            "render.tier=\"exact\"",
            "render.build_quality=\"high\""
        ]
    );
    assert!(render("").assignments().is_empty());
}
