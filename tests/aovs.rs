//! Values beside colour as a user gets them: in the channels of an EXR file, with the camera's numbers beside it.

use std::path::Path;
use std::process::Output;

use assert_cmd::Command;
use octray::film::{Aov, Film, PlaneValues};
use octray::output::{Picture, read_file};
use tempfile::TempDir;

const SCENE: &str = r#"
[camera]
position = [0, 0, -10]
look_at = [0, 0, 0]
fov_deg = 40
[render]
size = [33, 17]
spp = 4
[[light.point]]
position = [-4, 5, -8]
intensity = 200
[[material]]
name = "grey"
kd = 0.5
[[material]]
name = "red"
kd = [0.8, 0.1, 0.2]
[[sphere]]
center = [0, 0, 0]
radius = 1
material = "red"
[[quad]]
origin = [-20, -20, 5]
edge_u = [0, 40, 0]
edge_v = [20, 0, 0]
material = "grey"
[[plane]]
point = [0, -30, 0]
normal = [0, 1, 0]
[[group]]
name = "ball"
[[group.sphere]]
center = [0, 0, 0]
radius = 1
material = "red"
[[instance]]
of = "ball"
transform = [{ translate = [3, 0, 0] }]
[[instance]]
of = "ball"
transform = [{ translate = [3, 2, 0] }]
"#;

fn octray(folder: &Path, args: &[&str]) -> Output {
    Command::cargo_bin("octray").unwrap().current_dir(folder).args(args).output().unwrap()
}

fn rendered(folder: &Path, args: &[&str]) -> Film {
    std::fs::write(folder.join("scene.toml"), SCENE).unwrap();
    let output = octray(folder, &[&["render", "scene.toml", "-o", "a.exr"][..], args].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    match read_file(&folder.join("a.exr")).unwrap() {
        Picture::Light(film) => film,
        Picture::Display(_) => unreachable!("EXR holds light"),
    }
}

fn all() -> String {
    Aov::NAMES.join(",")
}

fn float(film: &Film, name: &str, [x, y]: [usize; 2]) -> f32 {
    match film.plane(name) {
        Some(PlaneValues::Float(values)) => values[y * film.width as usize + x],
        other => panic!("{name}: {other:?}"),
    }
}

fn uint(film: &Film, name: &str, [x, y]: [usize; 2]) -> u32 {
    match film.plane(name) {
        Some(PlaneValues::Uint(values)) => values[y * film.width as usize + x],
        other => panic!("{name}: {other:?}"),
    }
}

fn vector(film: &Film, layer: &str, components: &str, at: [usize; 2]) -> Vec<f32> {
    components.chars().map(|c| float(film, &format!("{layer}.{c}"), at)).collect()
}

fn camera(folder: &Path) -> serde_json::Value {
    serde_json::from_slice(&std::fs::read(folder.join("a.camera.json")).unwrap()).unwrap()
}

/// Where the camera's file says a point of the world is seen, and its depth.
fn projected(camera: &serde_json::Value, point: &[f32]) -> [f64; 3] {
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let along = |row: usize| {
        let row = &camera["world_to_camera"][row];
        (0..3).map(|k| number(&row[k]) * f64::from(point[k])).sum::<f64>() + number(&row[3])
    };
    let (x, y, z) = (along(0), along(1), along(2));
    let [fx, fy, cx, cy] = ["fx", "fy", "cx", "cy"].map(|key| number(&camera[key]));
    [fx * x / z + cx, fy * y / z + cy, z]
}

#[test]
fn every_value_is_that_of_the_surface_at_the_pixels_centre() {
    let folder = TempDir::new().unwrap();
    let film = rendered(folder.path(), &["--aovs", &all()]);
    let middle = [16, 8];
    assert_eq!(float(&film, "depth.Z", middle), 9.0);
    assert_eq!(vector(&film, "P", "XYZ", middle), [0.0, 0.0, -1.0]);
    assert_eq!(vector(&film, "N", "XYZ", middle), [0.0, 0.0, -1.0]);
    assert_eq!(vector(&film, "Ng", "XYZ", middle), [0.0, 0.0, -1.0]);
    assert_eq!((uint(&film, "id.object", middle), uint(&film, "id.material", middle)), (1, 2));
    assert_eq!((uint(&film, "mask.hit", middle), uint(&film, "samples.count", middle)), (1, 4));
    assert_ne!(uint(&film, "id.primitive", middle), 0);
    let red = vector(&film, "albedo", "RGB", middle);
    assert!(red[0] > 4.0 * red[1], "{red:?}");
}

#[test]
fn misses_are_infinitely_far_and_nothing_else() {
    let folder = TempDir::new().unwrap();
    let film = rendered(folder.path(), &["--aovs", &all()]);
    let sky = [0, 0];
    assert_eq!(float(&film, "depth.Z", sky), f32::INFINITY);
    for name in film.planes.iter().map(|plane| &plane.name).filter(|name| *name != "depth.Z") {
        match film.plane(name).unwrap() {
            PlaneValues::Float(_) => assert_eq!(float(&film, name, sky), 0.0, "{name}"),
            PlaneValues::Uint(_) if name == "samples.count" => {}
            PlaneValues::Uint(_) => assert_eq!(uint(&film, name, sky), 0, "{name}"),
        }
    }
}

#[test]
fn objects_count_by_kind_and_instances_are_their_own() {
    let folder = TempDir::new().unwrap();
    let film = rendered(folder.path(), &["--aovs", "object_id,hit"]);
    let Some(PlaneValues::Uint(ids)) = film.plane("id.object") else { panic!("no ids") };
    let seen: std::collections::BTreeSet<u32> = ids.iter().copied().collect();
    // A sphere, a quad, a plane, no mesh, two instances.
    assert_eq!(seen.into_iter().collect::<Vec<_>>(), [0, 1, 2, 3, 4, 5]);
}

#[test]
fn depth_and_position_agree_with_the_camera_file() {
    let folder = TempDir::new().unwrap();
    let moved = ["--set", "camera.position=[2, 3, -9]", "--aovs", "depth,position,hit"];
    for lens in [&[][..], &["--set", "camera.aperture_radius=0.5"][..]] {
        let film = rendered(folder.path(), &[&moved[..], lens].concat());
        let camera = camera(folder.path());
        for y in 0..film.height as usize {
            for x in (0..film.width as usize).filter(|&x| uint(&film, "mask.hit", [x, y]) == 1) {
                let [px, py, depth] = projected(&camera, &vector(&film, "P", "XYZ", [x, y]));
                let expected = [x as f64 + 0.5, y as f64 + 0.5, f64::from(float(&film, "depth.Z", [x, y]))];
                for (found, expected) in [px, py, depth].into_iter().zip(expected) {
                    assert!((found - expected).abs() < 1e-4 * expected.abs().max(1.0), "{found} {expected}");
                }
            }
        }
    }
}

#[test]
fn colour_is_the_same_with_and_without() {
    let folder = TempDir::new().unwrap();
    let plain = rendered(folder.path(), &[]);
    assert!(plain.planes.is_empty());
    assert!(!folder.path().join("a.camera.json").exists());
    assert_eq!(rendered(folder.path(), &["--aovs", &all()]).pixels, plain.pixels);
}

#[test]
fn a_crop_holds_the_values_of_the_whole() {
    let folder = TempDir::new().unwrap();
    let whole = rendered(folder.path(), &["--aovs", &all()]);
    let crop = rendered(folder.path(), &["--aovs", &all(), "--crop", "10,5,12,7", "--threads", "1"]);
    for plane in &crop.planes {
        for (x, y) in (0..12).flat_map(|x| (0..7).map(move |y| (x, y))) {
            let (inner, outer) = ([x, y], [x + 10, y + 5]);
            match plane.values {
                PlaneValues::Float(_) => {
                    assert_eq!(float(&crop, &plane.name, inner), float(&whole, &plane.name, outer));
                }
                PlaneValues::Uint(_) => {
                    assert_eq!(uint(&crop, &plane.name, inner), uint(&whole, &plane.name, outer));
                }
            }
        }
    }
}

#[test]
fn formats_without_room_for_values_are_refused_before_rendering() {
    let folder = TempDir::new().unwrap();
    let output = octray(folder.path(), &["render", "-o", "a.png", "--aovs", "depth"]);
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{told}");
    assert!(told.contains("a.png") && told.contains("depth") && told.contains("exr"), "{told}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    let output = octray(folder.path(), &["render", "-o", "a.exr", "--aovs", "normal"]);
    assert_eq!(output.status.code(), Some(2));
}

/// With a goal pixels differ in their samples: the plane holds those of each, which are all that were taken.
#[test]
fn sample_counts_are_those_of_each_pixel() {
    let folder = TempDir::new().unwrap();
    let film =
        rendered(folder.path(), &["--aovs", "sample_count,depth", "--max-error", "0.01", "--spp", "64"]);
    let Some(PlaneValues::Uint(counts)) = film.plane("samples.count") else { panic!("no counts") };
    assert!(counts.iter().all(|count| (16..=64).contains(count)));
    assert!(counts.iter().any(|&count| count < 64) && counts.iter().any(|count| count != &counts[0]));
    let plain = rendered(folder.path(), &["--aovs", "sample_count,depth"]);
    assert_eq!(plain.plane("samples.count"), Some(&PlaneValues::Uint(vec![4; counts.len()])));
    assert_eq!(plain.plane("depth.Z"), film.plane("depth.Z"));
}
