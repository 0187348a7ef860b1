//! Records: what says that a unit is done.

use serde::{Deserialize, Serialize};

use super::assets::hash;

const FORMAT: &str = "octray record 2";

/// A unit is done, and these files hold it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Record {
    format: String,
    plan: String,
    unit: u64,
    /// Contributions that were left out because they were not numbers.
    pub(super) nan_samples: u64,
    pub(super) files: Vec<Kept>,
    /// BLAKE3 of everything above.
    blake3: String,
}

/// A file as it was written.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Kept {
    /// Below the output folder.
    pub(super) path: String,
    pub(super) size_bytes: u64,
    pub(super) blake3: String,
}

impl Kept {
    pub(super) fn of(path: String, bytes: &[u8]) -> Self {
        Self { path, size_bytes: bytes.len() as u64, blake3: hash(bytes) }
    }
}

impl Record {
    pub(super) fn new(plan: &str, unit: u64, nan_samples: u64, files: Vec<Kept>) -> Self {
        let blake3 = String::new();
        let record = Self { format: FORMAT.into(), plan: plan.into(), unit, nan_samples, files, blake3 };
        Self { blake3: record.seal(), ..record }
    }

    /// What `blake3` is to be.
    fn seal(&self) -> String {
        hash(&Self { blake3: String::new(), ..self.clone() }.to_bytes())
    }

    pub(super) fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = serde_json::to_vec_pretty(self).expect("a record has only text and numbers");
        bytes.push(b'\n');
        bytes
    }

    /// **Errors:** it is damaged, or of another plan or unit.
    pub(super) fn parse(bytes: &[u8], plan: &str, unit: u64) -> Result<Self, String> {
        let record: Self =
            serde_json::from_slice(bytes).map_err(|error| format!("is no whole record: {error}"))?;
        match record {
            record if record.format != FORMAT => Err(format!("has the format `{}`", record.format)),
            record if record.plan != plan => Err("belongs to another plan".into()),
            record if record.unit != unit => Err(format!("belongs to unit {}, not {unit}", record.unit)),
            record if record.blake3 != record.seal() => Err("is damaged: its hash does not fit".into()),
            record if record.files.is_empty() => Err("names no file".into()),
            record => Ok(record),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_whole_records_of_the_unit_count() {
        let record = Record::new("plan", 3, 5, vec![Kept::of("a.png".into(), b"abc")]);
        let bytes = record.to_bytes();
        assert_eq!(Record::parse(&bytes, "plan", 3), Ok(record));
        assert!(Record::parse(&bytes, "other", 3).unwrap_err().contains("another plan"));
        let empty = Record::new("plan", 3, 0, Vec::new()).to_bytes();
        assert!(Record::parse(&empty, "plan", 3).unwrap_err().contains("no file"));
        assert!(Record::parse(&bytes, "plan", 4).unwrap_err().contains("unit 3"));
        for at in 0..bytes.len() - 1 {
            let mut flipped = bytes.clone();
            flipped[at] ^= 1;
            let is_blank = bytes[at].is_ascii_whitespace() || flipped[at].is_ascii_whitespace();
            assert!(is_blank || Record::parse(&flipped, "plan", 3).is_err(), "byte {at}");
        }
        for length in 0..bytes.len() - 1 {
            assert!(Record::parse(&bytes[..length.min(bytes.len() - 2)], "plan", 3).is_err());
        }
    }
}
