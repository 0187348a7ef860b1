use proptest::prelude::*;
use wide::{f32x8, u32x8};

use super::*;
use crate::sampling::twin::assert_lanes;

const KINDS: [SamplerKind; 3] = [SamplerKind::Random, SamplerKind::Stratified, SamplerKind::Sobol];
const COUNTS: [u32; 12] = [1, 2, 3, 4, 5, 7, 16, 31, 50, 64, 100, 1000];

fn points(kind: SamplerKind, spp: u32, pixel: [u32; 2], dimension: u32) -> Vec<(f32, f32)> {
    let sampler = Sampler::new(kind, spp, 7);
    (0..spp).map(|s| sampler.pair::<f32>(pixel[0], pixel[1], s, dimension)).collect()
}

fn assert_each_once(cells: impl Iterator<Item = usize>, count: usize, what: &str) {
    let mut filled = vec![false; count];
    for cell in cells {
        assert!(!std::mem::replace(&mut filled[cell], true), "{what}: cell {cell} twice");
    }
}

fn cell(x: f32, of: u32) -> usize {
    (f64::from(x) * f64::from(of)) as usize
}

#[test]
fn stratified_has_one_sample_a_slice_and_a_cell() {
    for (spp, n) in COUNTS.into_iter().flat_map(|c| (0..20).map(move |n| (c, n))) {
        let samples = points(SamplerKind::Stratified, spp, [n, 3], 0);
        let columns = 1usize << Grid::new(spp).log2_columns;
        let slice = |y: f32| cell(y, spp);
        assert_each_once(samples.iter().map(|p| slice(p.1)), spp as usize, &format!("{spp} slices"));
        let cells = samples.iter().map(|p| slice(p.1) / columns * columns + cell(p.0, columns as u32));
        assert_each_once(cells, spp as usize + columns, &format!("{spp} cells"));
    }
}

#[test]
fn the_grid_is_near_square_and_wastes_less_than_a_row() {
    for spp in (1..3000).chain([Sampler::MAX_STRATA]) {
        let Grid { log2_columns, rows, .. } = Grid::new(spp);
        let columns = 1 << log2_columns;
        assert!(rows * columns >= spp && rows * columns - spp < columns, "{spp}");
        assert!(rows <= 2 * columns && columns <= 2 * rows, "{spp}: {columns} x {rows}");
    }
}

#[test]
fn sobol_pairs_fill_every_grid_at_powers_of_two() {
    for (log2, n) in (0..9).flat_map(|k| (0..10).map(move |n| (k, n))) {
        let samples = points(SamplerKind::Sobol, 1 << log2, [n, 5], n);
        for columns in (0..=log2).map(|k| 1 << k) {
            let rows = (1 << log2) / columns;
            let cells = samples.iter().map(|p| cell(p.0, columns) * rows as usize + cell(p.1, rows));
            assert_each_once(cells, 1 << log2, &format!("2^{log2} in {columns} columns"));
        }
    }
}

/// Squared L2 star discrepancy by Warnock's formula (1972).
fn discrepancy(points: &[(f32, f32)]) -> f64 {
    let n = points.len() as f64;
    let p: Vec<_> = points.iter().map(|&(x, y)| (f64::from(x), f64::from(y))).collect();
    let single: f64 = p.iter().map(|&(x, y)| (1.0 - x * x) * (1.0 - y * y) / 4.0).sum();
    let double: f64 =
        p.iter().flat_map(|a| p.iter().map(|b| (1.0 - a.0.max(b.0)) * (1.0 - a.1.max(b.1)))).sum();
    1.0 / 9.0 - 2.0 / n * single + double / (n * n)
}

#[test]
fn ordered_samples_have_less_discrepancy_than_random_ones() {
    let average = |kind, spp| (0..50).map(|n| discrepancy(&points(kind, spp, [n, 0], 0))).sum::<f64>() / 50.0;
    for spp in [4, 16, 50, 64, 256] {
        let random = average(SamplerKind::Random, spp);
        for kind in [SamplerKind::Stratified, SamplerKind::Sobol] {
            let ordered = average(kind, spp);
            assert!(ordered * f64::from(spp).sqrt() < random, "{kind:?} {spp}: {ordered} against {random}");
        }
    }
}

/// Each coordinate has mean 1/2 and variance 1/12 over pixels, at every single sample number.
#[test]
fn each_sample_alone_is_uniform() {
    for (kind, spp) in KINDS.into_iter().flat_map(|k| [1, 3, 5, 16].map(|s| (k, s))) {
        let sampler = Sampler::new(kind, spp, 1);
        for sample in 0..spp {
            let n = 20_000;
            let (mut sum, mut squares) = ([0.0; 2], [0.0; 2]);
            for i in 0..n {
                let (a, b) = sampler.pair::<f32>(i % 200, i / 200, sample, 8);
                for (k, v) in [a, b].map(f64::from).into_iter().enumerate() {
                    sum[k] += v;
                    squares[k] += v * v;
                }
            }
            for k in 0..2 {
                let mean = sum[k] / f64::from(n);
                let variance = squares[k] / f64::from(n) - mean * mean;
                assert!((mean - 0.5).abs() < 0.01, "{kind:?} {sample} of {spp}: mean {mean}");
                assert!(
                    (variance - 1.0 / 12.0).abs() < 0.003,
                    "{kind:?} {sample} of {spp}: variance {variance}"
                );
            }
        }
    }
}

/// Correlation of two streams over many pixels, at five standard deviations.
#[track_caller]
fn assert_uncorrelated(what: &str, streams: impl Fn(u32) -> (f32, f32)) {
    let n = 20_000;
    let product = |i| {
        let (a, b) = streams(i);
        (f64::from(a) - 0.5) * (f64::from(b) - 0.5) * 12.0
    };
    let correlation = (0..n).map(product).sum::<f64>() / f64::from(n);
    assert!(correlation.abs() < 5.0 / f64::from(n).sqrt(), "{what}: {correlation}");
}

#[test]
fn pixels_dimensions_seeds_and_coordinates_are_independent() {
    for kind in KINDS {
        let (s, other) = (Sampler::new(kind, 16, 1), Sampler::new(kind, 16, 2));
        let at = |s: &Sampler, i: u32, dx, dy, n, d| s.pair::<f32>(i % 160 * 2 + dx, i / 160 * 2 + dy, n, d);
        for n in [0, 1, 7] {
            assert_uncorrelated("x neighbour", |i| (at(&s, i, 0, 0, n, 0).0, at(&s, i, 1, 0, n, 0).0));
            assert_uncorrelated("y neighbour", |i| (at(&s, i, 0, 0, n, 0).1, at(&s, i, 0, 1, n, 0).1));
            assert_uncorrelated("dimension", |i| (at(&s, i, 0, 0, n, 0).0, at(&s, i, 0, 0, n, 1).0));
            assert_uncorrelated("seed", |i| (at(&s, i, 0, 0, n, 0).1, at(&other, i, 0, 0, n, 0).1));
            assert_uncorrelated("coordinates", |i| at(&s, i, 0, 0, n, 0));
        }
    }
}

proptest! {
    #[test]
    fn lanes_equal_the_scalar(
        [x, y, sample, dimension] in any::<[[u32; 8]; 4]>(), spp in 1u32..3000, seed in any::<u64>(), kind in 0usize..3,
    ) {
        let sampler = Sampler::new(KINDS[kind], spp, seed);
        for sample in [sample, sample.map(|s| s % spp)] {
            let [px, py, ps, pd] = [x, y, sample, dimension].map(u32x8::new);
            let (a, b) = sampler.pair::<f32x8>(px, py, ps, pd);
            let scalar = |i: usize| sampler.pair::<f32>(x[i], y[i], sample[i], dimension[i]);
            assert_lanes(a, |i| scalar(i).0);
            assert_lanes(b, |i| scalar(i).1);
            assert_lanes(sampler.single(px, py, ps, pd), |i| scalar(i).1);
            for i in 0..8 {
                prop_assert!((0.0..1.0).contains(&a.get(i)) && (0.0..1.0).contains(&b.get(i)));
            }
        }
    }
}
