//! The law of building: time and memory of trees over terrains of 10^3 to 10^7 triangles, by quality, and what a ray then
//! visits. Prints a table.
//!
//! `cargo bench --bench build_law` (some minutes, 3 GiB); a number after `--` is the greatest size.

mod common;

use common::terrain_columns;
use octray::accel::visits::Visits;
use octray::accel::{Accel, Quality};
use octray::geometry::Geometry;
use octray::intersect::Ray;
use octray::sampling::{pcg4d, unit};
use std::time::{Duration, Instant};

const RAYS: u32 = 10_000;
/// Each tree is built this often, and the quickest counts.
const BUILDS: usize = 3;

/// From anywhere above the terrain to anywhere in it.
fn visits(accel: &Accel) -> Visits {
    let numbers = |row, what| pcg4d([row, what, 0, 0]).map(unit::<f32>);
    let mut all = Visits::default();
    for row in 0..RAYS {
        let (a, b) = (numbers(row, 1), numbers(row, 2));
        let origin = [3.0 * a[0] - 1.5, a[1], 3.0 * a[2] - 1.5];
        let target = [2.0 * b[0] - 1.0, 0.4 * b[1], 2.0 * b[2] - 1.0];
        all += accel.visits(&Ray::new(origin, std::array::from_fn(|k| target[k] - origin[k])), false);
    }
    all
}

fn line(geometry: &Geometry, quality: Quality) -> u64 {
    let count = geometry.triangles.len() as f64;
    let mut best: Option<(Duration, Accel)> = None;
    for _ in 0..BUILDS {
        let begun = Instant::now();
        let accel = Accel::build_with(geometry, quality);
        let time = begun.elapsed();
        if best.as_ref().is_none_or(|best| time < best.0) {
            best = Some((time, accel));
        }
    }
    let (time, accel) = best.expect("at least one build");
    let seen = visits(&accel);
    let bytes: u64 = accel.memory().iter().map(|(_, bytes)| bytes).sum();
    let a_ray = |what: u64| what as f64 / f64::from(RAYS);
    println!(
        "{:>9} {:>9} {:>10.2} {:>10.2} {:>8.1} {:>8.2} {:>8.2} {:>8.2}",
        geometry.triangles.len(),
        quality.name(),
        time.as_secs_f64() * 1e3,
        count / time.as_secs_f64() / 1e6,
        bytes as f64 / count,
        accel.reference_count() as f64 / accel.leaf_count() as f64,
        a_ray(seen.nodes),
        a_ray(seen.blocks),
    );
    seen.hits
}

fn main() {
    let size = std::env::args().find_map(|argument| argument.parse::<u64>().ok());
    // As a test it only shows that it runs.
    let test = std::env::args().any(|argument| argument == "--test");
    let greatest = size.unwrap_or(if test { 1_000 } else { 10_000_000 });
    println!("{} threads", rayon::current_num_threads());
    println!("triangles   quality         ms   Mtris/s  B/prim     fill    nodes   blocks");
    let sizes = (3..=9).map(|power| 10_u64.pow(power)).take_while(|&size| size <= greatest);
    for geometry in sizes.map(terrain_columns) {
        let [fast, balanced, high] =
            [Quality::Fast, Quality::Balanced, Quality::High].map(|quality| line(&geometry, quality));
        assert!(fast == balanced && balanced == high && fast > 0, "all trees give the same hits");
    }
}
