//! What a program that starts batches can rely on.

use serde_json::Value;

use super::{SMALL, folder, octray, told};

fn events(folder: &std::path::Path, args: &str) -> (Vec<Value>, Option<i32>) {
    let output = octray(folder, args);
    let lines = String::from_utf8(output.stderr.clone()).unwrap();
    let events = lines.lines().map(|line| serde_json::from_str(line).unwrap_or_else(|_| panic!("{line}")));
    (events.collect(), output.status.code())
}

fn is_final(event: &Value) -> bool {
    event["event"] == "done" || event["event"] == "failed"
}

#[test]
fn json_is_one_object_a_line_and_exactly_one_is_final() {
    let good = folder(SMALL);
    let bad = folder("scene = \"seed\"\n[[output]]\npath = \"in/a.png\"\n");
    std::fs::write(bad.path().join("in"), "in the way").unwrap();
    for (folder, args, code, last) in [
        (&good, "batch turn.toml -o out --progress json", 0, "done"),
        (&good, "batch turn.toml -o out --progress json", 0, "done"),
        (&bad, "batch turn.toml --progress json", 1, "failed"),
        (&bad, "batch missing.toml --progress json", 3, "failed"),
    ] {
        let (events, exit) = events(folder.path(), args);
        assert_eq!(exit, Some(code), "{events:?}");
        assert_eq!(events.iter().filter(|event| is_final(event)).count(), 1, "{events:?}");
        assert_eq!(events.last().unwrap()["event"], last);
        let failed = events.iter().filter(|event| event["event"] == "unit_failed").count();
        assert_eq!(failed, usize::from(code == 1));
    }
}

/// The pictures are worth more than their log: all are there, and the exit code says that something is missing.
#[cfg(target_os = "linux")]
#[test]
fn a_log_that_cannot_be_written_is_told_once_and_pictures_are_kept() {
    let folder = folder(SMALL);
    for (progress, event) in [("plain", "error: "), ("json", "\"event\":\"failed\"")] {
        let said = super::fails(
            folder.path(),
            &format!("batch turn.toml --log /dev/full --progress {progress}"),
            1,
            &["cannot write /dev/full", "everything else is done", event],
        );
        assert_eq!(said.matches("/dev/full").count(), 1, "{said}");
        assert!(folder.path().join("turn.0004.png").exists());
    }
    let broken = super::folder("scene = \"none.toml\"\n[[output]]\npath = \"a.png\"\n");
    super::fails(broken.path(), "batch turn.toml --log /dev/full", 3, &["none.toml"]);
}

#[test]
fn quiet_is_quiet_and_the_log_tells_every_unit() {
    let folder = folder(SMALL);
    let output = octray(folder.path(), "batch turn.toml --quiet --log log.txt");
    assert!(output.status.success());
    assert_eq!(told(&output), "");
    let log = std::fs::read_to_string(folder.path().join("log.txt")).unwrap();
    for frame in 1..=4 {
        assert!(
            log.lines().any(|l| l.contains("unit done") && l.contains(&format!("frame {frame}"))),
            "{log}"
        );
    }
}
