//! Full disks and folders that cannot be written: a clear error, finished work kept, and resuming works.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::{SMALL, assert_same, done, fails, folder, pictures, undisturbed};

/// A file system in memory, taken away at the end.
struct Tmpfs<'a>(&'a Path);

impl<'a> Tmpfs<'a> {
    /// `None` where this user cannot mount.
    fn of(folder: &'a Path, size: &str) -> Option<Self> {
        fs::create_dir_all(folder).unwrap();
        let mounted = Command::new("mount")
            .args(["-t", "tmpfs", "-o", &format!("size={size}"), "tmpfs"])
            .arg(folder)
            .output();
        mounted.is_ok_and(|output| output.status.success()).then_some(Self(folder))
    }

    fn resize(&self, size: &str) {
        let mut mount = Command::new("mount");
        assert!(mount.args(["-o", &format!("remount,size={size}")]).arg(self.0).status().unwrap().success());
    }
}

impl Drop for Tmpfs<'_> {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(self.0).status();
    }
}

#[test]
fn a_full_disk_is_named_and_what_was_finished_stays() {
    let expected = undisturbed(SMALL);
    let folder = folder(SMALL);
    let output = folder.path().join("out");
    let Some(disk) = Tmpfs::of(&output, "160k") else {
        return println!("skipped: no file system can be mounted here");
    };
    fails(
        folder.path(),
        "batch turn.toml -o out --threads 1",
        1,
        &["cannot write", "No space left", "units failed"],
    );
    let kept = pictures(&output);
    assert!(!kept.is_empty() && kept.len() < expected.len(), "{} files", kept.len());
    assert!(kept.iter().all(|(name, bytes)| expected[name] == *bytes), "every file is whole");
    disk.resize("10m");
    let said = done(folder.path(), "batch turn.toml -o out --threads 1");
    assert!(!said.contains("4 units done"), "{said}");
    assert_same(&pictures(&output), &expected);
}

#[test]
fn a_folder_that_cannot_be_made_is_named() {
    let folder = folder(SMALL);
    fs::write(folder.path().join("file"), "").unwrap();
    fails(folder.path(), "batch turn.toml -o file/out", 1, &["cannot write file/out/turn.octray"]);
    fails(folder.path(), "plan turn.toml -o file/turn.plan", 1, &["file/turn.plan"]);
    fails(folder.path(), "batch turn.toml --log file/log", 1, &["file/log"]);
}

#[test]
fn failed_units_are_listed_and_do_not_stop_the_rest_unless_asked_to() {
    let job = "scene = \"seed\"\nsize = [16, 12]\nspp = 1\n[sweep]\n\"render.seed\" = { range = [0, 200] }\n\
        [[output]]\npath = \"{render.seed}/a.png\"\n";
    // Pictures that are on their way to the disk when the first one fails are still finished: a dozen or two.
    for (flag, done_at_least, done_at_most) in [("", 199, 199), ("--fail-fast", 0, 150)] {
        let folder = folder(job);
        fs::create_dir(folder.path().join("out")).unwrap();
        fs::write(folder.path().join("out/0"), "in the way").unwrap();
        let batch = format!("batch turn.toml -o out --threads 1 {flag}");
        fails(folder.path(), &batch, 1, &["1 of 200 units failed", "render.seed = 0", "out/0"]);
        let count = pictures(&folder.path().join("out")).len() - 1;
        assert!((done_at_least..=done_at_most).contains(&count), "{count} pictures {flag}");
        fs::remove_file(folder.path().join("out/0")).unwrap();
        done(folder.path(), &batch);
    }
}
