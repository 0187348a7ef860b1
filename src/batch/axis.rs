//! Sweeps: values of one axis, and how axes meet.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;
use toml::Value;

use crate::describe::exact;

/// Most pictures of a job: what a plan of some hundred megabytes holds.
pub(super) const MOST_PICTURES: usize = 1_000_000;

/// The values of one axis of a sweep.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Sweep {
    /// These.
    List(#[schemars(with = "Vec<serde_json::Value>", length(min = 1))] Vec<Value>),
    /// First and end, which is left out, and perhaps a step: as Python's `range`.
    Range(#[schemars(with = "Vec<f64>", length(min = 2, max = 3))] Vec<Value>),
    /// First, last and how many, evenly spread.
    #[serde(deserialize_with = "exact::read")]
    Linspace([f64; 3]),
}

/// How the axes of a sweep meet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SweepMode {
    /// Every value of one with every value of the others; the last axis changes fastest.
    #[default]
    Product,
    /// The first values together, the second ones together; all axes are equally long.
    Zip,
}

/// One picture's choice: a key and its value for each axis.
pub(super) type Choice = Vec<(String, Value)>;

/// All choices of a sweep; one without values where there is no axis.
pub(super) fn choices(axes: &BTreeMap<String, Sweep>, mode: SweepMode) -> Result<Vec<Choice>, String> {
    let mut columns = Vec::new();
    for (key, sweep) in axes {
        let values = values(sweep).map_err(|reason| format!("sweep `{key}`: {reason}"))?;
        columns.push((key, values));
    }
    match mode {
        SweepMode::Zip if !columns.is_empty() => zip(&columns),
        _ => product(&columns),
    }
}

fn product(columns: &[(&String, Vec<Value>)]) -> Result<Vec<Choice>, String> {
    let count = columns.iter().try_fold(1usize, |count, (_, values)| count.checked_mul(values.len()));
    if count.is_none_or(|count| count > MOST_PICTURES) {
        return Err(format!("the sweep makes more than {MOST_PICTURES} pictures"));
    }
    let mut choices: Vec<Choice> = vec![Vec::new()];
    for (key, values) in columns {
        let with = |choice: &Choice, value: &Value| {
            choice.iter().cloned().chain([((*key).clone(), value.clone())]).collect::<Choice>()
        };
        choices = choices.iter().flat_map(|c| values.iter().map(move |v| with(c, v))).collect();
    }
    Ok(choices)
}

fn zip(columns: &[(&String, Vec<Value>)]) -> Result<Vec<Choice>, String> {
    let length = columns[0].1.len();
    if let Some((key, values)) = columns.iter().find(|(_, values)| values.len() != length) {
        let (first, other) = (columns[0].0, values.len());
        return Err(format!(
            "sweep `{key}` has {other} values and `{first}` {length}: to zip them they must agree"
        ));
    }
    let choice = |i: usize| columns.iter().map(|(key, values)| ((*key).clone(), values[i].clone())).collect();
    Ok((0..length).map(choice).collect())
}

fn values(sweep: &Sweep) -> Result<Vec<Value>, String> {
    let values = match sweep {
        Sweep::List(values) => values.clone(),
        Sweep::Range(bounds) => range(bounds)?,
        Sweep::Linspace([first, last, count]) => linspace(*first, *last, *count)?,
    };
    if values.is_empty() { Err("has no values".into()) } else { Ok(values) }
}

fn linspace(first: f64, last: f64, count: f64) -> Result<Vec<Value>, String> {
    if count.fract() != 0.0 || !(1.0..=MOST_PICTURES as f64).contains(&count) {
        return Err(format!("linspace is [first, last, how many], and {count} is no number of values"));
    }
    let steps = (count - 1.0).max(1.0);
    // The last value is the one written, not one that rounding made of it.
    let at = |k: usize| {
        if k > 0 && k as f64 == steps { last } else { first + (last - first) * (k as f64 / steps) }
    };
    Ok((0..count as usize).map(|k| Value::Float(at(k))).collect())
}

fn range(bounds: &[Value]) -> Result<Vec<Value>, String> {
    let usage = || "range is [first, end] or [first, end, step] of numbers, the end left out".to_owned();
    let (first, end, step) = match bounds {
        [first, end] => (first, end, &Value::Integer(1)),
        [first, end, step] => (first, end, step),
        _ => return Err(usage()),
    };
    if let [Some(a), Some(b), Some(s)] = [first, end, step].map(Value::as_integer) {
        return whole(a, b, s);
    }
    let number = |value: &Value| value.as_float().or(value.as_integer().map(|i| i as f64)).ok_or_else(usage);
    let (a, b, s) = (number(first)?, number(end)?, number(step)?);
    let count = ((b - a) / s).ceil();
    if s == 0.0 || !count.is_finite() || count > MOST_PICTURES as f64 {
        return Err(format!("the step {s} does not lead from {a} to {b} within {MOST_PICTURES} values"));
    }
    Ok((0..count.max(0.0) as u64).map(|k| Value::Float(a + k as f64 * s)).collect())
}

/// In whole numbers of any size, which floating point would round.
fn whole(a: i64, b: i64, s: i64) -> Result<Vec<Value>, String> {
    let [length, step] = [i128::from(b) - i128::from(a), i128::from(s)];
    let count = if step == 0 { i128::MAX } else { (length + step - step.signum()) / step };
    if count > MOST_PICTURES as i128 {
        return Err(format!("the step {s} does not lead from {a} to {b} within {MOST_PICTURES} values"));
    }
    Ok((0..count.max(0) as i64).map(|k| Value::Integer(a + k * s)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sweep(text: &str) -> Result<Vec<String>, String> {
        let sweep: BTreeMap<String, Sweep> = toml::from_str(text).unwrap();
        let all = choices(&sweep, SweepMode::Product)?;
        let text = |c: &Choice| c.iter().map(|(_, v)| v.to_string()).collect::<Vec<_>>().join(" ");
        Ok(all.iter().map(text).collect())
    }

    #[test]
    fn axes_give_their_values() {
        assert_eq!(sweep("a = { linspace = [30, 60, 4] }").unwrap(), ["30.0", "40.0", "50.0", "60.0"]);
        assert_eq!(sweep("a = { linspace = [1, 9, 1] }").unwrap(), ["1.0"]);
        assert_eq!(sweep("a = { range = [0, 5, 2] }").unwrap(), ["0", "2", "4"]);
        assert_eq!(sweep("a = { range = [1, 0, -0.5] }").unwrap(), ["1.0", "0.5"]);
        assert_eq!(sweep("a = { range = [5, 0, -2] }").unwrap(), ["5", "3", "1"]);
        assert_eq!(sweep("a = { range = [4, 0, -2] }").unwrap(), ["4", "2"]);
        let large = "a = { range = [9007199254740993, 9007199254740995] }";
        assert_eq!(sweep(large).unwrap(), ["9007199254740993", "9007199254740994"]);
        assert_eq!(sweep("a = { list = ['x', [1, 2]] }").unwrap(), ["\"x\"", "[1, 2]"]);
        assert_eq!(sweep("").unwrap(), [""]);
    }

    #[test]
    fn the_last_axis_changes_fastest() {
        let found = sweep("b = { list = [1, 2] }\na = { list = [3, 4] }").unwrap();
        assert_eq!(found, ["3 1", "3 2", "4 1", "4 2"], "axes in the order of their names");
    }

    #[test]
    fn zipped_axes_go_together_or_are_refused() {
        let axes = |text: &str| choices(&toml::from_str(text).unwrap(), SweepMode::Zip);
        let found = axes("a = { list = [1, 2] }\nb = { list = [3, 4] }").unwrap();
        assert_eq!(found[1].iter().map(|(_, v)| v.to_string()).collect::<Vec<_>>(), ["2", "4"]);
        assert!(axes("a = { list = [1] }\nb = { list = [3, 4] }").unwrap_err().contains("`b` has 2"));
    }

    #[test]
    fn bad_axes_are_named() {
        for text in [
            "a = { list = [] }",
            "a = { range = [0, 1, 0] }",
            "a = { range = [0.0, 1, 0] }",
            "a = { range = [0, -1] }",
            "a = { range = [0, 'x'] }",
            "a = { range = [-9223372036854775807, 9223372036854775807] }",
        ] {
            assert!(sweep(text).unwrap_err().contains("`a`"), "{text}");
        }
        assert!(sweep("a = { linspace = [0, 1, 1.5] }").unwrap_err().contains("1.5"));
    }
}
