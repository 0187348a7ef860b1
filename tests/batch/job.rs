//! The job file and the plan.

use super::{SMALL, done, fails, folder, pictures};

#[test]
fn bad_jobs_name_the_file_the_line_and_what_was_expected() {
    let output = "[[output]]\npath = \"a.png\"\n";
    for (job, words) in [
        ("scene = \"seed\"\nspp = \"many\"\n", &["turn.toml:2", "a whole number"][..]),
        ("scene = \"seed\"\nssp = 3\n", &["turn.toml:2", "ssp", "spp"]),
        ("scene = \"sed\"\n", &["`sed`"]),
        ("scene = \"none.toml\"\n", &["none.toml"]),
        ("scene = \"seed\"\nframes = \"5-1\"\n", &["frames", "5-1", "backwards"]),
        ("scene = \"seed\"\n[set]\n\"camera.fov\" = 3\n", &["camera.fov=3", "fov_deg"]),
        ("scene = \"seed\"\n[sweep]\n\"render.spp\" = { list = [1, 2] }\n", &["a.png", "{key}"]),
        ("scene = \"seed\"\n[sweep]\n\"render.spp\" = { list = [0] }\n", &["render.spp = 0", "spp"]),
        ("scene = \"seed\"\n[sweep]\n\"render.spp\" = { lst = [1] }\n", &["turn.toml:3", "lst", "linspace"]),
        (
            "scene = \"seed\"\n[[keyframes]]\nkey = \"render.spp\"\nframes = [1]\nvalues = [1]\n",
            &["need `frames`"],
        ),
    ] {
        let folder = folder(&format!("{job}{output}"));
        fails(folder.path(), "plan turn.toml", 3, words);
        assert!(!folder.path().join("turn.plan").exists());
    }
    let keyframes = "[[keyframes]]\nkey = \"camera.fov_deg\"\nframes = [1]\nvalues = [40]\n";
    let sweep = "[sweep]\n\"camera.fov_deg\" = { list = [30, 40] }\n";
    for (job, words) in [
        (format!("{keyframes}{keyframes}"), "`camera.fov_deg` has keyframes twice"),
        (format!("{keyframes}{sweep}"), "is swept and has keyframes"),
        (
            "[[output]]\npath = \"b/a.0001.png/c.exr\"\n[[output]]\npath = \"b/a.png\"\n".into(),
            "the folder of",
        ),
        ("[[output]]\npath = \"a\\u0000.png\"\n".into(), "a\\0.0001.png"),
    ] {
        let folder = folder(&format!("scene = \"seed\"\nframes = \"1\"\n{job}{output}"));
        fails(folder.path(), "plan turn.toml", 3, &[words]);
    }
    for (path, aovs, words) in [
        ("../a.png", "", "below the output folder"),
        ("/a.png", "", "below the output folder"),
        ("turn.octray/a.png", "", "state of batches"),
        ("b/Other.OCTRAY/c/a.png", "", "must not lie in `Other.OCTRAY`"),
        ("a.jpg", "", "exr"),
        ("a.png", "aovs = [\"depth\"]\n", "exr"),
        ("{cam}.png", "", "{name}"),
    ] {
        let folder = folder(&format!("scene = \"seed\"\n[[output]]\npath = \"{path}\"\n{aovs}"));
        fails(folder.path(), "plan turn.toml", 3, &[path, words]);
    }
}

/// Files of the wrong kind and folders of other work: it is said what would be right.
#[test]
fn wrong_files_and_folders_are_known_for_what_they_are() {
    let folder = folder(SMALL);
    let path = folder.path();
    std::fs::write(path.join("scene.toml"), done(path, "scenes --write seed")).unwrap();
    for verb in ["batch", "plan"] {
        fails(path, &format!("{verb} scene.toml"), 3, &["scene.toml:", "scene = \"scene.toml\""]);
    }
    fails(path, "render turn.toml", 3, &["turn.toml:", "octray batch"]);
    for verb in ["run", "merge", "status"] {
        fails(path, &format!("{verb} turn.toml"), 3, &["turn.toml: is a job", "octray plan"]);
    }
    done(path, "plan turn.toml");
    done(path, "run turn.plan -o out");
    fails(path, "merge turn.plan", 3, &["4 of 4 units are missing", "-o is the folder"]);
    assert!(done(path, "status turn.plan").contains("-o is the folder"));
    assert!(!done(path, "status turn.plan -o out").contains("-o is"));
}

/// However it is spelled.
#[test]
fn two_outputs_are_not_one_file() {
    let job = "scene = \"seed\"\n[[output]]\npath = \"a/b.png\"\n[[output]]\npath = \"./a//b.png\"\n";
    let folder = folder(job);
    fails(folder.path(), "plan turn.toml", 3, &["two [[output]] of the job are the same file `a/b.png`"]);
}

/// Where capitals are not told from small letters, the second would replace the first.
#[test]
fn two_outputs_differ_in_more_than_capital_letters() {
    let output = |path: &str| format!("[[output]]\npath = \"{path}\"\n");
    for (paths, words) in [
        (["a/B.png", "A/b.png"], ["`a/B.png` of the picture", "`A/b.png`", "capital letters"]),
        (["\u{c4}.png", "\u{e4}.png"], ["`\u{c4}.png`", "`\u{e4}.png`", "one file"]),
        (["A.png", "a.png/b.png"], ["`A.png` would be a file", "the folder of", "`a.png/b.png`"]),
    ] {
        let job = paths.map(output).concat();
        let folder = folder(&format!("scene = \"seed\"\n{job}"));
        fails(folder.path(), "plan turn.toml", 3, &words);
    }
}

#[test]
fn two_pictures_have_two_camera_files() {
    let cameras = "[[camera]]\nname = \"exr\"\n[[camera]]\nname = \"pfm\"\n";
    let folder = folder(&format!(
        "scene = \"seed\"\n{cameras}[[output]]\npath = \"a.{{camera}}\"\ncamera_json = true\n"
    ));
    fails(
        folder.path(),
        "plan turn.toml",
        3,
        &["`a.camera.json` would hold the cameras of both", "camera exr"],
    );
}

/// One key in two spellings would be set twice, and one of its values be for nothing.
#[test]
fn keys_have_one_spelling() {
    let output = "[[output]]\npath = \"{sweep}.#.png\"\n";
    let keyframes = "frames = \"1\"\n[[keyframes]]\nframes = [1]\nvalues = [40]\nkey = ";
    for (job, words) in [
        (
            "[sweep]\n\"camera.fov_deg\" = { list = [30, 40] }\n\" camera.fov_deg\" = { list = [50] }\n",
            ["turn.toml:4", "blanks in the key ` camera.fov_deg`"],
        ),
        ("[set]\n\"camera .fov_deg\" = 30\n", ["turn.toml:3", "expected `camera.fov_deg`"]),
        (&format!("{keyframes}\"camera.fov_deg \"\n"), ["turn.toml:6", "expected `camera.fov_deg`"]),
        (
            "[[camera]]\nname = \"a\"\nset = { \" fov_deg\" = 30, fov_deg = 40 }\n",
            ["turn.toml:4", "expected `fov_deg`"],
        ),
    ] {
        let folder = folder(&format!("scene = \"seed\"\n{job}{output}"));
        fails(folder.path(), "plan turn.toml", 3, &words);
    }
}

#[test]
fn jobs_beyond_all_bounds_are_refused_at_once() {
    let output = "[[output]]\npath = \"{sweep}.#.png\"\n";
    for job in [
        "frames = \"1-1000001\"\n",
        "frames = \"1-100000\"\n[sweep]\n\"render.seed\" = { range = [0, 100000] }\n",
        "frames = \"1-1000\"\n[[camera]]\nname = \"a\"\n[[camera]]\nname = \"b\"\n[sweep]\n\"render.seed\" = { range = [0, 501] }\n",
        "[sweep]\n\"render.seed\" = { range = [0, 1000] }\n\"render.spp\" = { range = [1, 1002] }\n",
    ] {
        let folder = folder(&format!("scene = \"seed\"\n{job}{output}"));
        fails(folder.path(), "plan turn.toml", 3, &["more than 1000000"]);
    }
    let folder = folder("scene = \"seed\"\n");
    std::fs::write(folder.path().join("turn.toml"), b"scene = \"seed\"\n# \xff\n").unwrap();
    fails(folder.path(), "plan turn.toml", 3, &["turn.toml:2", "UTF-8"]);
}

/// More samples than a number of 64 bits counts.
#[test]
fn the_cost_of_endless_work_is_still_a_number() {
    let folder = folder(
        "scene = \"seed\"\nsize = [16384, 16384]\nspp = 4294967295\nframes = \"1-100\"\n[[output]]\npath = \"a.#.png\"\n",
    );
    done(folder.path(), "plan turn.toml");
    let plan: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.path().join("turn.plan")).unwrap()).unwrap();
    assert_eq!(plan["cost"]["samples"].as_u64(), Some(u64::MAX));
}

#[test]
fn the_same_job_has_the_same_plan_bytes() {
    let folders = [folder(SMALL), folder(SMALL)];
    let plans = folders.each_ref().map(|folder| {
        done(folder.path(), "plan turn.toml --shards 3 --split tiles");
        std::fs::read(folder.path().join("turn.plan")).unwrap()
    });
    assert!(plans[0] == plans[1]);
    let plan: serde_json::Value = serde_json::from_slice(&plans[0]).unwrap();
    assert_eq!(plan["cost"]["samples"], 4 * 70 * 40 * 40);
}

#[test]
fn a_plan_elsewhere_finds_its_scene_and_can_be_moved_with_it() {
    let folder = folder("scene = \"../scenes/s.toml\"\nsize = [8, 6]\n[[output]]\npath = \"a.png\"\n");
    let path = folder.path();
    for made in ["p/jobs", "p/scenes", "p/plans"] {
        std::fs::create_dir_all(path.join(made)).unwrap();
    }
    std::fs::rename(path.join("turn.toml"), path.join("p/jobs/turn.toml")).unwrap();
    std::fs::write(path.join("p/scenes/s.toml"), "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n")
        .unwrap();
    done(path, "plan p/jobs/turn.toml -o p/plans/turn.plan");
    std::fs::rename(path.join("p"), path.join("q")).unwrap();
    done(path, "run q/plans/turn.plan -o out");
    assert!(path.join("out/a.png").exists());
}

#[test]
fn sweeps_cameras_and_frames_meet() {
    let job = r#"
        scene = "seed"
        size = [8, 6]
        spp = 1
        frames = "1,5..6"
        sweep_mode = "zip"
        [sweep]
        "material.glass.ior" = { list = [1.2, 1.4] }
        "render.seed" = { range = [0, 2] }
        [[camera]]
        name = "left"
        set = { position = [-4, 2, -8] }
        [[camera]]
        name = "right"
        [[output]]
        path = "{camera}/{material.glass.ior}-{sweep}.#.png"
        camera_json = true
    "#;
    let folder = folder(job);
    done(folder.path(), "batch turn.toml -o out");
    let found = pictures(&folder.path().join("out"));
    let pictures: Vec<&String> = found.keys().filter(|name| name.ends_with(".png")).collect();
    assert_eq!(pictures.len(), 2 * 2 * 3);
    assert!(found.contains_key("left/1.2-0000.5.png") && found.contains_key("right/1.4-0001.6.camera.json"));
    assert!(found["left/1.2-0000.1.png"] != found["right/1.2-0000.1.png"]);
    assert!(found["left/1.2-0000.1.png"] != found["left/1.4-0001.1.png"]);
    assert!(found["left/1.2-0000.1.png"] == found["left/1.2-0000.5.png"], "no frame is different here");
}

#[test]
fn keyframes_are_the_values_of_single_renders() {
    let job = "scene = \"seed\"\nsize = [20, 15]\nspp = 1\nframes = \"2-3\"\n[[keyframes]]\nkey = \"camera.position\"\n\
        frames = [1, 5]\nvalues = [[-2, 2, -8], [2, 2, -8]]\n[[output]]\npath = \"a.#.png\"\n";
    let folder = folder(job);
    done(folder.path(), "batch turn.toml");
    done(folder.path(), "render seed --size 20x15 --spp 1 --set camera.position=[-1.0,2.0,-8.0] -o one.png");
    let bytes = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert!(bytes("a.2.png") == bytes("one.png") && bytes("a.3.png") != bytes("one.png"));
}

/// Samples and sizes are counted: what lies between two of them is refused, not rounded.
#[test]
fn keys_that_count_are_keyframed_and_swept_in_whole_numbers() {
    let job = |key: &str, values: &str| {
        format!(
            "scene = \"seed\"\nsize = [8, 6]\nspp = 1\nframes = \"1-3\"\n[[keyframes]]\nkey = \"{key}\"\n\
             frames = [1, 3]\nvalues = {values}\n[[output]]\npath = \"{{sweep}}.#.png\"\n\
             [sweep]\n\"render.max_depth\" = {{ linspace = [1, 5, 3] }}\n\"render.seed\" = {{ range = [1.0, 3, 1] }}\n"
        )
    };
    for (key, values, field, expected) in [
        ("render.spp", "[1, 5]", "spp", "[1,3,5]"),
        ("render.spp", "[1.0, 5.0]", "spp", "[1,3,5]"),
        ("render.size", "[[8, 6], [16, 12]]", "size", "[[8,6],[12,9],[16,12]]"),
        ("camera.fov_deg", "[40, 50]", "spp", "[1,1,1]"),
    ] {
        let folder = folder(&job(key, values));
        done(folder.path(), "plan turn.toml");
        let plan = std::fs::read(folder.path().join("turn.plan")).unwrap();
        let plan: serde_json::Value = serde_json::from_slice(&plan).unwrap();
        let pictures = plan["pictures"].as_array().unwrap();
        assert_eq!(pictures.len(), 3 * 3 * 2);
        let found: Vec<_> = pictures[..3].iter().map(|picture| picture[field].clone()).collect();
        assert_eq!(serde_json::to_string(&found).unwrap(), expected, "{key}");
    }
    fails(
        folder(&job("render.spp", "[1, 2]")).path(),
        "plan turn.toml",
        3,
        &["frame 2", "1.5", "a whole number"],
    );
}
