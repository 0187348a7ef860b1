//! One seed for all pictures, or one for each.

use std::collections::HashSet;

use super::{assert_same, done, folder, pictures};

/// Six pictures of a scene that does not change, only the noise of its few samples may.
fn job(more: &str) -> String {
    format!(
        "scene = \"seed\"\nsize = [40, 30]\nspp = 2\nframes = \"1-3\"\n{more}\n[[camera]]\nname = \"a\"\n[[camera]]\n\
        name = \"b\"\n[[output]]\npath = \"{{camera}}.#.pfm\"\n"
    )
}

/// How many different pictures a job gives.
fn different(more: &str) -> usize {
    let folder = folder(&job(more));
    done(folder.path(), "batch turn.toml -o out");
    let found = pictures(&folder.path().join("out"));
    assert_eq!(found.len(), 6);
    found.into_values().collect::<HashSet<_>>().len()
}

#[test]
fn pictures_have_one_seed_unless_each_is_to_have_its_own() {
    assert_eq!(different(""), 1);
    assert_eq!(different("seed_mode = \"same\""), 1);
    assert_eq!(different("seed_mode = \"per_picture\""), 6);
}

#[test]
fn seeds_of_pictures_are_in_the_plan_and_a_single_render_has_the_same_bytes() {
    let folder = folder(&job("seed = 5\nseed_mode = \"per_picture\""));
    let path = folder.path();
    done(path, "batch turn.toml -o out");
    done(path, "plan turn.toml");
    let plan: serde_json::Value =
        serde_json::from_slice(&std::fs::read(path.join("turn.plan")).unwrap()).unwrap();
    let seeds = plan["pictures"].as_array().unwrap().iter().map(|picture| {
        let sets = picture["sets"].as_array().unwrap();
        sets.iter().find_map(|set| set.as_str().unwrap().strip_prefix("render.seed=")).unwrap().to_owned()
    });
    let seeds: Vec<String> = seeds.collect();
    assert_eq!(seeds.iter().collect::<HashSet<_>>().len(), 6);
    done(path, &format!("render seed --size 40x30 --spp 2 --seed {} -o one.pfm", seeds[4]));
    // All frames of camera a come first.
    assert!(std::fs::read(path.join("one.pfm")).unwrap() == std::fs::read(path.join("out/b.2.pfm")).unwrap());
}

#[test]
fn seeds_do_not_depend_on_how_the_work_is_cut() {
    let folder = folder(&job("seed_mode = \"per_picture\""));
    let path = folder.path();
    done(path, "batch turn.toml -o out --threads 1");
    for (split, shards) in [("frames", 4), ("tiles", 3), ("samples", 2)] {
        done(path, &format!("plan turn.toml --split {split} --shards {shards}"));
        (0..shards).rev().for_each(|shard| {
            drop(done(path, &format!("run turn.plan --shard {shard}/{shards} -o {split}")))
        });
        done(path, &format!("merge turn.plan -o {split}"));
        assert_same(&pictures(&path.join(split)), &pictures(&path.join("out")));
    }
}
