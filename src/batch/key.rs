//! Keys of a job, each in one spelling: `--set` takes them with blanks around their names, and so a key could stand in a job
//! twice without being noticed.

use std::collections::BTreeMap;

use serde::Deserialize;
use serde::de::{Deserializer, Error};

/// A key without blanks around its names.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Key(String);

impl<'de> Deserialize<'de> for Key {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let key = String::deserialize(deserializer)?;
        let plain = key.split('.').map(str::trim).collect::<Vec<_>>().join(".");
        match key == plain {
            true => Ok(Self(key)),
            false => Err(D::Error::custom(format!("blanks in the key `{key}`: expected `{plain}`"))),
        }
    }
}

/// One key.
pub(super) fn one<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    Key::deserialize(deserializer).map(|key| key.0)
}

/// Values by their keys.
pub(super) fn map<'de, D, V>(deserializer: D) -> Result<BTreeMap<String, V>, D::Error>
where
    D: Deserializer<'de>,
    V: Deserialize<'de>,
{
    let values = BTreeMap::<Key, V>::deserialize(deserializer)?;
    Ok(values.into_iter().map(|(key, value)| (key.0, value)).collect())
}
