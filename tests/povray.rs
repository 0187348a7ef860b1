//! `seed` against POV-Ray 3.7, where `povray` is installed.
//!
//! Outside the mask the mean difference is at most 0.3 of 255. The mask: highlights, which POV-Ray computes from the same
//! half vector but clips each sample to 1 before averaging, where octray averages light and clips the pixel; a pixel is
//! masked where either picture is above 250 of 255 in a channel. What else differs: places of the samples in a pixel (a
//! grid with shared corners against a stratified one), seen at edges.

mod common;

use std::path::Path;
use std::process::Command;

use common::{builtin, film};
use octray::describe::Sampler;
use octray::film::{Rgb8, Tone, develop};
use octray::output::{Picture, read_file};

const SIZE: [u32; 2] = [320, 240];
const CLIPPED: u8 = 250;

fn povray(folder: &Path) -> Option<Rgb8> {
    let picture = folder.join("seed.png");
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/povray/seed.pov");
    let [width, height] = SIZE;
    let run = Command::new("povray")
        .args([format!("+I{}", scene.display()), format!("+O{}", picture.display())])
        .args([format!("+W{width}"), format!("+H{height}")])
        // A grid of 4 x 4 samples in every pixel, nothing on the screen, bytes as a screen shows them.
        .args(["+A0.0", "+AM1", "+R4", "-J0", "-D", "+WT2", "File_Gamma=sRGB"])
        .output();
    match run {
        Ok(output) => {
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
            let Picture::Display(picture) = read_file(&picture).unwrap() else { unreachable!("a PNG") };
            Some(picture)
        }
        Err(_) => {
            println!("skipped: povray is not installed");
            None
        }
    }
}

#[test]
fn seed_is_the_picture_of_povray() {
    let folder = tempfile::tempdir().unwrap();
    let Some(theirs) = povray(folder.path()) else { return };
    let mut scene = builtin("seed", SIZE, 16);
    scene.render.sampler = Sampler::Stratified;
    let ours = develop(&film(&scene), Tone::default()).picture;
    let pairs = ours.bytes.chunks(3).zip(theirs.bytes.chunks(3));
    let open: Vec<_> = pairs.filter(|(a, b)| a.iter().chain(*b).all(|&byte| byte <= CLIPPED)).collect();
    let steps: f64 =
        open.iter().flat_map(|(a, b)| a.iter().zip(*b)).map(|(a, b)| f64::from(a.abs_diff(*b))).sum();
    let mean = steps / (3.0 * open.len() as f64);
    let masked = 1.0 - open.len() as f64 / f64::from(SIZE[0] * SIZE[1]);
    println!("mean difference {mean:.3} of 255, {:.2} % of pixels masked", 100.0 * masked);
    assert!(masked < 0.02, "{masked} of the picture is masked");
    assert!(mean <= 0.3, "mean difference {mean}");
}
