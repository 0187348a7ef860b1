//! One process, many pictures: what they share is made once, and memory does not grow with their number.

use super::{assert_same, command, done, folder, pictures, told};

/// Something that moves, by its own transform and by that of an instance.
const MOVING: &str = r#"
scene = "scene.toml"
size = [48, 36]
spp = 4
frames = "1-6"
[[keyframes]]
key = "mesh.0.transform.0.rotate_deg.angle"
frames = [1, 6]
values = [0, 100]
[[keyframes]]
key = "instance.0.transform.0.translate"
frames = [1, 6]
values = [[0, 1, 0], [0.5, 2, 0]]
[[output]]
path = "a.#.exr"
aovs = ["depth", "object_id", "primitive_id"]
"#;

const SCENE: &str = r#"
[camera]
position = [0, 3, 5]
look_at = [0, 0.5, 0]
[[light.point]]
position = [4, 5, 3]
intensity = 60
[[mesh]]
procedural = { kind = "terrain", triangles = 3000 }
transform = [{ rotate_deg = { axis = [0, 1, 0], angle = 0 } }]
[[group]]
name = "ball"
[[group.sphere]]
center = [0, 0, 0]
radius = 0.4
[[instance]]
of = "ball"
transform = [{ translate = [0, 1, 0] }]
"#;

fn moving(more: &str) -> tempfile::TempDir {
    let folder = folder(&format!("{more}{MOVING}"));
    std::fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    folder
}

#[test]
fn trees_that_only_move_are_moved_and_pictures_are_those_of_new_ones() {
    for tier in ["watertight", "exact"] {
        let folder = moving(&format!("tier = \"{tier}\"\n"));
        let path = folder.path();
        done(path, "batch turn.toml -o out --log log.txt --threads 1");
        let log = std::fs::read_to_string(path.join("log.txt")).unwrap();
        let compiled =
            |moved: &str| log.lines().filter(|l| l.contains("scene compiled") && l.contains(moved)).count();
        assert_eq!((compiled("moved=false"), compiled("moved=true")), (1, 5), "{log}");
        done(path, "plan turn.toml --shards 6");
        for shard in 0..6 {
            // A process for each picture: every tree is a new one.
            done(path, &format!("run turn.plan --shard {shard}/6 -o single"));
        }
        assert_same(&pictures(&path.join("out")), &pictures(&path.join("single")));
    }
}

#[test]
fn the_fast_tier_has_a_new_tree_for_every_picture() {
    let folder = moving("tier = \"fast\"\n");
    done(folder.path(), "batch turn.toml -o out --threads 1");
    done(folder.path(), "plan turn.toml --shards 6");
    (0..6).for_each(|shard| drop(done(folder.path(), &format!("run turn.plan --shard {shard}/6 -o single"))));
    assert_same(&pictures(&folder.path().join("out")), &pictures(&folder.path().join("single")));
}

#[test]
fn cameras_and_seeds_share_one_scene() {
    let job = "scene = \"terrain:2000\"\nsize = [16, 12]\nspp = 1\n[sweep]\n\"render.seed\" = { range = [0, 5] }\n\
        \"camera.fov_deg\" = { linspace = [30, 60, 4] }\n[[output]]\npath = \"{sweep}.png\"\n";
    let folder = folder(job);
    done(folder.path(), "batch turn.toml -o out --log log.txt");
    let log = std::fs::read_to_string(folder.path().join("log.txt")).unwrap();
    assert_eq!(log.lines().filter(|line| line.contains("scene compiled")).count(), 1, "{log}");
    assert_eq!(pictures(&folder.path().join("out")).len(), 20);
}

/// A mesh without a scene is framed before it is rendered: by what was loaded already.
#[test]
fn a_bare_mesh_is_loaded_once_for_plan_and_pictures() {
    let job =
        "scene = \"tent.obj\"\nsize = [8, 6]\nspp = 1\nframes = \"1-3\"\n[[output]]\npath = \"a.#.png\"\n";
    let folder = super::folder(job);
    let path = folder.path();
    std::fs::write(path.join("tent.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\n").unwrap();
    let loads = |args: &str| {
        let _ = std::fs::remove_file(path.join("log.txt"));
        done(path, &format!("{args} --log log.txt"));
        std::fs::read_to_string(path.join("log.txt")).unwrap().matches("mesh loaded").count()
    };
    assert_eq!(loads("batch turn.toml -o a"), 1);
    assert_eq!(loads("batch ./turn.toml -o b"), 1, "a folder is the same however it is spelled");
    done(path, "plan turn.toml");
    assert_eq!(loads("run turn.plan -o c"), 1);
    let bytes = |file: &str| std::fs::read(path.join(file)).unwrap();
    done(path, "render tent.obj --size 8x6 --spp 1 -o one.png");
    assert!(["a/a.1.png", "b/a.2.png", "c/a.3.png"].iter().all(|file| bytes(file) == bytes("one.png")));
}

/// Peak memory of a batch.
fn peak_bytes(folder: &std::path::Path, options: &str) -> u64 {
    peak_of(&mut command(folder, &format!("batch turn.toml -o out --force --progress json {options}")))
}

fn peak_of(batch: &mut std::process::Command) -> u64 {
    let output = batch.output().unwrap();
    let said = told(&output);
    assert!(output.status.success(), "{said}");
    let last: serde_json::Value = serde_json::from_str(said.lines().last().unwrap()).unwrap();
    last["peak_memory_bytes"].as_u64().expect("this system tells")
}

/// Peak memory of a batch that shows so many scenes, each from two sides: the second one asks for the scenes of the first.
fn peak_of_scenes(count: u32, max_memory: &str) -> u64 {
    let job = format!(
        "scene = \"scene.toml\"\nsize = [16, 12]\nspp = 1\nframes = \"1-{count}\"\n\
        [[keyframes]]\nkey = \"mesh.0.transform.0.rotate_deg.angle\"\nframes = [1, 360]\nvalues = [1, 360]\n\
        [[camera]]\nname = \"a\"\n[[camera]]\nname = \"b\"\nset = {{ fov_deg = 60 }}\n\
        [[output]]\npath = \"{{camera}}.####.png\"\n"
    );
    let folder = folder(&job);
    std::fs::write(folder.path().join("scene.toml"), SCENE.replace("3000", "20000")).unwrap();
    peak_bytes(folder.path(), &format!("--threads 1 --max-memory {max_memory}"))
}

#[cfg(target_os = "linux")]
#[test]
fn memory_stays_within_its_bound_however_many_scenes_there_are() {
    let [few, many] = [5, 60].map(|count| peak_of_scenes(count, "4M"));
    let unbounded = peak_of_scenes(60, "4G");
    assert!(many < few + (8 << 20), "{few} bytes for 5 scenes, {many} for 60");
    assert!(unbounded > many + (40 << 20), "{many} bytes with a bound, {unbounded} without");
}

/// Nobody asks again for the scene of a frame that is done, so it is not kept, whatever there is room for.
#[cfg(target_os = "linux")]
#[test]
fn scenes_that_are_shown_once_take_no_memory_afterwards() {
    let peak = |frames: u32| {
        let moving = MOVING.replace("1-6", &format!("1-{frames}")).replace("[1, 6]", "[1, 360]");
        let folder = folder(&moving.replace("[48, 36]", "[16, 12]"));
        std::fs::write(folder.path().join("scene.toml"), SCENE.replace("3000", "20000")).unwrap();
        peak_bytes(folder.path(), "--threads 1")
    };
    let (few, many) = (peak(10), peak(150));
    assert!(many < few + (8 << 20), "{few} bytes for 10 scenes, {many} for 150");
}

/// The tolerance is what the plan's 490 pictures more and the allocator's moods may take.
#[cfg(target_os = "linux")]
#[test]
fn memory_after_500_pictures_is_that_after_10() {
    let peak = |pictures: u32| {
        let job = format!(
            "scene = \"seed\"\nsize = [32, 24]\nspp = 1\nframes = \"1-{pictures}\"\n[[output]]\npath = \"a.#.exr\"\n\
            aovs = [\"depth\", \"object_id\"]\n"
        );
        peak_bytes(folder(&job).path(), "--threads 2")
    };
    let (few, many) = (peak(10), peak(500));
    assert!(many < few + (4 << 20), "{few} bytes for 10 pictures, {many} for 500");
}

/// Pictures with much beside colour, some 20 MB each while they are worked at.
#[cfg(target_os = "linux")]
#[test]
fn only_so_many_pictures_are_worked_at_as_memory_allows() {
    let job = "scene = \"seed\"\nsize = [256, 256]\nspp = 1\nframes = \"1-24\"\n[[output]]\npath = \"a.#.exr\"\naovs = [\"depth\", \
        \"position\", \"geometric_normal\", \"shading_normal\", \"uv\", \"object_id\", \"primitive_id\", \"albedo\"]\n";
    let folder = folder(job);
    let peak = |max: &str| {
        let batch = format!("batch turn.toml -o out --force --progress json --threads 8 --max-memory {max}");
        // The C library else keeps what each thread has given back.
        peak_of(command(folder.path(), &batch).env("MALLOC_ARENA_MAX", "1"))
    };
    let [least, bounded, free] = ["1M", "60M", "4G"].map(peak);
    assert!(least < 80 << 20 && bounded < 110 << 20, "{least} bytes for one at a time, {bounded} for 60M");
    assert!(free > bounded + (40 << 20), "{bounded} bytes with a bound, {free} without");
}
