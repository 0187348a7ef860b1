//! Units: the pieces of pictures that are rendered and recorded one by one.

use std::ops::Range;

use super::picture::Picture;
use super::plan::Split;
use crate::film::SAMPLES_PER_BLOCK;

/// Edge of a unit that is a tile.
const TILE: u32 = 128;

/// One piece of a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unit {
    /// Its number in the plan.
    pub number: u64,
    /// Place of its picture in the plan.
    pub picture: usize,
    /// Left, top, width, height in pixels.
    pub rect: [u32; 4],
    /// Which samples of each pixel; whole blocks but for the end of the last.
    pub samples: Range<u32>,
}

/// How a picture is cut.
pub(super) struct Cut {
    split: Split,
    size: [u32; 2],
    spp: u32,
    /// Ranges of samples.
    ranges: u64,
}

impl Cut {
    pub(super) fn of(split: Split, shards: u32, picture: &Picture) -> Self {
        let blocks = u64::from(picture.spp.div_ceil(SAMPLES_PER_BLOCK));
        Self { split, size: picture.size, spp: picture.spp, ranges: blocks.min(u64::from(shards)).max(1) }
    }

    pub(super) fn units(&self) -> u64 {
        match self.split {
            Split::Frames => 1,
            Split::Tiles => self.columns() * u64::from(self.size[1].div_ceil(TILE)),
            Split::Samples => self.ranges,
        }
    }

    /// Unit number `part` of the picture.
    pub(super) fn unit(&self, number: u64, picture: usize, part: u64) -> Unit {
        let [width, height] = self.size;
        let whole = Unit { number, picture, rect: [0, 0, width, height], samples: 0..self.spp };
        match self.split {
            Split::Frames => whole,
            Split::Tiles => Unit { rect: self.tile(part), ..whole },
            Split::Samples => Unit { samples: self.range(part), ..whole },
        }
    }

    fn columns(&self) -> u64 {
        u64::from(self.size[0].div_ceil(TILE))
    }

    fn tile(&self, part: u64) -> [u32; 4] {
        let (x, y) = ((part % self.columns()) as u32 * TILE, (part / self.columns()) as u32 * TILE);
        [x, y, TILE.min(self.size[0] - x), TILE.min(self.size[1] - y)]
    }

    /// Whole blocks, as evenly as they can be shared out.
    fn range(&self, part: u64) -> Range<u32> {
        let blocks = u64::from(self.spp.div_ceil(SAMPLES_PER_BLOCK));
        let sample = |part: u64| (part * blocks / self.ranges * u64::from(SAMPLES_PER_BLOCK)) as u32;
        sample(part).min(self.spp)..sample(part + 1).min(self.spp)
    }
}

impl Unit {
    /// The blocks of samples that it sums.
    pub(super) fn blocks(&self) -> Range<u64> {
        u64::from(self.samples.start / SAMPLES_PER_BLOCK)
            ..u64::from(self.samples.end.div_ceil(SAMPLES_PER_BLOCK))
    }

    /// About how many bytes it takes until its files are written: its sums, its film, and `files` of them encoded, where
    /// pixels have so many `channels` beside colour.
    pub(super) fn size_bytes(&self, split: Split, channels: u64, files: u64) -> u64 {
        let pixels = u64::from(self.rect[2]) * u64::from(self.rect[3]);
        // As many nodes as the number of blocks has digits.
        let nodes = u64::from(u64::BITS - (self.blocks().end - self.blocks().start).leading_zeros());
        let (sums, film) = (16 * nodes + 4 * channels, 12 + 4 * channels);
        let written = match split {
            Split::Frames => film * (2 + files),
            Split::Tiles | Split::Samples => sums,
        };
        pixels.saturating_mul(sums + written)
    }

    /// Camera samples.
    pub(super) fn cost(&self) -> u64 {
        u64::from(self.rect[2]) * u64::from(self.rect[3]) * u64::from(self.samples.end - self.samples.start)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn units(split: Split, shards: u32, size: [u32; 2], spp: u32) -> Vec<Unit> {
        let (name, sets, outputs) = (String::new(), Vec::new(), Vec::new());
        let picture = Picture { name, sets, size, spp, outputs, scene: 0, shape: 0, first_unit: 0, units: 0 };
        let cut = Cut::of(split, shards, &picture);
        (0..cut.units()).map(|part| cut.unit(part, 0, part)).collect()
    }

    #[test]
    fn memory_grows_with_pixels_samples_and_channels() {
        let unit = |size, spp| units(Split::Frames, 1, size, spp).remove(0);
        let bytes = |size, spp, channels| unit(size, spp).size_bytes(Split::Frames, channels, 1);
        assert_eq!(bytes([10, 10], 1, 0), 100 * (16 + 3 * 12));
        assert_eq!(bytes([10, 10], 48, 0), 100 * (2 * 16 + 3 * 12));
        assert_eq!(bytes([20, 10], 1, 5), 200 * (36 + 3 * 32));
    }

    proptest! {
        #[test]
        fn samples_are_shared_out_whole_and_once(shards in 1u32..40, spp in 1u32..2000) {
            let units = units(Split::Samples, shards, [3, 3], spp);
            let mut next = 0;
            for unit in &units {
                prop_assert_eq!(unit.samples.start, next);
                prop_assert!(unit.samples.start < unit.samples.end);
                prop_assert!(unit.samples.start.is_multiple_of(SAMPLES_PER_BLOCK));
                next = unit.samples.end;
            }
            prop_assert_eq!(next, spp);
            prop_assert!(units.len() <= shards as usize);
        }

        #[test]
        fn tiles_cover_the_picture_once(width in 1u32..700, height in 1u32..700) {
            let units = units(Split::Tiles, 3, [width, height], 1);
            let area: u32 = units.iter().map(|unit| unit.rect[2] * unit.rect[3]).sum();
            prop_assert_eq!(area, width * height);
            let corners: std::collections::HashSet<_> = units.iter().map(|u| (u.rect[0], u.rect[1])).collect();
            prop_assert_eq!(corners.len(), units.len());
        }
    }
}
