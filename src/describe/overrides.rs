//! `--set key=value`: changes the parsed file before it gets its types, so that every later check sees the change.

use super::check::nearest;
use std::borrow::Cow;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

/// What is wrong with a `--set`, and what may have been meant.
#[derive(Debug)]
pub(super) struct SetError {
    pub(super) message: String,
    pub(super) help: Option<String>,
}

impl SetError {
    fn new(message: impl Into<String>) -> SetError {
        SetError { message: message.into(), help: None }
    }
}

/// Applies one `key=value`; `offset` is the place of the argument among the sources.
///
/// Keys are joined by dots. An element of an array is named by its place from 0 (`sphere.0.radius`) or by its name
/// (`material.glass.ior`). A value that is not TOML is taken as a string (`render.tier=exact`). A key that is missing
/// is added; whether it may exist is checked afterwards, with the types.
pub(super) fn apply<'a>(
    root: &mut Spanned<DeTable<'a>>,
    argument: &'a str,
    offset: usize,
) -> Result<(), SetError> {
    let (key, value) = argument.split_once('=').ok_or_else(|| SetError::new("needs the form key=value"))?;
    let parts: Vec<&str> = key.trim().split('.').map(str::trim).collect();
    if parts.iter().any(|part| part.is_empty()) {
        return Err(SetError::new(format!("`{key}` is not a key: names joined by dots are")));
    }
    let value = parse_value(value, offset + key.len() + 1);
    let mut writer = Writer { offset, length: argument.len(), parts: &parts };
    writer.write_table(root.get_mut(), 0, value)
}

/// The value as TOML, or as a string when it is none.
fn parse_value(text: &str, offset: usize) -> Spanned<DeValue<'_>> {
    match DeValue::parse(text.trim()) {
        Ok(value) => shift(value, offset + (text.len() - text.trim_start().len())),
        Err(_) => Spanned::new(offset..offset + text.len(), DeValue::String(Cow::Borrowed(text.trim()))),
    }
}

/// The value with all places moved by `offset`.
fn shift<'a>(value: Spanned<DeValue<'a>>, offset: usize) -> Spanned<DeValue<'a>> {
    let span = value.span();
    let inner = match value.into_inner() {
        DeValue::Array(array) => DeValue::Array(array.into_iter().map(|v| shift(v, offset)).collect()),
        DeValue::Table(table) => DeValue::Table(shift_table(table, offset)),
        plain => plain,
    };
    Spanned::new(span.start + offset..span.end + offset, inner)
}

fn shift_table<'a>(table: DeTable<'a>, offset: usize) -> DeTable<'a> {
    let mut shifted = DeTable::new();
    for (key, value) in table {
        let span = key.span().start + offset..key.span().end + offset;
        shifted.insert(Spanned::new(span, key.into_inner()), shift(value, offset));
    }
    shifted
}

/// Walks down the keys of one argument.
struct Writer<'p, 'a> {
    offset: usize,
    length: usize,
    parts: &'p [&'a str],
}

impl<'a> Writer<'_, 'a> {
    fn write_table(
        &mut self,
        table: &mut DeTable<'a>,
        depth: usize,
        value: Spanned<DeValue<'a>>,
    ) -> Result<(), SetError> {
        let part = self.parts[depth];
        if depth + 1 == self.parts.len() {
            table.insert(self.key(part), value);
            return Ok(());
        }
        if table.get(part).is_none() {
            if self.parts[depth + 1].parse::<usize>().is_ok() {
                let asked = self.parts[..depth + 2].join(".");
                return Err(SetError::new(format!("there is no `{asked}`: the scene has no `{part}`")));
            }
            table.insert(self.key(part), Spanned::new(self.span(), DeValue::Table(DeTable::new())));
        }
        let inner = table.get_mut(part).expect("present or just inserted");
        self.write(inner.get_mut(), depth + 1, value)
    }

    fn write(
        &mut self,
        into: &mut DeValue<'a>,
        depth: usize,
        value: Spanned<DeValue<'a>>,
    ) -> Result<(), SetError> {
        match into {
            DeValue::Table(table) => self.write_table(table, depth, value),
            DeValue::Array(array) => {
                let index = self.find(array, depth)?;
                let element = array.get_mut(index).expect("found just now");
                if depth + 1 == self.parts.len() {
                    *element = value;
                    return Ok(());
                }
                self.write(element.get_mut(), depth + 1, value)
            }
            other => Err(SetError::new(format!(
                "`{}` has no `{}` inside: it is of type {}",
                self.parts[..depth].join("."),
                self.parts[depth],
                other.type_str()
            ))),
        }
    }

    /// The place in an array that a part means: a number, or the `name` of an element.
    fn find(&self, array: &DeArray<'a>, depth: usize) -> Result<usize, SetError> {
        let (part, path) = (self.parts[depth], self.parts[..depth].join("."));
        let names: Vec<Option<&str>> = array.iter().map(|element| name_of(element.get_ref())).collect();
        if let Some(index) = names.iter().position(|name| *name == Some(part)) {
            return Ok(index);
        }
        match part.parse::<usize>() {
            Ok(index) if index < array.len() => Ok(index),
            Ok(_) => Err(SetError::new(format!("`{path}` has {} elements, counted from 0", array.len()))),
            Err(_) => {
                let near = nearest(part, names.iter().copied().flatten());
                let help = near.map(|near| format!("did you mean `{path}.{near}`?"));
                Err(SetError { message: format!("`{path}` has no element named `{part}`"), help })
            }
        }
    }

    fn key(&self, part: &'a str) -> Spanned<Cow<'a, str>> {
        Spanned::new(self.span(), Cow::Borrowed(part))
    }

    fn span(&self) -> std::ops::Range<usize> {
        self.offset..self.offset + self.length
    }
}

fn name_of<'v>(value: &'v DeValue<'_>) -> Option<&'v str> {
    value.as_table().and_then(|table| table.get("name")).and_then(|name| name.get_ref().as_str())
}
