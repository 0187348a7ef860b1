//! Small pictures that must not change unnoticed.
//!
//! `Watertight` must give the stored bytes; the other tiers a picture within the named tolerances of it. After a change
//! that is meant, look at the new pictures and store them with
//!
//! ```sh
//! OCTRAY_UPDATE_GOLDEN=1 cargo test --release --test golden
//! ```

mod common;

use std::path::PathBuf;

use common::{builtin, film, in_tier};
use octray::describe::Tier;
use octray::film::{Film, Rgb8, Tone, develop};
use octray::output::{Format, Picture, read_file, write_file};

const SIZE: [u32; 2] = [64, 48];
const SCENES: [&str; 6] = ["seed", "cornell", "glass", "spheres", "instances", "terrain:2000"];

/// Most that the mean of a channel may differ between tiers, of 255.
const TIER_MEAN: f64 = 0.25;
/// Largest share of pixels that may differ between tiers by more than [`TIER_STEP`]: those at edges, and behind glass.
const TIER_SHARE: f64 = 0.02;
const TIER_STEP: u8 = 8;

fn picture(name: &str, tier: Tier) -> Rgb8 {
    develop(&film(&in_tier(builtin(name, SIZE, 4), tier)), Tone::default()).picture
}

fn stored(name: &str) -> PathBuf {
    let file = format!("tests/golden/{}.png", name.replace(':', "-"));
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(file)
}

/// The film must develop to the stored bytes.
fn assert_stored(name: &str, film: &Film) {
    let path = stored(name);
    if std::env::var_os("OCTRAY_UPDATE_GOLDEN").is_some() {
        write_file(&path, film, Format::Png, Tone::default()).unwrap();
    }
    let Picture::Display(expected) = read_file(&path).unwrap() else { unreachable!("a PNG has bytes") };
    let found = develop(film, Tone::default()).picture;
    let differ = found.bytes.iter().zip(&expected.bytes).filter(|(a, b)| a != b).count();
    assert_eq!(differ, 0, "{name}: {differ} of {} bytes differ from {}", found.bytes.len(), path.display());
}

#[test]
fn watertight_pictures_are_the_stored_bytes() {
    for name in SCENES {
        assert_stored(name, &film(&builtin(name, SIZE, 4)));
    }
}

#[test]
fn the_readmes_picture_is_what_its_command_renders() {
    assert_stored("readme", &film(&octray::describe::builtin("seed").unwrap().unwrap()));
}

#[test]
fn other_tiers_give_nearly_the_same() {
    for name in SCENES {
        let watertight = picture(name, Tier::Watertight);
        for tier in [Tier::Fast, Tier::Exact] {
            let other = picture(name, tier);
            let steps = || watertight.bytes.iter().zip(&other.bytes).map(|(a, b)| a.abs_diff(*b));
            let mean = steps().map(f64::from).sum::<f64>() / watertight.bytes.len() as f64;
            let far =
                steps().collect::<Vec<_>>().chunks(3).filter(|p| p.iter().any(|&s| s > TIER_STEP)).count();
            let share = far as f64 / f64::from(SIZE[0] * SIZE[1]);
            assert!(mean <= TIER_MEAN && share <= TIER_SHARE, "{name} {tier:?}: mean {mean}, share {share}");
        }
    }
}
