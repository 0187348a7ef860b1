//! What can be chosen by name.

use clap::ValueEnum;

use crate::accel::Quality;
use crate::intersect::TierName;

/// How exactly rays are intersected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Tier {
    /// Quickest; may lose rays between triangles
    Fast,
    /// No ray is lost between triangles; the same picture everywhere
    Watertight,
    /// Double precision
    Exact,
}

/// How much work goes into building the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BuildQuality {
    /// Soonest built: for few rays
    Fast,
    /// Good for most scenes
    Balanced,
    /// Also cuts triangles where they overlap: for many rays
    High,
}

impl BuildQuality {
    /// As it is written in a scene file.
    pub(super) fn assignment(self) -> Option<String> {
        self.to_possible_value().map(|value| format!("\"{}\"", value.get_name()))
    }
}

impl From<BuildQuality> for Quality {
    fn from(quality: BuildQuality) -> Self {
        match quality {
            BuildQuality::Fast => Self::Fast,
            BuildQuality::Balanced => Self::Balanced,
            BuildQuality::High => Self::High,
        }
    }
}

impl From<Tier> for TierName {
    fn from(tier: Tier) -> Self {
        match tier {
            Tier::Fast => Self::Fast,
            Tier::Watertight => Self::Watertight,
            Tier::Exact => Self::Exact,
        }
    }
}

/// How progress is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ProgressMode {
    /// A bar on a terminal, else lines
    Auto,
    /// A bar
    Bar,
    /// A line every tenth or every 30 seconds
    Plain,
    /// One JSON object a line; the last is `done` or `failed`
    Json,
    /// Nothing
    None,
}
