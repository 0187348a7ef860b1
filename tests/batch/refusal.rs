//! Files that are not what they should be are named and refused.

use std::fs;
use std::path::{Path, PathBuf};

use super::{SMALL, done, fails, folder};

const MESH: &str = "v -1 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n";

/// A scene file with a mesh file.
fn with_mesh() -> tempfile::TempDir {
    let folder = folder(
        "scene = \"scene.toml\"\nsize = [32, 24]\nspp = 2\nframes = \"1-2\"\n[[output]]\npath = \"a.#.png\"\n",
    );
    fs::write(folder.path().join("mesh.obj"), MESH).unwrap();
    let scene = "[camera]\nposition = [0, 1, 5]\nlook_at = [0, 0, 0]\n[[mesh]]\npath = \"mesh.obj\"\n";
    fs::write(folder.path().join("scene.toml"), scene).unwrap();
    folder
}

fn append(path: &Path, text: &str) {
    let old = fs::read_to_string(path).unwrap();
    fs::write(path, old + text).unwrap();
}

fn state(folder: &Path, file: &str) -> PathBuf {
    folder.join("turn.octray").join(file)
}

#[test]
fn a_changed_scene_or_asset_is_named() {
    for (file, more) in [("mesh.obj", "v 9 9 9\n"), ("scene.toml", "[render]\nspp = 3\n")] {
        let folder = with_mesh();
        let path = folder.path();
        done(path, "plan turn.toml");
        append(&path.join(file), more);
        fails(path, "run turn.plan", 3, &[file, "has changed since the plan was made"]);
        fails(path, "merge turn.plan --partial", 3, &[file, "has changed"]);
    }
    let folder = with_mesh();
    done(folder.path(), "plan turn.toml");
    fs::remove_file(folder.path().join("mesh.obj")).unwrap();
    fails(folder.path(), "run turn.plan", 3, &["mesh.obj"]);
}

#[test]
fn a_changed_material_file_is_named_however_the_mesh_names_it() {
    for line in ["mtllib red.mtl", "mtllib \\\nred.mtl", "mtllib other.mtl \\\n  red.mtl", "mtllib\tred.mtl"]
    {
        let folder = with_mesh();
        let path = folder.path();
        fs::write(path.join("red.mtl"), "newmtl red\nKd 1 0 0\nmap_Kd red.png\n").unwrap();
        fs::write(path.join("other.mtl"), "newmtl other\nKd 0 1 0\n").unwrap();
        done(path, "render seed --size 4x4 --spp 1 -o red.png");
        fs::write(path.join("mesh.obj"), format!("{line}\n{MESH}usemtl red\nf 1 2 4\n")).unwrap();
        done(path, "plan turn.toml");
        done(path, "batch turn.toml");
        append(&path.join("red.mtl"), "Ns 3\n");
        fails(path, "batch turn.toml", 3, &["red.mtl has changed", "--force"]);
        fails(path, "run turn.plan", 3, &["red.mtl has changed since the plan was made"]);
        done(path, "batch turn.toml --force");
        done(path, "render seed --size 5x4 --spp 1 -o red.png");
        fails(path, "batch turn.toml", 3, &["red.png has changed"]);
    }
}

#[test]
fn a_changed_job_does_not_mix_with_finished_work() {
    let folder = with_mesh();
    let path = folder.path();
    done(path, "batch turn.toml");
    append(&path.join("mesh.obj"), "v 9 9 9\n");
    fails(path, "batch turn.toml", 3, &["begun with another plan", "mesh.obj has changed", "--force"]);
    done(path, "batch turn.toml --force");
    let job = fs::read_to_string(path.join("turn.toml")).unwrap();
    fs::write(path.join("turn.toml"), job.replace("spp = 2", "spp = 3")).unwrap();
    fails(path, "batch turn.toml", 3, &["settings", "render.spp=2", "render.spp=3"]);
    fs::write(path.join("turn.toml"), job.replace("1-2", "1-3")).unwrap();
    fails(path, "batch turn.toml", 3, &["number of pictures was 2 and is 3"]);
}

#[test]
fn damaged_and_foreign_plans_are_refused() {
    let folder = folder(SMALL);
    let path = folder.path();
    done(path, "plan turn.toml");
    let plan = fs::read_to_string(path.join("turn.plan")).unwrap();
    let cases = [
        (plan[..plan.len() / 2].to_owned(), "no whole plan"),
        (String::new(), "no whole plan"),
        ("{}".to_owned(), "missing field"),
        (plan.replace("octray plan 2", "octray plan 9"), "octray plan 9"),
        (plan.replace("\"octray\": \"", "\"octray\": \"0.0.0-"), "was made by octray 0.0.0-"),
        (plan.replacen("\"units\": 1", "\"units\": 2", 1), "damaged"),
        (plan.replace("\"shards\": 1", "\"shards\": 0"), "damaged"),
        (plan.replace("\"spp\"", "\"ssp\""), "ssp"),
        (plan.replace("turn.0002.png", "../turn.png"), "damaged"),
        (plan.replace("turn.0002.png", "turn.octray/0002.png"), "damaged"),
        (plan.replace("        70,", "        70000000,"), "damaged"),
        (plan.replace("render.spp=40", "render.spp=41"), "its hash does not fit"),
        (plan.replace("frame 3", "frame 8"), "its hash does not fit"),
    ];
    for (text, words) in cases {
        fs::write(path.join("bad.plan"), text).unwrap();
        for verb in ["run", "merge", "status"] {
            fails(path, &format!("{verb} bad.plan"), 3, &["bad.plan", words]);
        }
    }
    fails(path, "run missing.plan", 3, &["missing.plan"]);
}

#[test]
fn damaged_and_foreign_records_are_refused() {
    let folder = folder(SMALL);
    let path = folder.path();
    done(path, "plan turn.toml");
    done(path, "run turn.plan");
    let record = state(path, "0000/0000001.json");
    let whole = fs::read_to_string(&record).unwrap();
    let other = fs::read_to_string(state(path, "0000/0000002.json")).unwrap();
    let foreign = whole.replacen("\"plan\": \"", "\"plan\": \"0", 1);
    let counted = whole.replace("\"nan_samples\": 0", "\"nan_samples\": 7");
    let cases = [
        (&whole[..20], "no whole record"),
        (&other, "unit 2, not 1"),
        (&foreign, "another plan"),
        (&counted, "its hash does not fit"),
    ];
    for (text, word) in cases {
        fs::write(&record, text).unwrap();
        for verb in ["run", "merge", "status"] {
            fails(path, &format!("{verb} turn.plan"), 3, &["0000001.json", word]);
        }
    }
    done(path, "run turn.plan --force");
    fs::write(state(path, "plan.json"), "{").unwrap();
    fails(path, "run turn.plan", 3, &["plan.json", "no whole plan"]);
}

/// One damaged file is not found after the other: all of them are named, and of many the first ten and how many more.
#[test]
fn all_damaged_and_changed_files_are_named() {
    let job = SMALL.replace("spp = 40", "spp = 1").replace("1-4", "1-13");
    let folder = folder(&job);
    let path = folder.path();
    done(path, "plan turn.toml");
    done(path, "run turn.plan");
    let record = |unit: usize| state(path, &format!("0000/{unit:07}.json"));
    let cut = |file: PathBuf| fs::write(&file, &fs::read(&file).unwrap()[..20]).unwrap();
    cut(record(3));
    cut(path.join("turn.0007.png"));
    for verb in ["run", "merge", "status"] {
        let said =
            fails(path, &format!("{verb} turn.plan"), 3, &["0000003.json", "turn.0007.png", "20 bytes"]);
        assert!(!said.contains("more"), "{said}");
    }
    (0..13).filter(|&unit| unit != 3).for_each(|unit| cut(record(unit)));
    let said = fails(path, "run turn.plan", 3, &["0000000.json", "0000009.json", "and 3 more"]);
    assert!(!said.contains("0000010.json"), "{said}");
    done(path, "run turn.plan --force");
    for frame in [2, 5] {
        let file = path.join(format!("turn.{frame:04}.png"));
        let mut bytes = fs::read(&file).unwrap();
        bytes[50] ^= 1;
        fs::write(file, bytes).unwrap();
    }
    fails(path, "merge turn.plan", 3, &["turn.0002.png: is not what", "turn.0005.png: is not what"]);
}

#[test]
fn all_changed_assets_are_named_up_to_ten() {
    let folder = with_mesh();
    let path = folder.path();
    for mesh in 0..12 {
        fs::write(path.join(format!("{mesh:02}.obj")), MESH).unwrap();
        append(&path.join("scene.toml"), &format!("[[mesh]]\npath = \"{mesh:02}.obj\"\n"));
    }
    done(path, "plan turn.toml");
    (0..12).for_each(|mesh| fs::write(path.join(format!("{mesh:02}.obj")), &MESH[..40]).unwrap());
    fs::remove_file(path.join("scene.toml")).unwrap();
    let words = ["scene.toml", "00.obj has changed", "09.obj has changed", "and 2 more"];
    let said = fails(path, "run turn.plan", 3, &words);
    assert!(!said.contains("10.obj"), "{said}");
}

#[test]
fn pictures_and_sums_that_are_not_what_was_written_are_found() {
    let folder = folder(SMALL);
    let path = folder.path();
    for split in ["frames", "samples"] {
        done(path, &format!("plan turn.toml --split {split}"));
        done(path, "run turn.plan --force");
        let file =
            if split == "frames" { path.join("turn.0002.png") } else { state(path, "0000/0000001.sums") };
        let name = file.file_name().unwrap().to_str().unwrap();
        let whole = fs::read(&file).unwrap();
        fs::write(&file, &whole[..whole.len() / 2]).unwrap();
        fails(path, "merge turn.plan", 3, &[name, "bytes"]);
        let mut flipped = whole.clone();
        flipped[whole.len() / 2] ^= 1;
        fs::write(&file, flipped).unwrap();
        fails(path, "merge turn.plan", 3, &[name, "not what was written"]);
    }
}

/// What a crash of the machine may leave: files without their bytes are done again, others are named.
#[test]
fn finished_files_that_were_emptied_are_done_again_and_cut_ones_are_named() {
    let folder = folder(SMALL);
    let path = folder.path();
    for split in ["frames", "tiles"] {
        done(path, &format!("plan turn.toml --split {split}"));
        done(path, "run turn.plan --force");
        let file =
            if split == "frames" { path.join("a/turn.0002.exr") } else { state(path, "0000/0000001.sums") };
        let name = file.file_name().unwrap().to_str().unwrap();
        let whole = fs::read(&file).unwrap();
        fs::write(&file, "").unwrap();
        assert!(done(path, "status turn.plan").contains("3 of 4 units"));
        fails(path, "merge turn.plan", 3, &["--array=0", "1 of 4 units are missing"]);
        let said = done(path, "run turn.plan --log log.txt");
        assert!(said.contains("1 units done, 3 were done before"), "{said}");
        assert!(fs::read(&file).unwrap() == whole);
        let log = fs::read_to_string(path.join("log.txt")).unwrap();
        assert!(log.contains(name) && log.contains("emptied"), "{log}");
        fs::write(&file, &whole[..whole.len() / 2]).unwrap();
        fails(path, "run turn.plan", 3, &[name, "bytes", "delete it"]);
        fs::remove_file(&file).unwrap();
        done(path, "run turn.plan");
        assert!(fs::read(&file).unwrap() == whole);
    }
}

#[test]
fn damaged_checkpoints_are_refused_and_the_rest_goes_on() {
    let folder = folder(SMALL);
    let path = folder.path();
    done(path, "plan turn.toml");
    fs::create_dir_all(state(path, "0000")).unwrap();
    let checkpoint = state(path, "0000/0000001.checkpoint");
    for text in ["", "octray part 1\n{}\n", "something else"] {
        fs::write(&checkpoint, text).unwrap();
        fails(path, "run turn.plan", 1, &["0000001.checkpoint", "frame 2", "1 of 4 units failed"]);
        assert!(path.join("turn.0004.png").exists());
    }
    fs::remove_file(checkpoint).unwrap();
    done(path, "run turn.plan");
}

#[test]
fn pictures_of_another_job_are_not_replaced() {
    let folder = folder(SMALL);
    let path = folder.path();
    done(path, "batch turn.toml -o out");
    let before = super::pictures(&path.join("out"));
    let job = fs::read_to_string(path.join("turn.toml")).unwrap();
    fs::write(path.join("other.toml"), job.replace("spp = 40", "spp = 4")).unwrap();
    fails(path, "batch other.toml -o out", 3, &["turn.0001", "another job", "turn.octray", "--force"]);
    super::assert_same(&super::pictures(&path.join("out")), &before);
    done(path, "batch turn.toml -o out");
    let cameras = "[[output]]\npath = \"a/turn.####.png\"\ncamera_json = true\n";
    fs::write(path.join("cameras.toml"), format!("scene = \"seed\"\nframes = \"1-4\"\n{cameras}")).unwrap();
    fails(path, "batch cameras.toml -o out", 3, &["turn.0001.camera.json belongs to another job"]);
    fs::write(path.join("third.toml"), job.replace("turn.####", "{name}.####")).unwrap();
    done(path, "batch third.toml -o out");
    done(path, "batch other.toml -o out --force");
    assert!(super::pictures(&path.join("out"))["turn.0001.png"] != before["turn.0001.png"]);
}
