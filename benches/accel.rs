//! Building trees in triangles a second, and traversing them in rays a second.
//!
//! Scenes: a terrain (many small triangles, one surface) and a soup of spheres (overlapping, seen through each other).
//! Coherent rays come from a pinhole, eight neighbours of a row a packet; incoherent ones go anywhere.

mod common;

use common::terrain_columns;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use octray::accel::{Accel, Hint, Quality, RayScene, RaySceneBuilder, Traversal, brute};
use octray::geometry::{Geometry, Group, NO_MATERIAL};
use octray::intersect::{Hit, Ray, RayLanes, TierName, Watertight};
use octray::load::terrain;
use octray::sampling::{pcg4d, unit};
use std::hint::black_box;

const TRIANGLES: u64 = 200_000;
const SPHERES: u32 = 20_000;
const RAYS: usize = 1 << 16;
/// Rays of each set that are asked again without a tree before anything is timed.
const CHECKED: usize = 64;
const TIERS: [TierName; 3] = [TierName::Fast, TierName::Watertight, TierName::Exact];

/// Four numbers from 0 to 1.
fn numbers(row: u32, what: u32) -> [f32; 4] {
    pcg4d([row, what, 0, 0]).map(unit::<f32>)
}

/// A scene twice: as columns for the plain loop, and as rays see it.
struct Scenery {
    name: &'static str,
    geometry: Geometry,
    scene: RayScene,
    /// Where its pinhole stands.
    eye: [f32; 3],
}

fn hills() -> Scenery {
    let mesh = terrain(TRIANGLES, 0, false);
    let scene = RaySceneBuilder::new().mesh(&mesh.positions, &mesh.triangles).expect("a sound mesh").build();
    Scenery { name: "terrain", geometry: terrain_columns(TRIANGLES), scene, eye: [0.0, 1.2, -2.0] }
}

fn soup() -> Scenery {
    let mut geometry = Geometry::default();
    let mut builder = RaySceneBuilder::new();
    for row in 0..SPHERES {
        let [x, y, z, r] = numbers(row, 0);
        let (center, radius) = ([x, y, z].map(|c| 2.0 * c - 1.0), 0.002 + 0.01 * r);
        geometry.spheres.push(center, radius, NO_MATERIAL);
        builder = builder.sphere(center, radius).expect("a sound sphere");
    }
    geometry.groups = vec![Group { spheres: 0..SPHERES as usize, ..Group::default() }];
    Scenery { name: "spheres", geometry, scene: builder.build(), eye: [0.0, 0.0, -3.0] }
}

/// A square picture seen from the eye, row by row.
fn coherent(eye: [f32; 3]) -> Vec<Ray> {
    let side = (RAYS as f32).sqrt() as usize;
    let at = |i: usize| 2.0 * (i as f32 + 0.5) / side as f32 - 1.0;
    let ray = |i: usize| {
        let target = [at(i % side), at(i / side) * 0.5, 0.0];
        Ray::new(eye, std::array::from_fn(|k| target[k] - eye[k]))
    };
    (0..side * side).map(ray).collect()
}

/// From anywhere near the scene to anywhere in it.
fn incoherent() -> Vec<Ray> {
    let ray = |i: u32| {
        let (a, b) = (numbers(i, 1), numbers(i, 2));
        let origin = [3.0 * a[0] - 1.5, a[1], 3.0 * a[2] - 1.5];
        let target = [2.0 * b[0] - 1.0, 0.4 * b[1], 2.0 * b[2] - 1.0];
        Ray::new(origin, std::array::from_fn(|k| target[k] - origin[k]))
    };
    (0..RAYS as u32).map(ray).collect()
}

/// Asks some rays without the tree; gives how many of all rays hit.
fn checked_hits(scenery: &Scenery, rays: &[Ray], hint: Hint) -> usize {
    let mut hits: Vec<Option<Hit>> = vec![None; rays.len()];
    scenery.scene.closest(rays, &mut hits, TierName::Watertight, hint);
    for i in (0..rays.len()).step_by(rays.len() / CHECKED) {
        let plain = brute::closest::<Watertight>(&scenery.geometry, &RayLanes::from(&rays[i]));
        assert_eq!(hits[i].map(|hit| (hit.t, hit.prim)), plain.map(|hit| (hit.t, hit.prim)), "ray {i}");
    }
    let mut occluded = vec![false; rays.len()];
    scenery.scene.occluded(rays, &mut occluded, TierName::Watertight, hint);
    assert!(occluded.iter().zip(&hits).all(|(&occluded, hit)| occluded == hit.is_some()));
    let count = hits.iter().flatten().count();
    assert!(count * 20 > rays.len(), "{count} hits measure nothing but misses");
    count
}

/// A tree is as good as its answers: hits through it are those of the plain loop.
fn check_tree(accel: &Accel, geometry: &Geometry) {
    let rays = incoherent();
    for ray in rays.iter().step_by(rays.len() / CHECKED) {
        let found =
            Traversal::new(accel).closest::<Watertight>(&RayLanes::splat(&RayLanes::from(ray)), Hint::Auto);
        let plain = brute::closest::<Watertight>(geometry, &RayLanes::from(ray));
        let hit = (found.t.to_array()[0] < ray.t_max).then(|| found.t.to_array()[0]);
        assert_eq!(hit, plain.map(|hit| hit.t), "{ray:?}");
    }
}

fn build(c: &mut Criterion) {
    let mut group = c.benchmark_group("accel/build");
    group.sample_size(10);
    let geometry = terrain_columns(TRIANGLES);
    group.throughput(Throughput::Elements(geometry.triangles.len() as u64));
    for quality in [Quality::Fast, Quality::Balanced, Quality::High] {
        check_tree(&Accel::build_with(&geometry, quality), &geometry);
        group.bench_function(BenchmarkId::new("terrain", quality.name()), |b| {
            b.iter(|| Accel::build_with(black_box(&geometry), quality))
        });
    }
    let mut accel = Accel::build(&geometry);
    group.bench_function("refit", |b| {
        b.iter(|| accel.refit(black_box(&geometry)).expect("the same triangles"))
    });
    group.finish();
}

fn traverse(c: &mut Criterion) {
    // One thread: what is measured is the traversal.
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread can be started");
    for scenery in [hills(), soup()] {
        let sets = [
            ("coherent", Hint::Coherent, coherent(scenery.eye)),
            ("incoherent", Hint::Incoherent, incoherent()),
        ];
        for (set, hint, rays) in sets {
            checked_hits(&scenery, &rays, hint);
            let mut group = c.benchmark_group(format!("accel/{}/{set}", scenery.name));
            group.sample_size(10).throughput(Throughput::Elements(rays.len() as u64));
            let (mut hits, mut occluded) = (vec![None; rays.len()], vec![false; rays.len()]);
            for tier in TIERS {
                group.bench_function(BenchmarkId::new("closest", tier.name()), |b| {
                    b.iter(|| {
                        alone.install(|| scenery.scene.closest(black_box(&rays), &mut hits, tier, hint))
                    })
                });
                group.bench_function(BenchmarkId::new("any", tier.name()), |b| {
                    b.iter(|| {
                        alone.install(|| scenery.scene.occluded(black_box(&rays), &mut occluded, tier, hint))
                    })
                });
            }
            group.finish();
        }
    }
}

criterion_group!(benches, build, traverse);
criterion_main!(benches);
