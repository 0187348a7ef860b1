//! How progress looks: a bar, lines, JSON objects or nothing.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use crate::cli::ProgressMode;
use crate::cli::rhythm::Rhythm;

/// How progress looks.
pub(super) enum Style {
    Bar(ProgressBar),
    Plain,
    Json,
    Silent,
}

impl Style {
    /// How often it shows something new.
    pub(super) fn rhythm(&self) -> Rhythm {
        match self {
            Self::Bar(_) => Rhythm::every(Duration::from_millis(100)),
            Self::Json => Rhythm::every(Duration::from_millis(500)),
            Self::Plain | Self::Silent => Rhythm::by_tenths(),
        }
    }
}

/// The style of a mode, on a terminal or not.
pub(super) fn style(mode: ProgressMode, quiet: bool, terminal: bool) -> Style {
    match mode {
        ProgressMode::None => Style::Silent,
        ProgressMode::Auto if quiet => Style::Silent,
        ProgressMode::Auto | ProgressMode::Bar if terminal => Style::Bar(bar()),
        ProgressMode::Json => Style::Json,
        ProgressMode::Auto | ProgressMode::Bar | ProgressMode::Plain => Style::Plain,
    }
}

fn bar() -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:32} {percent:>3} %, {msg}").unwrap();
    ProgressBar::new(0).with_style(style.progress_chars("=> "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_choose_their_style() {
        let name = |mode, quiet, terminal| match style(mode, quiet, terminal) {
            Style::Bar(_) => "bar",
            Style::Plain => "plain",
            Style::Json => "json",
            Style::Silent => "silent",
        };
        assert_eq!(name(ProgressMode::Auto, false, true), "bar");
        assert_eq!(name(ProgressMode::Auto, false, false), "plain");
        assert_eq!(name(ProgressMode::Auto, true, true), "silent");
        assert_eq!(name(ProgressMode::Bar, false, false), "plain");
        assert_eq!(name(ProgressMode::Json, true, true), "json");
        assert_eq!(name(ProgressMode::None, false, true), "silent");
    }
}
