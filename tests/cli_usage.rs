//! The command line through the real binary: help, version, wrong use.

use assert_cmd::Command;

fn octray(arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("octray").unwrap();
    command.args(arguments);
    command
}

/// Standard output of a run that must succeed, with nothing on standard error.
fn stdout_of(arguments: &[&str]) -> String {
    let output = octray(arguments).unwrap();
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Standard error of a run that must end with `code` and print no data.
fn stderr_of(arguments: &[&str], code: i32) -> String {
    let output = octray(arguments).assert().code(code).get_output().clone();
    assert!(output.stdout.is_empty(), "{arguments:?} printed data");
    String::from_utf8(output.stderr).unwrap()
}

#[test]
fn help_names_every_verb_and_the_exit_codes() {
    let help = stdout_of(&["--help"]);
    for word in
        ["render", "inspect", "bench", "scenes", "schema", "completions", "man", "Exit codes", "NO_COLOR"]
    {
        assert!(help.contains(word), "{word} in\n{help}");
    }
}

#[test]
fn help_of_render_names_the_contract() {
    let help = stdout_of(&["render", "--help"]);
    for flag in [
        "[SCENE]",
        "-o,",
        "--output",
        "--format",
        "--size",
        "--spp",
        "--max-depth",
        "--seed",
        "--threads",
        "--tier",
        "--build-quality",
        "--crop",
        "--set",
        "--progress",
        "-q,",
        "watertight",
        "default: seed",
    ] {
        assert!(help.contains(flag), "{flag} in\n{help}");
    }
}

#[test]
fn the_version_says_the_simd_level() {
    let version = stdout_of(&["--version"]);
    assert!(version.starts_with(concat!("octray ", env!("CARGO_PKG_VERSION"), " (built for ")), "{version}");
}

#[test]
fn no_colour_off_a_terminal() {
    let error = stderr_of(&["render", "--size", "0x0"], 2);
    assert!(!error.contains('\x1b'), "{error:?}");
}

#[test]
fn wrong_use_is_exit_2_and_says_what_is_wrong() {
    for (arguments, part) in [
        (&[][..], "Usage"),
        (&["paint"], "paint"),
        (&["rendr"], "render"),
        (&["render", "--size", "640"], "640x480"),
        (&["render", "--size", "0x480"], "neither zero"),
        (&["render", "--size", "-1x480"], "-1"),
        (&["render", "--size", "99999999999x1"], "99999999999x1"),
        (&["render", "--spp", "0"], "--spp"),
        (&["render", "--spp", "many"], "--spp"),
        (&["render", "--max-depth", "-1"], "-1"),
        (&["render", "--seed", "1.5"], "--seed"),
        (&["render", "--threads", "1000000"], "4096"),
        (&["render", "--tier", "sloppy"], "watertight"),
        (&["render", "--build-quality", "best"], "balanced"),
        (&["inspect", "--build-quality", "best"], "balanced"),
        (&["render", "--crop", "1,2,3"], "left,top,width,height"),
        (&["render", "--crop", "1,2,0,4"], "not zero"),
        (&["render", "--set", "camera"], "key=value"),
        (&["render", "--progress", "loud"], "json"),
        (&["render", "--format", "jpg"], "pfm"),
        (&["render", "-o", "a.jpg"], "ppm, png, exr, pfm"),
        (&["render", "-o", "picture"], "ppm, png, exr, pfm"),
        (&["render", "a.toml", "b.toml"], "b.toml"),
        (&["completions", "dos"], "zsh"),
        (&["completions"], "SHELL"),
        (&["man", "paint"], "known are render"),
    ] {
        let error = stderr_of(arguments, 2);
        assert!(error.contains(part), "{arguments:?}: {part} in\n{error}");
    }
}

#[test]
fn every_shell_gets_a_script() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = stdout_of(&["completions", shell]);
        assert!(script.contains("max-depth"), "{shell}");
    }
}

#[test]
fn manual_pages_exist_for_the_program_and_its_verbs() {
    let page = stdout_of(&["man"]);
    assert!(page.contains(".TH octray 1") && page.contains("octray\\-render(1)"), "{page}");
    assert!(page.contains("Exit codes"), "{page}");
    for verb in ["render", "inspect", "bench", "scenes", "schema", "completions", "man"] {
        let page = stdout_of(&["man", verb]);
        assert!(page.contains(&format!(".TH octray-{verb} 1")), "{page}");
    }
}

#[test]
fn the_same_arguments_print_the_same_bytes() {
    for arguments in [&["man"][..], &["completions", "bash"], &["--help"]] {
        assert_eq!(stdout_of(arguments), stdout_of(arguments));
    }
}
