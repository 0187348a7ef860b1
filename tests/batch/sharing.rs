//! One process, many pictures: what they share is made once, and memory does not grow with their number.

use super::{assert_same, done, folder, pictures};

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

/// Peak memory of a batch whose pictures all have meshes of their own.
fn peak_bytes(count: u32, max_memory: &str) -> u64 {
    let job = format!(
        "scene = \"scene.toml\"\nsize = [16, 12]\nspp = 1\n[sweep]\n\"mesh.0.procedural.seed\" = {{ range = [0, {count}] }}\n\
        [[output]]\npath = \"{{sweep}}.png\"\n"
    );
    let folder = folder(&job);
    std::fs::write(folder.path().join("scene.toml"), SCENE.replace("3000", "20000")).unwrap();
    let said = done(
        folder.path(),
        &format!("batch turn.toml --threads 1 --progress json --max-memory {max_memory}"),
    );
    let last: serde_json::Value = serde_json::from_str(said.lines().last().unwrap()).unwrap();
    last["peak_memory_bytes"].as_u64().expect("this system tells")
}

#[cfg(target_os = "linux")]
#[test]
fn memory_stays_within_its_bound_however_many_pictures_there_are() {
    let (few, many, unbounded) = (peak_bytes(5, "4M"), peak_bytes(60, "4M"), peak_bytes(60, "4G"));
    assert!(many < few + (8 << 20), "{few} bytes for 5 scenes, {many} for 60");
    assert!(unbounded > many + (40 << 20), "{many} bytes with a bound, {unbounded} without");
}
