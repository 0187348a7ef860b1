//! However the work is cut, the bytes are those of one run.

use std::path::Path;

use super::{SMALL, assert_same, command, done, fails, folder, pictures, undisturbed};

/// Runs all shards of a plan, the last one first.
fn run_all(folder: &Path, plan: &str, shards: u32, output: &str) {
    for shard in (0..shards).rev() {
        done(folder, &format!("run {plan} --shard {shard}/{shards} -o {output}"));
    }
}

#[test]
fn one_three_and_sixteen_shards_by_frames_tiles_and_samples_give_the_same_bytes() {
    let expected = undisturbed(SMALL);
    assert_eq!(expected.len(), 12, "four pictures, each EXR, PNG and camera");
    let folder = folder(SMALL);
    for split in ["frames", "tiles", "samples"] {
        for shards in [1, 3, 16] {
            let (plan, output) = (format!("{split}{shards}.plan"), format!("{split}{shards}"));
            done(folder.path(), &format!("plan turn.toml --split {split} --shards {shards} -o {plan}"));
            run_all(folder.path(), &plan, shards, &output);
            done(folder.path(), &format!("merge {plan} -o {output}"));
            assert_same(&pictures(&folder.path().join(output)), &expected);
        }
    }
}

#[test]
fn batches_of_every_split_and_number_of_threads_are_pictures_of_render() {
    let folder = folder(SMALL);
    done(folder.path(), "render seed --size 70x40 --spp 40 --set camera.fov_deg=40.0 -o one.png");
    let expected = std::fs::read(folder.path().join("one.png")).unwrap();
    for (split, threads) in [("frames", 1), ("frames", 4), ("tiles", 2), ("samples", 3)] {
        let output = format!("{split}{threads}");
        done(folder.path(), &format!("batch turn.toml --split {split} --threads {threads} -o {output}"));
        let found = std::fs::read(folder.path().join(output).join("turn.0002.png")).unwrap();
        assert!(found == expected, "{split}, {threads} threads");
    }
}

#[test]
fn a_thread_that_took_first_samples_may_take_later_ones() {
    let job = SMALL.replace("spp = 40", "spp = 20");
    let folder = folder(&job);
    done(folder.path(), "plan turn.toml --split samples --shards 3");
    for shard in 0..3 {
        done(folder.path(), &format!("run turn.plan --shard {shard}/3 -o out --threads 1"));
    }
    done(folder.path(), "merge turn.plan -o out");
    assert_same(&pictures(&folder.path().join("out")), &undisturbed(&job));
}

#[test]
fn two_runners_on_one_shard_do_no_harm() {
    let expected = undisturbed(SMALL);
    let folder = folder(SMALL);
    for split in ["frames", "tiles"] {
        done(folder.path(), &format!("plan turn.toml --split {split} -o {split}.plan"));
        let run = format!("run {split}.plan --shard 0/1 -o {split} --checkpoint-every 0");
        let both = [0, 1].map(|_| command(folder.path(), &run).spawn().unwrap());
        for mut runner in both {
            assert!(runner.wait().unwrap().success());
        }
        done(folder.path(), &format!("merge {split}.plan -o {split}"));
        assert_same(&pictures(&folder.path().join(split)), &expected);
    }
}

#[test]
fn merging_says_which_shards_are_missing() {
    let folder = folder(SMALL);
    let path = folder.path();
    done(path, "plan turn.toml --split samples --shards 16");
    for shard in [0, 1, 2, 3, 5, 6, 10, 11, 12, 13, 14, 15] {
        done(path, &format!("run turn.plan --shard {shard}/16"));
    }
    // Four pictures of 40 samples are three units each.
    let said = fails(path, "merge turn.plan", 3, &["--array=4,7-9\n", "incomplete: 4 of 12"]);
    assert!(!said.contains("error: incomplete: 0"));
    assert!(!path.join("turn.0001.png").exists(), "nothing is written unless asked for");
    fails(path, "merge turn.plan --partial", 3, &["--array=4,7-9\n"]);
    assert!(path.join("turn.0001.png").exists() && path.join("turn.0002.png").exists());
    let status = done(path, "status turn.plan --json");
    let status: serde_json::Value = serde_json::from_str(&status).unwrap();
    assert_eq!((&status["units_done"], &status["shards_missing"]), (&8.into(), &vec![4, 7, 8, 9].into()));
}

#[test]
fn a_partial_merge_counts_the_samples_that_are_there() {
    let folder = folder(SMALL);
    done(folder.path(), "plan turn.toml --split samples --shards 3");
    done(folder.path(), "run turn.plan --shard 0/3");
    fails(folder.path(), "merge turn.plan --partial", 3, &["--array=1-2"]);
    let path = folder.path().join("a/turn.0001.exr");
    let octray::output::Picture::Light(film) = octray::output::read_file(&path).unwrap() else { panic!() };
    let counts = film.plane("samples.count").unwrap();
    assert_eq!(*counts, octray::film::PlaneValues::Uint(vec![16; 70 * 40]));
}

#[test]
fn the_index_comes_from_the_scheduler_and_the_number_from_the_plan() {
    let folder = folder(SMALL);
    let path = folder.path();
    done(path, "plan turn.toml --shards 4");
    for (args, words) in [
        ("run turn.plan --shard 0/5", ["4 shards", "not 5"]),
        ("run turn.plan --shard 4/4", ["no shard 4", "0 to 3"]),
        ("run turn.plan --shard auto", ["none of", "SLURM_ARRAY_TASK_ID"]),
        ("run turn.plan --shard two", ["expected i/n", "auto"]),
    ] {
        fails(path, args, 2, &words);
    }
    assert!(
        pictures(path).keys().all(|name| name.starts_with("turn.t") || name == "turn.plan"),
        "nothing rendered"
    );
    let mut slurm = command(path, "run turn.plan --shard auto");
    // What Slurm sets when only element 2 is resubmitted.
    slurm.env("SLURM_ARRAY_TASK_ID", "2").env("SLURM_ARRAY_TASK_COUNT", "1").env("SLURM_ARRAY_TASK_MIN", "2");
    assert!(slurm.status().unwrap().success());
    let frames: Vec<String> = pictures(path).into_keys().filter(|name| name.ends_with(".png")).collect();
    assert_eq!(frames, ["turn.0003.png"]);
    slurm.env("OCTRAY_SHARD", "1");
    let output = slurm.output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(super::told(&output).contains("disagrees"));
}
