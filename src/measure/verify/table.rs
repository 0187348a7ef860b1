//! The report as a table for people.

use super::report::{FamilyReport, Report};
use crate::measure::bench::aligned;

const HEAD: [&str; 13] = [
    "family",
    "tier",
    "rays",
    "false miss",
    "false hit",
    "gross miss",
    "gross hit",
    "leak",
    "self-hit",
    "differ",
    "t p50",
    "t p99",
    "t max",
];

/// A row a family and tier: counts a million rays with the bound behind them, errors of `t` in ulps, and a verdict.
pub fn table(report: &Report) -> String {
    let mut head: Vec<String> = HEAD.map(String::from).to_vec();
    head.push("verdict".into());
    let rows: Vec<Vec<String>> = std::iter::once(head).chain(report.families.iter().map(row)).collect();
    format!(
        "{} rays a family and more, seed {}; a million rays, and in brackets the most that is promised; t in ulps of f32\n\n{}",
        report.rays,
        report.seed,
        aligned(&rows)
    )
}

fn row(family: &FamilyReport) -> Vec<String> {
    let mut cells = vec![family.family.clone(), family.tier.clone(), family.rays.to_string()];
    cells.extend(family.rates.iter().map(|rate| with_bound(number(rate.per_million), rate.bound)));
    match family.t_ulps {
        Some(t) => cells.extend([number(t.p50), with_bound(number(t.p99), t.p99_bound), number(t.max)]),
        None => cells.extend(["-"; 3].map(String::from)),
    }
    let promised = family.rates.iter().any(|rate| rate.bound.is_some());
    cells.push(
        match (family.holds, promised) {
            (false, _) => "BROKEN",
            (true, true) => "holds",
            (true, false) => "measured",
        }
        .into(),
    );
    cells
}

fn with_bound(text: String, bound: Option<f64>) -> String {
    bound.map_or(text.clone(), |bound| format!("{text} ({bound})"))
}

/// Whole numbers from ten on, three digits below.
fn number(x: f64) -> String {
    match x {
        0.0 => "0".into(),
        x if x < 10.0 => format!("{x:.3}"),
        x if x < 1e7 => format!("{x:.0}"),
        x => format!("{x:.1e}"),
    }
}
