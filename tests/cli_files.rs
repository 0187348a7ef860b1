//! Files and streams that cannot be written, through the real binary.

use std::fs;
use std::path::Path;
use std::process::Stdio;

use assert_cmd::Command;

fn octray(arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("octray").unwrap();
    command.args(arguments);
    command
}

/// Standard error of a run that must end with `code` and print no data.
fn stderr_of(arguments: &[&str], code: i32) -> String {
    let output = octray(arguments).assert().code(code).get_output().clone();
    assert!(output.stdout.is_empty(), "{arguments:?} printed data");
    String::from_utf8(output.stderr).unwrap()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn a_missing_folder_is_known_before_rendering() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("missing/a.png");
    let error = stderr_of(&["render", "-o", text(&path)], 1);
    assert!(error.starts_with(&format!("error: cannot write {}: ", text(&path))), "{error}");
    assert_eq!(error.lines().count(), 1, "{error}");
}

/// The camera's numbers are written last, after all the work.
#[test]
fn a_camera_file_that_cannot_be_written_is_known_before_rendering() {
    let folder = tempfile::tempdir().unwrap();
    let camera = folder.path().join("a.camera.json");
    fs::create_dir(&camera).unwrap();
    let picture = folder.path().join("a.exr");
    let endless = ["render", "--aovs", "depth", "--spp", "1000000", "-o", text(&picture)];
    let error = stderr_of(&endless, 1);
    assert!(error.contains(&format!("cannot write {}", text(&camera))), "{error}");
    assert!(!picture.exists());
}

#[test]
fn a_folder_is_no_output() {
    let folder = tempfile::tempdir().unwrap();
    let error = stderr_of(&["render", "--format", "png", "-o", text(folder.path())], 1);
    assert!(error.contains("directory"), "{error}");
}

#[test]
fn a_file_is_no_folder() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "text").unwrap();
    stderr_of(&["render", "-o", text(&file.join("a.png"))], 1);
    assert_eq!(fs::read(&file).unwrap(), b"text");
}

#[test]
fn failing_in_json_is_one_object_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("missing/a.png");
    let error = stderr_of(&["render", "--progress", "json", "-o", text(&path)], 1);
    assert_eq!(error.lines().count(), 1, "{error}");
    let event: serde_json::Value = serde_json::from_str(&error).unwrap();
    assert_eq!((&event["event"], &event["exit_code"]), (&"failed".into(), &1.into()));
    assert!(event["error"].as_str().unwrap().contains("cannot write"));
}

#[test]
fn a_failed_render_leaves_the_folder_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    fs::write(&path, "old").unwrap();
    octray(&["render", "no-such-scene", "-o", text(&path)]).assert().failure();
    assert_eq!(fs::read(&path).unwrap(), b"old");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_output_is_an_error() {
    for arguments in [&["man"][..], &["completions", "bash"]] {
        let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_octray"))
            .args(arguments)
            .stdout(full)
            .stderr(Stdio::piped())
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        assert!(String::from_utf8_lossy(&output.stderr).contains("standard output"));
    }
}

#[cfg(unix)]
#[test]
fn a_reader_that_leaves_is_no_panic() {
    for arguments in [&["man"][..], &["completions", "bash"], &["--help"]] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_octray"))
            .args(arguments)
            .stdout(writer)
            .stderr(Stdio::piped())
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(0), "{arguments:?}");
        assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    }
}

#[cfg(unix)]
#[test]
fn nobody_listening_to_errors_is_no_panic() {
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let status = std::process::Command::new(env!("CARGO_BIN_EXE_octray"))
        .args(["render", "-o", "/missing/a.png"])
        .stderr(writer)
        .status()
        .unwrap();
    assert_eq!(status.code(), Some(1));
}

/// A mesh file that can be read once: a pipe. Whoever opens it again waits for ever.
#[cfg(unix)]
#[test]
fn a_mesh_is_read_once_however_often_it_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let camera = "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n";
    let group = "[[group]]\nname = 'g'\n[[group.mesh]]\npath = 'a.obj'\n[[instance]]\nof = 'g'\n";
    let twice = "[[mesh]]\npath = 'a.obj'\ntransform = [{ scale = 2 }]\n[[mesh]]\npath = 'a.obj'\n";
    fs::write(folder.path().join("a.toml"), format!("{camera}{group}{twice}")).unwrap();
    let mesh = folder.path().join("a.obj");
    assert!(std::process::Command::new("mkfifo").arg(&mesh).status().unwrap().success());
    for (source, shown) in [("a.toml", "a.png"), ("a.obj", "b.png")] {
        let mesh = mesh.clone();
        std::thread::spawn(move || fs::write(mesh, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
        let mut render =
            octray(&["render", source, "-o", shown, "--size", "8x8", "--spp", "1", "--progress", "none"]);
        render.current_dir(folder.path()).timeout(std::time::Duration::from_secs(60)).assert().success();
        assert!(folder.path().join(shown).exists());
    }
}
