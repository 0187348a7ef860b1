//! How far the mean of a pixel's samples may be off, from the samples themselves.

/// Sums over the samples of one pixel that its standard error follows from.
///
/// Samples count as independent. Stratified and Sobol points are better than that, so their error is overestimated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spread {
    samples: u32,
    weight: f64,
    weight_squares: f64,
    /// Of colours times their weight, by channel.
    sum: [f64; 3],
    /// Of the squares of the same, all channels together.
    squares: f64,
    /// Of the same times the weight once more.
    cross: [f64; 3],
}

impl Spread {
    /// Adds a sample: red, green and blue, each times the sample's weight, and the weight.
    #[inline(always)]
    pub fn push(&mut self, sample: [f32; 4]) {
        let [r, g, b, weight] = sample.map(f64::from);
        self.samples += 1;
        self.weight += weight;
        self.weight_squares += weight * weight;
        for (c, colour) in [r, g, b].into_iter().enumerate() {
            self.sum[c] += colour;
            self.squares += colour * colour;
            self.cross[c] += colour * weight;
        }
    }

    /// Samples pushed.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// Estimated variance of the pixel's mean, averaged over its channels; infinite where the samples say nothing: fewer
    /// than two, or weights that cancel.
    ///
    /// **Source:** the ratio estimator of survey sampling (Cochran, Sampling Techniques, 3rd ed., 1977, section 6.4): the
    /// mean is a ratio of two sums, and the variance is that of its numerator less mean times denominator.
    pub fn variance(&self) -> f64 {
        if self.samples < 2 || self.weight <= 0.0 {
            return f64::INFINITY;
        }
        let n = f64::from(self.samples);
        let off = |c: usize| {
            let mean = self.sum[c] / self.weight;
            mean * (mean * self.weight_squares - 2.0 * self.cross[c])
        };
        let residual = (self.squares + off(0) + off(1) + off(2)).max(0.0);
        residual / (3.0 * self.weight * self.weight) * (n / (n - 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn spread(samples: &[[f32; 4]]) -> Spread {
        let mut spread = Spread::default();
        samples.iter().for_each(|&sample| spread.push(sample));
        spread
    }

    #[test]
    fn too_little_says_nothing() {
        assert_eq!(spread(&[]).variance(), f64::INFINITY);
        assert_eq!(spread(&[[1.0; 4]]).variance(), f64::INFINITY);
        assert_eq!(spread(&[[1.0, 1.0, 1.0, 0.5], [1.0, 1.0, 1.0, -0.5]]).variance(), f64::INFINITY);
        assert_eq!(spread(&[[0.25, 0.5, 0.75, 1.0]; 16]).variance(), 0.0);
    }

    #[test]
    fn a_coin_is_off_by_half_over_the_root_of_throws() {
        let throws: Vec<_> =
            (0..100).map(|i| [(i % 2) as f32, (i % 2) as f32, (i % 2) as f32, 1.0]).collect();
        assert!((spread(&throws).variance() - 0.25 / 99.0).abs() < 1e-12);
    }

    proptest! {
        /// The textbook's variance of a mean, in two passes.
        #[test]
        fn equal_weights_give_the_variance_of_the_mean(
            samples in prop::collection::vec(prop::array::uniform3(0.0f32..10.0), 2..50),
        ) {
            let n = samples.len() as f64;
            let of = |c: usize| {
                let mean = samples.iter().map(|s| f64::from(s[c])).sum::<f64>() / n;
                samples.iter().map(|s| (f64::from(s[c]) - mean).powi(2)).sum::<f64>() / (n * (n - 1.0))
            };
            let expected = (of(0) + of(1) + of(2)) / 3.0;
            let weighted: Vec<_> = samples.iter().map(|&[r, g, b]| [r, g, b, 1.0]).collect();
            prop_assert!((spread(&weighted).variance() - expected).abs() <= 1e-9 * (1.0 + expected));
        }

        /// Weights of any common size cancel.
        #[test]
        fn the_scale_of_weights_does_not_matter(
            samples in prop::collection::vec(prop::array::uniform4(0.1f32..1.0), 2..50),
        ) {
            let scaled: Vec<_> = samples.iter().map(|s| s.map(|x| 4.0 * x)).collect();
            let (a, b) = (spread(&samples).variance(), spread(&scaled).variance());
            prop_assert!((a - b).abs() <= 1e-9 * (1.0 + a));
        }
    }
}
