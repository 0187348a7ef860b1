//! The file system cases: replaced, kept, protected, special, linked.

use super::*;
use crate::output::{Picture, read_file};

fn film() -> Film {
    Film::from_pixels(2, 1, vec![[1.0, 0.0, 0.5]; 2]).unwrap()
}

fn names_in(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

fn cause(error: OutputError) -> io::Error {
    match error {
        OutputError::Write { cause, .. } => cause,
        other => panic!("{other}"),
    }
}

#[test]
fn every_format_is_written_and_nothing_else_remains() {
    let folder = tempfile::tempdir().unwrap();
    for format in Format::ALL {
        let path = folder.path().join("picture").with_extension(format.name());
        let written = write_file(&path, &film(), format, Tone::default()).unwrap();
        assert_eq!(written.size_bytes, fs::metadata(&path).unwrap().len());
        match read_file(&path).unwrap() {
            Picture::Display(picture) => assert_eq!(picture.bytes, [255, 0, 188, 255, 0, 188]),
            Picture::Light(light) => assert_eq!(light, film()),
        }
    }
    assert_eq!(names_in(folder.path()), ["picture.exr", "picture.pfm", "picture.png", "picture.ppm"]);
}

#[test]
fn an_old_file_is_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ppm");
    fs::write(&path, vec![7; 10_000]).unwrap();
    write_file(&path, &film(), Format::Ppm, Tone::default()).unwrap();
    assert_eq!(fs::read(&path).unwrap().len(), 17);
}

#[test]
fn failing_halfway_keeps_the_old_file_and_no_other() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ppm");
    fs::write(&path, "old").unwrap();
    let error = store(&target_of(&path).unwrap(), |file| {
        file.write_all(b"half a pic")?;
        Err(io::ErrorKind::StorageFull.into())
    });
    assert_eq!(error.unwrap_err().kind(), io::ErrorKind::StorageFull);
    assert_eq!(fs::read(&path).unwrap(), b"old");
    assert_eq!(names_in(folder.path()), ["a.ppm"]);
}

#[test]
fn failing_halfway_leaves_no_new_file() {
    let folder = tempfile::tempdir().unwrap();
    let target = target_of(&folder.path().join("a.ppm")).unwrap();
    store(&target, |_| Err(io::ErrorKind::StorageFull.into())).unwrap_err();
    assert!(names_in(folder.path()).is_empty());
}

#[test]
fn a_panic_halfway_leaves_no_new_file() {
    let folder = tempfile::tempdir().unwrap();
    let target = target_of(&folder.path().join("a.ppm")).unwrap();
    std::panic::catch_unwind(|| store(&target, |_| panic!("stopped"))).unwrap_err();
    assert!(names_in(folder.path()).is_empty());
}

#[test]
fn a_bad_film_touches_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    fs::write(&path, "old").unwrap();
    let error = write_file(&path, &Film::default(), Format::Png, Tone::default()).unwrap_err();
    assert_eq!(cause(error).kind(), io::ErrorKind::InvalidInput);
    assert_eq!(fs::read(&path).unwrap(), b"old");
}

#[test]
fn missing_folders_and_folders_as_targets_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("missing/a.ppm");
    for write in [check_writable, |path: &Path| write_atomically(path, b"x")] {
        assert_eq!(cause(write(&missing).unwrap_err()).kind(), io::ErrorKind::NotFound);
        assert_eq!(cause(write(folder.path()).unwrap_err()).kind(), io::ErrorKind::IsADirectory);
    }
}

#[test]
fn checking_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let (old, new) = (folder.path().join("old.ppm"), folder.path().join("new.ppm"));
    fs::write(&old, "old").unwrap();
    check_writable(&old).unwrap();
    check_writable(&new).unwrap();
    assert_eq!(fs::read(&old).unwrap(), b"old");
    assert_eq!(names_in(folder.path()), ["old.ppm"]);
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::os::unix::fs::{PermissionsExt, symlink};

    fn mode(path: &Path) -> u32 {
        fs::metadata(path).unwrap().permissions().mode() & 0o7777
    }

    #[test]
    fn permissions_are_those_of_any_new_file() {
        let folder = tempfile::tempdir().unwrap();
        let (ours, plain) = (folder.path().join("a.ppm"), folder.path().join("plain"));
        write_atomically(&ours, b"x").unwrap();
        fs::write(&plain, "x").unwrap();
        assert_eq!(mode(&ours), mode(&plain));
    }

    #[test]
    fn permissions_of_an_old_file_stay() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.ppm");
        fs::write(&path, "old").unwrap();
        fs::set_permissions(&path, Permissions::from_mode(0o640)).unwrap();
        write_atomically(&path, b"new").unwrap();
        assert_eq!(mode(&path), 0o640);
    }

    #[test]
    fn a_link_stays_a_link() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file.ppm"), folder.path().join("link.ppm"));
        for before in [None, Some("old")] {
            if let Some(text) = before {
                fs::write(&file, text).unwrap();
            }
            let _ = symlink("file.ppm", &link);
            write_atomically(&link, b"new").unwrap();
            assert_eq!(fs::read_link(&link).unwrap(), Path::new("file.ppm"));
            assert_eq!(fs::read(&file).unwrap(), b"new");
        }
    }

    #[test]
    fn links_in_a_ring_are_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let (a, b) = (folder.path().join("a.ppm"), folder.path().join("b.ppm"));
        symlink(&b, &a).unwrap();
        symlink(&a, &b).unwrap();
        write_atomically(&a, b"x").unwrap_err();
    }

    #[test]
    fn a_pipe_is_written_directly() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let reader = std::thread::spawn({
            let pipe = pipe.clone();
            move || fs::read(pipe).unwrap()
        });
        let written = write_file(&pipe, &film(), Format::Ppm, Tone::default()).unwrap();
        assert_eq!(reader.join().unwrap().len() as u64, written.size_bytes);
        assert_eq!(names_in(folder.path()), ["pipe"]);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_device_is_reported_and_stays_a_device() {
        use std::os::unix::fs::FileTypeExt;
        for format in Format::ALL {
            let error = write_file(Path::new("/dev/full"), &film(), format, Tone::default()).unwrap_err();
            assert_eq!(cause(error).kind(), io::ErrorKind::StorageFull);
        }
        assert!(fs::metadata("/dev/full").unwrap().file_type().is_char_device());
        write_file(Path::new("/dev/null"), &film(), Format::Png, Tone::default()).unwrap();
    }
}
