use proptest::prelude::*;
use wide::f32x8;

use super::*;
use crate::sampling::twin::{assert_lanes, packet};
use crate::sampling::{Sampler, SamplerKind};

const THIRD: f32 = 1.0 / 3.0;
const FILTERS: [PixelFilter; 8] = [
    PixelFilter::Box { radius: 0.5 },
    PixelFilter::Box { radius: 1.0 },
    PixelFilter::Tent { radius: 1.5 },
    PixelFilter::Gaussian { radius: 1.5, sigma: 0.5 },
    PixelFilter::Gaussian { radius: 2.0, sigma: 3.0 },
    PixelFilter::Mitchell { radius: 2.0, b: THIRD, c: THIRD },
    PixelFilter::Mitchell { radius: 1.5, b: 0.0, c: 0.5 },
    PixelFilter::Mitchell { radius: 2.0, b: 1.0, c: 0.0 },
];

/// The published formulas, in pixels, up to a factor: independent of the Horner forms.
fn published(filter: &PixelFilter, x: f64) -> f64 {
    let x = x.abs();
    match *filter {
        PixelFilter::Box { .. } => 1.0,
        PixelFilter::Tent { radius } => f64::from(radius) - x,
        PixelFilter::Gaussian { radius, sigma } => {
            let (r, s) = (f64::from(radius), f64::from(sigma));
            (-x * x / (2.0 * s * s)).exp() - (-r * r / (2.0 * s * s)).exp()
        }
        PixelFilter::Mitchell { radius, b, c } => {
            let (b, c, x) = (f64::from(b), f64::from(c), x * 2.0 / f64::from(radius));
            if x < 1.0 {
                (12.0 - 9.0 * b - 6.0 * c) * x.powi(3) + (-18.0 + 12.0 * b + 6.0 * c) * x * x + 6.0 - 2.0 * b
            } else {
                (-b - 6.0 * c) * x.powi(3)
                    + (6.0 * b + 30.0 * c) * x * x
                    + (-12.0 * b - 48.0 * c) * x
                    + 8.0 * b
                    + 24.0 * c
            }
        }
    }
}

/// Integral of a function over the filter's width, by the midpoint rule.
fn integral(filter: &PixelFilter, f: impl Fn(f64) -> f64) -> f64 {
    let (n, r) = (40_000, f64::from(filter.radius()));
    let h = 2.0 * r / f64::from(n);
    (0..n).map(|k| f((f64::from(k) + 0.5) * h - r) * h).sum()
}

/// Kolmogorov distance between the samples of evenly spaced numbers and the filter's magnitude.
#[test]
fn samples_follow_the_magnitude_of_the_filter() {
    for filter in FILTERS {
        let (sampler, n) = (filter.sampler(), 40_000);
        let (r, total) = (f64::from(filter.radius()), integral(&filter, |x| published(&filter, x).abs()));
        let (h, mut sum, mut previous, mut worst) = (2.0 * r / f64::from(n), 0.0, 0, 0.0f64);
        let samples: Vec<f64> =
            (0..n).map(|k| f64::from(sampler.sample::<f32>((k as f32 + 0.5) / n as f32, 0.5).0)).collect();
        assert!(samples.is_sorted() && samples.iter().all(|x| x.abs() <= r), "{filter:?}");
        for k in 0..n {
            sum += published(&filter, (f64::from(k) + 0.5) * h - r).abs() * h / total;
            let edge = f64::from(k + 1) * h - r;
            previous += samples[previous..].partition_point(|&x| x < edge);
            worst = worst.max((sum - previous as f64 / f64::from(n)).abs());
        }
        assert!(worst < 7e-5 + 1.0 / f64::from(n), "{filter:?}: {worst}");
    }
}

/// Weighted means over well-spread samples equal the moments of the signed filter.
#[test]
fn weighted_mean_and_variance_are_those_of_the_filter() {
    for filter in FILTERS {
        let (sampler, numbers, n) = (filter.sampler(), Sampler::new(SamplerKind::Sobol, 1 << 16, 3), 1 << 16);
        let (mut weights, mut mean, mut variance) = (0.0, 0.0, 0.0);
        for sample in 0..n {
            let (u, v) = numbers.pair::<f32>(4, 5, sample, 0);
            let (x, y, w) = sampler.sample(u, v);
            weights += f64::from(w);
            mean += f64::from(w * x);
            variance += f64::from(w * y * y);
        }
        let moment = |p: i32| integral(&filter, |x| published(&filter, x) * x.powi(p));
        let share = moment(0) / integral(&filter, |x| published(&filter, x).abs());
        assert!((weights / f64::from(n) - share * share).abs() < 1e-3, "{filter:?}: weight");
        assert!((mean / weights).abs() < 1e-3, "{filter:?}: mean {}", mean / weights);
        let expected = moment(2) / moment(0);
        assert!((variance / weights - expected).abs() < 2e-3, "{filter:?}: variance {}", variance / weights);
    }
}

#[test]
fn only_ringing_filters_have_negative_lobes() {
    let negative = FILTERS.map(|f| f.has_negative_lobes());
    assert_eq!(negative, [false, false, false, false, false, true, true, false]);
}

#[test]
fn the_reports_jitter_is_a_box_of_radius_one() {
    let sampler = PixelFilter::Box { radius: 1.0 }.sampler();
    assert_eq!(sampler.sample::<f32>(0.0, 0.75), (-1.0, 0.5, 1.0));
}

#[test]
fn a_filter_without_width_stays_at_the_centre() {
    let sampler = PixelFilter::Box { radius: 0.0 }.sampler();
    assert_eq!(sampler.sample::<f32>(0.9, 0.1), (0.0, 0.0, 1.0));
}

proptest! {
    #[test]
    fn lanes_equal_the_scalar(u in any::<[u32; 8]>(), v in any::<[u32; 8]>()) {
        let number = |words: [u32; 8], i: usize| crate::sampling::unit::<f32>(words[i]);
        for filter in FILTERS {
            let sampler = filter.sampler();
            let (x, y, w) = sampler.sample::<f32x8>(packet(|i| number(u, i)), packet(|i| number(v, i)));
            let scalar = |i: usize| sampler.sample::<f32>(number(u, i), number(v, i));
            assert_lanes(x, |i| scalar(i).0);
            assert_lanes(y, |i| scalar(i).1);
            assert_lanes(w, |i| scalar(i).2);
        }
    }
}
