//! Finds the place in the text for an offset or for the path of a key.

use super::check::PathPart;
use super::{Diagnostic, Fault, Origin};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A scene file and the `--set` arguments that change it.
///
/// Offsets up to the length of the text are places in the file. Behind it the `--set` arguments follow, each after a
/// gap of one, so that one number tells where anything was written.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sources<'a> {
    pub(super) name: &'a str,
    pub(super) text: &'a str,
    pub(super) sets: &'a [String],
}

impl<'a> Sources<'a> {
    /// Each `--set` argument with the offset of its first byte.
    pub(super) fn sets(&self) -> impl Iterator<Item = (usize, &'a str)> {
        let mut offset = self.text.len() + 1;
        self.sets.iter().map(move |set| {
            let start = offset;
            offset += set.len() + 1;
            (start, set.as_str())
        })
    }

    /// The diagnostic of a message about the place at `offset`.
    pub(super) fn diagnose(&self, offset: usize, message: String, help: Option<String>) -> Diagnostic {
        let set = self.sets().find(|(start, set)| (*start..=start + set.len()).contains(&offset));
        let (origin, text, offset) = match set {
            Some((start, set)) => (Origin::Set(set.to_owned()), set, offset - start),
            None => (Origin::File(self.name.to_owned()), self.text, offset.min(self.text.len())),
        };
        let (line, column, source_line) = line_and_column(text, offset);
        Diagnostic { origin, line, column, source_line: source_line.to_owned(), message, help }
    }

    /// The diagnostic of a fault, at its key, or at the nearest table around it that was written.
    pub(super) fn diagnose_fault(&self, root: &Spanned<DeTable<'_>>, fault: Fault) -> Diagnostic {
        let span = span_of(root, &fault.path);
        self.diagnose(span.start, fault.message, fault.help)
    }
}

fn line_and_column(text: &str, offset: usize) -> (usize, usize, &str) {
    let before = text.get(..offset).unwrap_or(text);
    let start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let line = before.bytes().filter(|&b| b == b'\n').count() + 1;
    let source_line = text[start..].lines().next().unwrap_or_default();
    (line, before[start..].chars().count() + 1, source_line)
}

fn span_of(root: &Spanned<DeTable<'_>>, path: &[PathPart]) -> Range<usize> {
    let mut span = 0..0;
    let Some((PathPart::Key(first), rest)) = path.split_first() else { return span };
    let Some(mut value) = root.get_ref().get(*first) else { return span };
    span = value.span();
    for part in rest {
        let inner = match (part, value.get_ref()) {
            (PathPart::Key(key), DeValue::Table(table)) => table.get(*key),
            (PathPart::Index(index), DeValue::Array(array)) => array.get(*index),
            _ => None,
        };
        let Some(inner) = inner else { break };
        value = inner;
        // Tables made by dotted keys and `[[a.b]]` headers may have no place of their own.
        span = if inner.span().is_empty() { span } else { inner.span() };
    }
    span
}
