//! A unit's sums, in memory and as a file: whole for units that merging puts together, with some tiles for checkpoints.
//!
//! A file is a line that says what it is, a line of JSON, the sums of the tiles that it lists (32-bit little-endian, pixels
//! in the order of rendering), and the BLAKE3 of all that.

use serde::{Deserialize, Serialize};

use super::unit::Unit;
use crate::film::{AovSet, TileSums, node_places};
use crate::wavefront::{Rect, tiles};

const MAGIC: &str = "octray part 1\n";
const HASH_BYTES: usize = 32;

/// What a file of sums says about itself.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Header {
    plan: String,
    unit: u64,
    tiles: Vec<usize>,
    nan_samples: u64,
}

/// The tiles of a unit, each done or not.
#[derive(Clone, Debug)]
pub(super) struct Part {
    pub(super) unit: Unit,
    pub(super) tiles: Vec<Rect>,
    pub(super) sums: Vec<Option<TileSums>>,
    /// Contributions to these sums that were left out because they were not numbers.
    pub(super) nan_samples: u64,
    nodes: usize,
    channels: usize,
}

impl Part {
    /// Nothing done.
    pub(super) fn new(unit: Unit, aovs: AovSet) -> Self {
        let tiles = tiles(unit.rect);
        let blocks = unit.blocks();
        let channels = match unit.samples.start == 0 && aovs.needs_rays() {
            true => aovs.iter().map(|aov| aov.channels().len()).sum(),
            false => 0,
        };
        Self {
            sums: vec![None; tiles.len()],
            tiles,
            nan_samples: 0,
            nodes: node_places(blocks.start, blocks.end).len(),
            channels,
            unit,
        }
    }

    /// The same unit with nothing done and no tiles to do.
    pub(super) fn emptied(&self) -> Self {
        let unit = self.unit.clone();
        Self { tiles: Vec::new(), sums: Vec::new(), nan_samples: 0, unit, ..*self }
    }

    /// Numbers of the tiles that are not done.
    pub(super) fn missing(&self) -> Vec<usize> {
        (0..self.sums.len()).filter(|&tile| self.sums[tile].is_none()).collect()
    }

    /// Whether no tile is done.
    pub(super) fn is_untouched(&self) -> bool {
        self.sums.iter().all(Option::is_none)
    }

    /// The file.
    pub(super) fn encode(&self, plan: &str) -> Vec<u8> {
        let done: Vec<usize> = (0..self.sums.len()).filter(|&tile| self.sums[tile].is_some()).collect();
        let (unit, nan_samples) = (self.unit.number, self.nan_samples);
        let header = Header { plan: plan.to_owned(), unit, tiles: done, nan_samples };
        let mut bytes = MAGIC.as_bytes().to_vec();
        serde_json::to_writer(&mut bytes, &header).expect("a header has only text and numbers");
        bytes.push(b'\n');
        for sums in self.sums.iter().flatten() {
            bytes.extend(sums.nodes.as_flattened().iter().flat_map(|value| value.to_le_bytes()));
            bytes.extend(sums.aovs.iter().flat_map(|value| value.to_le_bytes()));
        }
        let hash = *blake3::hash(&bytes).as_bytes();
        bytes.extend(hash);
        bytes
    }

    /// Takes the tiles of a file into a part with nothing done.
    ///
    /// **Errors:** it is damaged, or of another plan or unit.
    pub(super) fn decode(mut self, bytes: &[u8], plan: &str) -> Result<Self, String> {
        let (header, mut body) = opened(bytes)?;
        if header.plan != plan {
            return Err("belongs to another plan".into());
        }
        if header.unit != self.unit.number {
            return Err(format!("belongs to unit {}, not {}", header.unit, self.unit.number));
        }
        self.nan_samples = header.nan_samples;
        for tile in header.tiles {
            let pixels = self.tiles.get(tile).map(|rect| rect[2] as usize * rect[3] as usize);
            let pixels = pixels.ok_or_else(|| format!("has a tile {tile} that the unit has not"))?;
            let nodes = words(&mut body, pixels * self.nodes * 4)?.map(f32::from_bits);
            let nodes = nodes.collect::<Vec<f32>>().as_chunks::<4>().0.to_vec();
            let aovs = words(&mut body, pixels * self.channels)?.collect();
            self.sums[tile] = Some(TileSums { nodes, aovs });
        }
        if body.is_empty() { Ok(self) } else { Err("is longer than its tiles".into()) }
    }
}

/// Header and body of a file that is whole.
fn opened(bytes: &[u8]) -> Result<(Header, &[u8]), String> {
    let rest = bytes.strip_prefix(MAGIC.as_bytes()).ok_or("is no file of sums of this version of octray")?;
    let content = bytes.len().saturating_sub(HASH_BYTES);
    let (content, hash) = bytes.split_at(content);
    if blake3::hash(content).as_bytes() != hash {
        return Err("is cut short or damaged: its hash does not fit".into());
    }
    let rest = &rest[..rest.len() - HASH_BYTES];
    let line = rest.iter().position(|&byte| byte == b'\n').ok_or("has no header")?;
    let header = serde_json::from_slice(&rest[..line]).map_err(|error| format!("bad header: {error}"))?;
    Ok((header, &rest[line + 1..]))
}

fn words<'a>(body: &mut &'a [u8], count: usize) -> Result<impl Iterator<Item = u32> + use<'a>, String> {
    let (taken, rest) = body.split_at_checked(count * 4).ok_or("is shorter than its tiles")?;
    *body = rest;
    Ok(taken.as_chunks::<4>().0.iter().map(|bytes| u32::from_le_bytes(*bytes)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::Aov;

    fn empty() -> Part {
        let unit = Unit { number: 5, picture: 0, rect: [128, 0, 40, 33], samples: 0..48 };
        Part::new(unit, [Aov::Depth, Aov::ObjectId].into_iter().collect())
    }

    fn filled() -> Part {
        let mut part = empty();
        for tile in [0, 2] {
            let pixels = (part.tiles[tile][2] * part.tiles[tile][3]) as usize;
            let nodes = (0..2 * pixels).map(|i| [i as f32, f32::NAN, -0.0, 16.0]).collect();
            part.sums[tile] = Some(TileSums { nodes, aovs: (0..2 * pixels as u32).collect() });
        }
        part.nan_samples = 7;
        part
    }

    #[test]
    fn what_is_written_comes_back_bit_for_bit() {
        let bytes = filled().encode("plan");
        let back = empty().decode(&bytes, "plan").unwrap();
        assert_eq!((back.missing(), back.nan_samples), (vec![1, 3], 7));
        assert_eq!(back.encode("plan"), bytes);
    }

    #[test]
    fn every_cut_and_every_flipped_bit_is_noticed() {
        let bytes = filled().encode("plan");
        for length in (0..bytes.len()).step_by(97) {
            assert!(empty().decode(&bytes[..length], "plan").is_err(), "{length} bytes");
        }
        for at in (0..bytes.len()).step_by(89) {
            let mut damaged = bytes.clone();
            damaged[at] ^= 4;
            assert!(empty().decode(&damaged, "plan").is_err(), "byte {at}");
        }
    }

    #[test]
    fn files_of_other_plans_and_units_are_refused() {
        let bytes = filled().encode("plan");
        assert!(empty().decode(&bytes, "other").unwrap_err().contains("another plan"));
        let mut other = empty();
        other.unit.number = 6;
        assert!(other.decode(&bytes, "plan").unwrap_err().contains("unit 5, not 6"));
    }
}
