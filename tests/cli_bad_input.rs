//! Bad input through the real binary: an exit code, a message that names the place, and no picture.

use std::path::Path;

use assert_cmd::Command;
use tempfile::TempDir;

const CAMERA: &str = "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n";

/// Runs `octray render` in a folder of its own; gives the exit code and standard error.
fn render_in(folder: &Path, args: &[&str]) -> (i32, String) {
    let output = Command::cargo_bin("octray")
        .unwrap()
        .current_dir(folder)
        .arg("render")
        .args(args)
        .args(["--set", "render.spp=1", "--progress", "none"])
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.stdout.is_empty(), "data on standard output: {text}");
    (output.status.code().expect("no signal"), text)
}

/// Writes files, renders the first, expects the exit code and all words in the message, and no picture.
fn expect(files: &[(&str, &[u8])], code: i32, words: &[&str]) {
    let folder = TempDir::new().unwrap();
    for (name, bytes) in files {
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    let (found, text) = render_in(folder.path(), &[files[0].0, "-o", "out.png"]);
    assert_eq!(found, code, "{}: {text}", String::from_utf8_lossy(files[0].1));
    for word in words {
        assert!(text.contains(word), "`{word}` is not in: {text}");
    }
    assert!(!text.contains("panicked"), "{text}");
    assert!(!folder.path().join("out.png").exists(), "a picture in spite of: {text}");
}

fn scene(rest: &str, words: &[&str]) {
    expect(&[("a.toml", format!("{CAMERA}{rest}\n").as_bytes())], 3, words);
}

#[test]
fn files_that_are_no_scene() {
    expect(&[("a.toml", b"")], 3, &["a.toml", "camera"]);
    expect(&[("a.toml", b"[camera]\nposition = [0, 0")], 3, &["a.toml:2"]);
    expect(&[("a.toml", b"\x89PNG\x00\xff\xfe\x01")], 3, &["a.toml"]);
    let folder = TempDir::new().unwrap();
    let (code, text) = render_in(folder.path(), &["missing.toml"]);
    assert!((code == 1 || code == 3) && text.contains("missing.toml"), "{code}: {text}");
}

#[test]
fn arrays_with_too_many_elements() {
    let expected = "invalid length 4, expected an array of length";
    expect(
        &[("a.toml", b"[camera]\nposition = [0, 0, 5, 7]\nlook_at = [0, 0, 0]\n")],
        3,
        &["a.toml:2", expected],
    );
    scene("[render]\nsize = [4, 3, 2, 1]", &["a.toml:5", expected]);
    let folder = TempDir::new().unwrap();
    std::fs::write(folder.path().join("a.toml"), CAMERA).unwrap();
    let (code, text) = render_in(folder.path(), &["a.toml", "--set", "camera.up=[0, 1, 0, 0]"]);
    assert!(
        code == 2 && text.contains("--set camera.up=[0, 1, 0, 0]") && text.contains(expected),
        "{code}: {text}"
    );
}

#[test]
fn values_of_a_wrong_type() {
    let words = "a.toml:1:10: invalid type: integer `3`, expected a table";
    expect(&[("a.toml", b"camera = 3")], 3, &[words]);
    scene("[[sphere]]\ncenter = 3\nradius = 1", &["a.toml:5", "integer `3`, expected an array"]);
    scene("[[sphere]]\ncenter = [0, 0, 0]\nradius = {}", &["a.toml:6", "table, expected a number"]);
    scene("[render]\nmax_depth = -3", &["a.toml:5", "expected a whole number"]);
    scene("[[material]]\nname = 1.5", &["a.toml:5", "float `1.5`, expected a string"]);
    scene("[[mesh]]\npath = [1]", &["a.toml:5", "array, expected a string"]);
}

#[test]
fn numbers_that_are_none() {
    scene("[[sphere]]\ncenter = [nan, 0, 0]\nradius = 1", &["a.toml:5", "center"]);
    scene("[[sphere]]\ncenter = [0, inf, 0]\nradius = 1", &["a.toml:5", "center"]);
    scene("[[sphere]]\ncenter = [0, 0, 0]\nradius = inf", &["a.toml:6", "radius"]);
    scene("[[light.point]]\nposition = [0, 0, 0]\nintensity = nan", &["a.toml:6", "intensity"]);
    scene("[[sphere]]\ncenter = [1e39, 0, 0]\nradius = 1", &["a.toml:5", "center"]);
}

#[test]
fn shapes_without_size() {
    scene("[[sphere]]\ncenter = [0, 0, 0]\nradius = 0", &["a.toml:6", "radius"]);
    scene("[[sphere]]\ncenter = [0, 0, 0]\nradius = -1", &["a.toml:6", "radius"]);
    scene("[[cylinder]]\nfrom = [1, 2, 3]\nto = [1, 2, 3]\nradius = 1", &["a.toml:"]);
    scene("[[cylinder]]\ncenter = [0, 0, 0]\nhalf_height = 0\nradius = 1", &["a.toml:6", "half_height"]);
    scene("[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 0, 0]", &["a.toml:6", "normal"]);
}

#[test]
fn meshes_that_make_no_sense() {
    scene("[[mesh]]\nvertices = [[0,0,0],[1,0,0],[0,1,0]]\nfaces = [[0,1,3]]", &["a.toml:6", "3"]);
    expect(&[("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n")], 3, &["a.obj:4"]);
    expect(&[("a.obj", b"v 0 0 0\nv 1 0 0\nv nan 1 0\nf 1 2 3\n")], 3, &["a.obj"]);
    expect(&[("a.obj", b"v 0 0 0\nv 1 0")], 3, &["a.obj"]);
    expect(&[("a.obj", b"")], 3, &["a.obj", "no faces"]);
    expect(&[("a.obj", b"\x7fELF\x00\x01\x02\xff")], 3, &["a.obj"]);
    expect(&[("a.ply", b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n")], 3, &["a.ply"]);
    expect(&[("a.obj", b"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")], 3, &["a.obj", "area"]);
}

#[test]
fn assets_that_are_missing() {
    let triangle = b"mtllib no.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";
    expect(&[("a.obj", triangle)], 3, &["a.obj:1", "no.mtl"]);
    let textured = b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";
    expect(&[("a.obj", textured), ("a.mtl", b"newmtl m\nmap_Kd no.png\n")], 3, &["no.png"]);
    scene("[[mesh]]\npath = 'no.obj'", &["no.obj"]);
    scene(
        "[[material]]\nname = 'm'\ntexture = 'no.png'\n[[sphere]]\ncenter=[0,0,0]\nradius=1\nmaterial='m'",
        &["no.png"],
    );
    scene("[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'gold'", &["a.toml:7", "gold"]);
}

#[test]
fn degenerate_triangles_are_counted_and_said() {
    let folder = TempDir::new().unwrap();
    let text = format!(
        "{CAMERA}[[triangle]]\nvertices = [[0,0,0],[1,1,1],[2,2,2]]\n[[mesh]]\nvertices = [[0,0,0],[1,0,0],[0,1,0]]\nfaces = [[0,1,2],[0,1,1]]\n"
    );
    std::fs::write(folder.path().join("a.toml"), text).unwrap();
    let (code, told) = render_in(folder.path(), &["a.toml"]);
    assert_eq!(code, 0, "{told}");
    assert!(told.contains("2 triangles without area"), "{told}");
}

#[test]
fn transforms_that_flatten() {
    let ball = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n";
    scene(&format!("{ball}transform = [{{ scale = [1, 0, 1] }}]"), &["a.toml:7", "scale"]);
    scene(&format!("{ball}transform = [{{ matrix = [[1,0,0,0],[2,0,0,0],[0,0,1,0]] }}]"), &["transform"]);
}

#[test]
fn groups_in_a_circle() {
    scene(
        "[[group]]\nname = 'a'\n[[group.instance]]\nof = 'b'\n[[group]]\nname = 'b'\n[[group.instance]]\nof = 'a'\n[[instance]]\nof = 'a'",
        &["a.toml:11", "`a` would contain itself"],
    );
}

/// Groups of which each shows the next so many times; the last one holds what is given.
fn levels(count: usize, times: usize, last: &str) -> String {
    let shows = |i: usize| format!("[[group.instance]]\nof = 'g{}'\n", i + 1).repeat(times);
    let groups: String = (1..count).map(|i| format!("[[group]]\nname = 'g{i}'\n{}", shows(i))).collect();
    format!("[[instance]]\nof = 'g1'\n{groups}[[group]]\nname = 'g{count}'\n{last}")
}

const SPHERE_IN_GROUP: &str = "[[group.sphere]]\ncenter = [0, 0, 0]\nradius = 1\n";

#[test]
fn groups_too_deep_or_too_many() {
    scene(&levels(2_000, 1, SPHERE_IN_GROUP), &["a.toml", "more than 256 deep"]);
    scene(&levels(40, 2, SPHERE_IN_GROUP), &["more than 4194304 instances"]);
    let folder = TempDir::new().unwrap();
    for (count, times, last) in [(256, 1, SPHERE_IN_GROUP), (40, 2, "")] {
        let text = format!("{CAMERA}[render]\nsize = [16, 12]\n{}", levels(count, times, last));
        std::fs::write(folder.path().join("a.toml"), text).unwrap();
        let (code, text) = render_in(folder.path(), &["a.toml", "-o", "out.png"]);
        assert_eq!(code, 0, "{count} levels: {text}");
    }
}

/// A ray between two mirrors goes as deep as it may.
#[test]
fn bounces_as_many_as_may_be() {
    let plane =
        |z: i32| format!("[[plane]]\npoint = [0, 0, {}]\nnormal = [0, 0, {z}]\nmaterial = 'm'\n", 9 * -z);
    let mirrors = format!(
        "[render]\nsize = [16, 12]\nmin_throughput = 0\nmax_depth = 256\n[[material]]\nname = 'm'\nkind = 'metal'\n\
         attenuation = 1\ntint = [1, 1, 1]\n{}{}",
        plane(1),
        plane(-1)
    );
    let folder = TempDir::new().unwrap();
    std::fs::write(folder.path().join("a.toml"), format!("{CAMERA}{mirrors}")).unwrap();
    let (code, text) = render_in(folder.path(), &["a.toml", "-o", "out.png"]);
    assert_eq!(code, 0, "{text}");
    scene(&mirrors.replace("256", "257"), &["a.toml:7", "max_depth", "257 bounces are more than 256"]);
    let (code, text) = render_in(folder.path(), &["seed", "--max-depth", "4294967295"]);
    assert!(code == 2 && text.contains("max_depth"), "{code}: {text}");
}

#[test]
fn cameras_and_sizes_that_show_nothing() {
    let head = "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n";
    for fov in ["0", "180", "nan"] {
        expect(&[("a.toml", format!("{head}fov_deg = {fov}").as_bytes())], 3, &["a.toml:4", "fov_deg"]);
    }
    scene("[render]\nsize = [0, 0]", &["a.toml:5", "size"]);
    scene("[render]\nsize = [1000000000, 1000000000]", &["a.toml:5", "size"]);
    let folder = TempDir::new().unwrap();
    for args in
        [["--size", "0x0"], ["--size", "1000000000x1000000000"], ["--spp", "0"], ["--crop", "0,0,9999,1"]]
    {
        let (code, text) = render_in(folder.path(), &["seed", args[0], args[1]]);
        assert_eq!(code, 2, "{args:?}: {text}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn samples_must_be_at_least_one() {
    let folder = TempDir::new().unwrap();
    std::fs::write(folder.path().join("a.toml"), format!("{CAMERA}[render]\nspp = 0\n")).unwrap();
    let mut command = Command::cargo_bin("octray").unwrap();
    let output = command.current_dir(folder.path()).args(["render", "a.toml", "-q"]).output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(3) && text.contains("a.toml:5") && text.contains("spp"), "{text}");
}

#[test]
fn names_that_nobody_knows() {
    scene("[[sphere]]\ncentre = [0, 0, 0]\nradius = 1", &["a.toml:5:1", "centre", "did you mean `center`"]);
    let folder = TempDir::new().unwrap();
    let (code, text) = render_in(folder.path(), &["sead"]);
    assert!(code == 2 && text.contains("sead") && text.contains("seed"), "{code}: {text}");
    let (code, text) = render_in(folder.path(), &["seed", "--set", "render.sp=3"]);
    assert!(code == 2 && text.contains("render.sp") || text.contains("did you mean `spp`"), "{code}: {text}");
}

#[test]
fn outputs_that_cannot_be_written() {
    let folder = TempDir::new().unwrap();
    for output in ["no/such/folder/a.png", "."] {
        let (code, text) = render_in(folder.path(), &["seed", "--size", "4x4", "-o", output]);
        assert!(code == 1 || code == 2, "{output}: {code}: {text}");
        assert!(text.starts_with("error: "), "{text}");
    }
    let (code, text) = render_in(folder.path(), &["seed", "--size", "4x4", "-o", "a.jpg"]);
    assert!(code == 2 && text.contains("a.jpg"), "{code}: {text}");
    if Path::new("/dev/full").exists() {
        let (code, text) =
            render_in(folder.path(), &["seed", "--size", "64x48", "-o", "/dev/full", "--format", "ppm"]);
        assert!(code == 1 && text.contains("/dev/full"), "{code}: {text}");
    }
}
