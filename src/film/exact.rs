//! Radiances of the samples of a wave, as sums that do not depend on the order of what is added.
//!
//! Contributions to a sample come in any order (queues, chunks, packets). Each is rounded to a multiple of 2^-30 once;
//! sums of such multiples are exact in `f64` up to 2^23, and exact sums are the same in any order.

use wide::{f32x8, f64x8};

use crate::math::{Lane, Mask, Vec3, WIDTH, eight, three};

/// Largest magnitude of one contribution: 64 of the largest still sum exactly.
pub const CONTRIBUTION_LIMIT: f32 = 131_072.0;

/// Contributions of this magnitude and less round to nothing: half of 2^-30, and ties go to even.
const NOTHING: f64 = 1.0 / (1u64 << 31) as f64;

/// Adding and subtracting it leaves a multiple of 2^-30: its own unit in the last place.
const ROUNDER: f64 = 1.5 * (1u64 << 22) as f64;

/// The nearest multiples of 2^-30, ties to even. **Needs:** magnitudes below 2^21.
#[inline(always)]
fn quantise<D: Lane<Scalar = f64>>(x: D) -> D {
    (x + D::constant(ROUNDER)) - D::constant(ROUNDER)
}

/// Whether a contribution would change the sum of a sample. One that is not a number would: it is counted.
#[inline(always)]
pub(crate) fn contributes<L: Lane>(rgb: Vec3<L>) -> L::Mask {
    let nothing = L::constant(NOTHING);
    let size = rgb.abs();
    !(size.x.le(nothing) & size.y.le(nothing) & size.z.le(nothing))
}

/// Radiances of the samples of one wave.
///
/// **Accuracy:** a contribution is confined to [`CONTRIBUTION_LIMIT`] and rounded to a multiple of 2^-30; sums are exact
/// up to 2^23.
#[derive(Clone, Debug, Default)]
pub struct SampleSums {
    /// By channel; padded, so that eight may be read from any sample on.
    sums: [Vec<f64>; 3],
    nan_count: u64,
}

impl SampleSums {
    /// Makes room for `count` samples, all black, and forgets the NaN count; keeps memory.
    pub fn reset(&mut self, count: usize) {
        for channel in &mut self.sums {
            channel.clear();
            channel.resize(count + WIDTH, 0.0);
        }
        self.nan_count = 0;
    }

    /// Adds the chosen lanes to their samples. Colours with a NaN in them are left out and counted.
    #[inline(always)]
    pub fn add<L: Lane>(&mut self, samples: &[u32; WIDTH], rgb: Vec3<L>, lanes: u32) {
        let numbers = rgb.x.eq(rgb.x) & rgb.y.eq(rgb.y) & rgb.z.eq(rgb.z);
        let lanes = self.without_nan(lanes, numbers.bits());
        let limit = L::constant(f64::from(CONTRIBUTION_LIMIT));
        let exact = |c: L| quantise(c.clamp(-limit, limit).widen());
        let rgb = [exact(rgb.x), exact(rgb.y), exact(rgb.z)];
        if *samples == eight(|i| samples[0].wrapping_add(i as u32)) {
            self.add_run(samples[0] as usize, rgb, lanes);
        } else {
            self.add_each(samples, rgb, lanes);
        }
    }

    /// Samples that follow each other, as they do where neighbours see the same.
    #[inline(always)]
    fn add_run<D: Lane<Scalar = f64>>(&mut self, first: usize, rgb: [D; 3], lanes: u32) {
        let wanted = D::Mask::from_bits(lanes);
        for (sums, more) in self.sums.iter_mut().zip(rgb) {
            let sums = &mut sums[first..];
            (D::load(sums) + D::select(wanted, more, D::zero())).store(sums);
        }
    }

    #[inline(never)]
    fn add_each<D: Lane<Scalar = f64>>(&mut self, samples: &[u32; WIDTH], rgb: [D; 3], lanes: u32) {
        let count = self.sums[0].len();
        let [r, g, b] = self.sums.each_mut().map(|sums| &mut sums[..count]);
        for i in (0..D::WIDTH).filter(|i| lanes >> i & 1 != 0) {
            let sample = samples[i] as usize;
            r[sample] += rgb[0].get(i);
            g[sample] += rgb[1].get(i);
            b[sample] += rgb[2].get(i);
        }
    }

    #[inline(always)]
    fn without_nan(&mut self, lanes: u32, numbers: u32) -> u32 {
        if lanes & !numbers != 0 {
            self.nan_count += u64::from((lanes & !numbers).count_ones());
        }
        lanes & numbers
    }

    /// The radiances of eight samples from one on, by channel.
    #[inline(always)]
    pub fn eight(&self, first: usize) -> [[f32; WIDTH]; 3] {
        three(|c| f32x8::narrow(f64x8::load(&self.sums[c][first..])).to_array())
    }

    /// The radiance of a sample.
    #[inline(always)]
    pub fn rgb(&self, sample: usize) -> [f32; 3] {
        three(|c| self.sums[c][sample] as f32)
    }

    /// Contributions left out since the last reset because they were not numbers.
    pub fn nan_count(&self) -> u64 {
        self.nan_count
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn one(x: f32) -> f32 {
        let mut sums = SampleSums::default();
        sums.reset(1);
        sums.add(&[0; WIDTH], Vec3 { x, y: 0.0f32, z: 0.0 }, 1);
        sums.rgb(0)[0]
    }

    #[test]
    fn rounding_is_exact_where_it_can_be_and_bounded_elsewhere() {
        let (limit, step) = (CONTRIBUTION_LIMIT, 1.0 / (1u32 << 30) as f32);
        let cases = [
            (0.0, 0.0),
            (0.1, 0.1),
            (-3.75, -3.75),
            (limit, limit),
            (2.0 * limit, limit),
            (f32::INFINITY, limit),
            (f32::NEG_INFINITY, -limit),
            (1e-20, 0.0),
            (step, step),
            (0.5 * step, 0.0),
        ];
        for (x, expected) in cases {
            assert_eq!(one(x), expected, "{x}");
        }
    }

    #[test]
    fn contributions_that_are_not_numbers_are_left_out_and_counted() {
        let mut sums = SampleSums::default();
        sums.reset(2);
        sums.add(&[1; WIDTH], Vec3 { x: 1.0f32, y: 2.0, z: 3.0 }, 1);
        sums.add(&[1; WIDTH], Vec3 { x: 1.0f32, y: f32::NAN, z: 3.0 }, 1);
        assert_eq!((sums.rgb(0), sums.rgb(1), sums.nan_count()), ([0.0; 3], [1.0, 2.0, 3.0], 1));
        sums.reset(1);
        assert_eq!((sums.rgb(0), sums.nan_count()), ([0.0; 3], 0));
    }

    #[test]
    fn what_contributes_is_what_changes_a_sum() {
        for exponent in 20..40 {
            let power = 1.0 / (1u64 << exponent) as f32;
            for x in [power, power.next_up(), power.next_down(), -power, -power.next_up()] {
                assert_eq!(contributes(Vec3 { x: 0.0, y: x, z: 0.0 }), one(x) != 0.0, "{x:e}");
            }
        }
        assert!(contributes(Vec3 { x: 0.0, y: 0.0, z: f32::NAN }));
        assert!(!contributes(Vec3::<f32>::zero()));
    }

    proptest! {
        /// The largest and the smallest together, forwards and backwards.
        #[test]
        fn no_order_changes_a_sum(mut values in prop::collection::vec(
            prop_oneof![-1e6f32..1e6, -1.0f32..1.0, -1e-6f32..1e-6], 1..60)) {
            let sum = |values: &[f32]| {
                let mut sums = SampleSums::default();
                sums.reset(1);
                values.iter().for_each(|&x| sums.add(&[0; WIDTH], Vec3 { x, y: x, z: -x }, 1));
                three(|c| sums.sums[c][0].to_bits())
            };
            let forwards = sum(&values);
            values.reverse();
            prop_assert_eq!(forwards, sum(&values));
            values.sort_by(f32::total_cmp);
            prop_assert_eq!(forwards, sum(&values));
        }

        /// Lanes and one at a time give the same sums.
        #[test]
        fn lanes_add_like_scalars(values: [f32; WIDTH], samples in prop::array::uniform8(0u32..4), lanes in 0u32..256) {
            let (mut wide, mut scalar) = (SampleSums::default(), SampleSums::default());
            wide.reset(4);
            scalar.reset(4);
            let v = wide::f32x8::new(values);
            wide.add(&samples, Vec3 { x: v, y: v, z: v }, lanes);
            for i in (0..WIDTH).filter(|i| lanes >> i & 1 != 0) {
                let x = values[i];
                scalar.add(&[samples[i]; WIDTH], Vec3 { x, y: x, z: x }, 1);
            }
            prop_assert_eq!(wide.sums, scalar.sums);
            prop_assert_eq!(wide.nan_count, scalar.nan_count);
        }
    }
}
