//! Well-known models, where their files are at hand: the right part of the picture is covered, nothing is black or NaN.

mod common;

use common::{film, parse, shared};
use octray::describe::SceneDescription;
use octray::film::Film;

const SIZE: &str = "[render]\nsize = [160, 120]\nspp = 4\nmax_depth = 2\n";

fn with_mesh(path: &str, rest: &str) -> Option<SceneDescription> {
    let file = shared(path)?;
    Some(parse(&format!("{SIZE}{rest}[[mesh]]\npath = '{}'\n", file.display())))
}

fn mean(film: &Film) -> f64 {
    let sum: f64 = film.pixels.iter().flatten().map(|&c| f64::from(c)).sum();
    sum / (3.0 * film.pixels.len() as f64)
}

/// The share of pixels that satisfy a condition.
fn share(film: &Film, condition: impl Fn(&[f32; 3]) -> bool) -> f64 {
    film.pixels.iter().filter(|p| condition(p)).count() as f64 / film.pixels.len() as f64
}

/// A background that no surface looks like.
const PINK: &str = "[background]\ncolor = [9, 0, 9]\nambient = [1, 1, 1]\n";

fn is_pink(p: &[f32; 3]) -> bool {
    p[0] > 8.9
}

#[test]
fn dragon() {
    let view = "
[camera]
position = [-0.08, 0.18, 0.32]
look_at = [-0.008, 0.122, 0]
fov_deg = 36
[[light.point]]
position = [-0.3, 0.5, 0.5]
intensity = 0.5
";
    let Some(scene) = with_mesh("dragon/dragon.ply", &format!("{PINK}{view}")) else { return };
    let film = film(&scene);
    let covered = 1.0 - share(&film, is_pink);
    assert!((0.15..0.6).contains(&covered), "{covered} of the picture is dragon");
    let lit = share(&film, |p| !is_pink(p) && p[0] > 0.3) / covered;
    assert!(lit > 0.3, "{lit} of the dragon is lit");
}

#[test]
fn sponza_from_inside() {
    let view = "
[camera]
position = [-11, 3.5, 0.3]
look_at = [0, 4.5, 0]
fov_deg = 70
[[light.point]]
position = [0, 8, 0]
intensity = 60
[[light.point]]
position = [-11, 3.6, 0.2]
intensity = 20
";
    let Some(scene) = with_mesh("sponza/sponza.obj", &format!("{PINK}{view}")) else { return };
    let film = film(&scene);
    // The courtyard is open above.
    let sky = share(&film, is_pink);
    assert!(sky < 0.15, "{sky} of the picture is sky");
    assert!(share(&film, |p| p.iter().sum::<f32>() == 0.0) < 0.05, "black");
    let walls: Vec<_> = film.pixels.iter().filter(|p| !is_pink(p)).collect();
    let colours: std::collections::HashSet<_> = walls.iter().map(|p| p.map(f32::to_bits)).collect();
    assert!(colours.len() > walls.len() / 2, "textures are seen: {} colours", colours.len());
}

#[test]
fn living_room() {
    let view = "
[camera]
position = [5.105184, 0.731065, -2.317890]
look_at = [4.143388, 0.805472, -2.054414]
fov_deg = 58.7155
[[light.point]]
position = [2.5, 2.4, -2]
intensity = 8
";
    let Some(scene) = with_mesh("living_room/living_room.obj", &format!("{PINK}{view}")) else { return };
    let film = film(&scene);
    assert!(share(&film, is_pink) < 0.3, "the room is closed but for its windows");
    let brightness = mean(&film);
    assert!(brightness > 0.05, "{brightness}");
}
