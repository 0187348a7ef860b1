//! The three ways to place samples: random, stratified, Sobol.

use super::hash::{key, pcg4d, unit};
use super::owen::scrambled_sobol;
use super::permute::permute;
use crate::math::{BitLane, Lane};

/// How samples of a pixel are placed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum SamplerKind {
    /// Independent of each other.
    Random,
    /// One in each cell of a grid, and one in each of `spp` slices.
    Stratified,
    /// Owen-scrambled Sobol: every power of two of them fills all grids of as many cells.
    #[default]
    Sobol,
}

/// Numbers in `[0, 1)` as a function of pixel, sample and dimension.
///
/// Pixels and dimensions are independent of each other; the samples of one pixel in one dimension are placed by the
/// [`SamplerKind`].
#[derive(Clone, Copy, Debug)]
pub struct Sampler {
    kind: SamplerKind,
    grid: Grid,
    key: [u32; 2],
}

/// `2^log2_columns` columns and as many rows as hold `samples` cells; no side is more than twice the other.
///
/// Columns are a power of two because lanes can shift and mask but not divide.
#[derive(Clone, Copy, Debug)]
struct Grid {
    samples: u32,
    log2_columns: u32,
    rows: u32,
}

impl Grid {
    fn new(samples: u32) -> Self {
        // The power of two nearest to sqrt(samples) by ratio: 4^k <= 2 samples < 4^(k+1).
        let log2_columns = (samples * 2).ilog2() / 2;
        Self { samples, log2_columns, rows: samples.div_ceil(1 << log2_columns) }
    }
}

impl Sampler {
    /// Most samples a pixel of [`SamplerKind::Stratified`]; more repeat the strata.
    pub const MAX_STRATA: u32 = 1 << 22;

    /// A sampler for `spp` samples a pixel; `spp` 0 counts as 1. Only `Stratified` uses the number.
    pub fn new(kind: SamplerKind, spp: u32, seed: u64) -> Self {
        Self { kind, grid: Grid::new(spp.clamp(1, Self::MAX_STRATA)), key: key(seed) }
    }

    /// A point of the unit square for each lane.
    ///
    /// `x`, `y`: the pixel. `sample`: its number in the pixel, below `spp` for `Stratified` (a greater number gives a
    /// valid point in some stratum). `dimension`: [`FILTER`](super::FILTER), [`LENS`](super::LENS) or
    /// [`bounce`](super::bounce).
    #[inline(always)]
    pub fn pair<L: Lane>(&self, x: L::Bits, y: L::Bits, sample: L::Bits, dimension: L::Bits) -> (L, L) {
        match self.kind {
            SamplerKind::Random => {
                let [a, b, ..] = self.sample_words(x, y, sample, dimension);
                (unit(a), unit(b))
            }
            SamplerKind::Stratified => {
                let jitter = self.sample_words(x, y, sample, dimension);
                self.grid.pair(sample, self.pattern_words(x, y, dimension), jitter)
            }
            SamplerKind::Sobol => {
                let [shuffle, first, second, _] = self.pattern_words(x, y, dimension);
                let [a, b] = scrambled_sobol(sample, [shuffle, first, second]);
                (unit(a), unit(b))
            }
        }
    }

    /// A number for each lane; arguments as for [`Sampler::pair`], of which it is a coordinate stratified `spp` times.
    #[inline(always)]
    pub fn single<L: Lane>(&self, x: L::Bits, y: L::Bits, sample: L::Bits, dimension: L::Bits) -> L {
        self.pair(x, y, sample, dimension).1
    }

    /// Words of one sample.
    #[inline(always)]
    fn sample_words<W: BitLane>(&self, x: W, y: W, sample: W, dimension: W) -> [W; 4] {
        pcg4d([x, y, sample ^ W::splat(self.key[0]), dimension ^ W::splat(self.key[1])])
    }

    /// Words that all samples of a pixel share: those of a sample that no picture has.
    #[inline(always)]
    fn pattern_words<W: BitLane>(&self, x: W, y: W, dimension: W) -> [W; 4] {
        self.sample_words(x, y, W::splat(u32::MAX), dimension)
    }
}

impl Grid {
    /// A correlated multi-jittered point: the first coordinate in its own of the columns, the second in its own of
    /// `samples` slices, both together in their own cell.
    ///
    /// If `samples` do not fill the grid, the slices still divide the unit interval evenly and the last row is thinner.
    ///
    /// **Source:** Kensler, Correlated Multi-Jittered Sampling, 2013, section 3; any number of samples as in section 4.
    #[inline(always)]
    fn pair<L: Lane>(&self, sample: L::Bits, order: [L::Bits; 4], jitter: [L::Bits; 4]) -> (L, L) {
        let columns = 1 << self.log2_columns;
        let slice = permute::<L>(sample, self.samples, order[0]);
        let column = permute::<L>(slice & L::Bits::splat(columns - 1), columns, order[1]);
        let row = permute::<L>(slice.shr(self.log2_columns), self.rows, order[2]);
        let within = fraction::<L>(row, jitter[0], self.rows);
        let x = (L::from_bits(column) + within) * L::constant(1.0 / f64::from(columns));
        (below_one(x), fraction(slice, jitter[1], self.samples))
    }
}

/// `(whole + jitter) / of`, below one.
#[inline(always)]
fn fraction<L: Lane>(whole: L::Bits, jitter: L::Bits, of: u32) -> L {
    below_one((L::from_bits(whole) + unit(jitter)) / L::constant(f64::from(of)))
}

/// Takes back what rounding may have added: the largest result is `1 - 2^-24`.
#[inline(always)]
fn below_one<L: Lane>(x: L) -> L {
    x.min(L::constant(1.0 - 1.0 / 16_777_216.0))
}

#[cfg(test)]
mod tests;
