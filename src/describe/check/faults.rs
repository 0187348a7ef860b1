//! Collects faults while walking down a description, and the small rules about numbers.

use std::fmt;

/// Coordinates and lengths stay below this, so that their squares fit into single precision.
const LARGEST: f64 = 1e18;
/// Lengths stay above this, so that their squares do not vanish in single precision.
const SMALLEST: f64 = 1e-18;
/// More faults than this help nobody.
const MOST_FAULTS: usize = 50;

/// One thing wrong in a description.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    pub(crate) path: Vec<PathPart>,
    /// What is wrong.
    pub message: String,
    /// What may have been meant.
    pub help: Option<String>,
}

/// One step down a description: a key, or the place in an array.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PathPart {
    /// A key of a table.
    Key(&'static str),
    /// A place in an array, from 0.
    Index(usize),
}

impl Fault {
    /// The path of the key, as `--set` takes it: `sphere.3.radius`.
    #[must_use]
    pub fn path(&self) -> String {
        let parts = self.path.iter().map(|part| match part {
            PathPart::Key(key) => (*key).to_owned(),
            PathPart::Index(index) => index.to_string(),
        });
        parts.collect::<Vec<_>>().join(".")
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path(), self.message)?;
        self.help.as_ref().map_or(Ok(()), |help| write!(f, " ({help})"))
    }
}

/// The faults so far and where the walk stands.
#[derive(Debug, Default)]
pub(super) struct Faults {
    path: Vec<PathPart>,
    list: Vec<Fault>,
}

impl Faults {
    pub(super) fn into_result(self) -> Result<(), Vec<Fault>> {
        if self.list.is_empty() { Ok(()) } else { Err(self.list) }
    }

    /// Walks into a key for the time of `inside`.
    pub(super) fn at<T>(&mut self, key: &'static str, inside: impl FnOnce(&mut Faults) -> T) -> T {
        self.within(PathPart::Key(key), inside)
    }

    /// Walks into each element of an array.
    pub(super) fn each<T>(&mut self, key: &'static str, items: &[T], inside: impl Fn(&mut Faults, &T)) {
        self.at(key, |f| {
            for (i, item) in items.iter().enumerate() {
                f.within(PathPart::Index(i), |f| inside(f, item));
            }
        });
    }

    /// Walks into one element of an array.
    pub(super) fn nth(&mut self, key: &'static str, index: usize, inside: impl FnOnce(&mut Faults)) {
        self.at(key, |f| f.within(PathPart::Index(index), inside));
    }

    fn within<T>(&mut self, part: PathPart, inside: impl FnOnce(&mut Faults) -> T) -> T {
        self.path.push(part);
        let result = inside(self);
        self.path.pop();
        result
    }

    /// A fault of the table or element the walk is in.
    pub(super) fn add(&mut self, message: impl Into<String>) {
        self.add_with_help(message, None);
    }

    pub(super) fn add_with_help(&mut self, message: impl Into<String>, help: Option<String>) {
        if self.list.len() < MOST_FAULTS {
            self.list.push(Fault { path: self.path.clone(), message: message.into(), help });
        }
    }

    /// A fault of one key, whose name becomes the first word of the message.
    pub(super) fn add_at(&mut self, key: &'static str, message: impl fmt::Display) {
        self.at(key, |f| f.add(format!("`{key}` {message}")));
    }

    pub(super) fn require(&mut self, key: &'static str, holds: bool, message: &str) {
        if !holds {
            self.add_at(key, message);
        }
    }

    /// Coordinates: finite and small enough. Says whether they are.
    pub(super) fn point(&mut self, key: &'static str, value: &[f64]) -> bool {
        let bad = value.iter().find(|x| !x.is_finite() || x.abs() > LARGEST);
        if let Some(x) = bad {
            self.add_at(key, format!("has no place for {x}: numbers must lie between -1e18 and 1e18"));
        }
        bad.is_none()
    }

    /// A length above zero.
    pub(super) fn length(&mut self, key: &'static str, value: f64) {
        if !(SMALLEST..=LARGEST).contains(&value) {
            self.add_at(key, format!("must be above 0 (1e-18 to 1e18), is {value}"));
        }
    }

    /// A vector that has a direction.
    pub(super) fn direction(&mut self, key: &'static str, value: &[f64; 3]) {
        if self.point(key, value) && largest(value) < SMALLEST {
            self.add_at(key, "has no direction: its length is 0");
        }
    }

    /// A number that is finite and lies between two bounds, both allowed.
    pub(super) fn between(&mut self, key: &'static str, value: f64, low: f64, high: f64) {
        if !(low..=high).contains(&value) {
            self.add_at(key, format!("must be between {low} and {high}, is {value}"));
        }
    }

    /// A coefficient or intensity: not negative, finite.
    pub(super) fn not_negative(&mut self, key: &'static str, value: &[f64]) {
        if let Some(x) = value.iter().find(|x| !(0.0..=LARGEST).contains(*x)) {
            self.add_at(key, format!("must not be negative and at most 1e18, is {x}"));
        }
    }
}

/// The largest absolute value of three.
pub(super) fn largest(v: &[f64; 3]) -> f64 {
    v.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

/// The candidate nearest to a misspelt word, if one is near enough to be meant.
pub(crate) fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let scored = candidates.into_iter().map(|c| (strsim::damerau_levenshtein(word, c), c));
    let extends = |c: &str| c.starts_with(word) || word.starts_with(c);
    scored.filter(|(d, c)| *d <= 1 + c.len() / 3 || extends(c)).min_by_key(|(d, _)| *d).map(|(_, c)| c)
}
