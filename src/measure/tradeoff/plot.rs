//! Errors over times as SVG.

use std::error::Error;

use plotters::prelude::*;

use super::report::{Report, Row};
use crate::intersect::TierName;
use crate::measure::plot::{Chart, chart, legend, range};

/// Width and height of a plot in units of SVG.
const SIZE: (u32, u32) = (760, 470);

/// What rows are told apart by: a name, a colour, and which rows.
type Group = (&'static str, RGBColor, fn(&Row) -> bool);

const GROUPS: [Group; 9] = [
    ("fast", RGBColor(230, 119, 0), |row| of_tier(row, TierName::Fast)),
    ("watertight", RGBColor(28, 100, 200), |row| of_tier(row, TierName::Watertight)),
    ("exact", RGBColor(20, 20, 20), |row| of_tier(row, TierName::Exact)),
    ("sampler", RGBColor(190, 30, 130), |row| row.change == Some("sampler")),
    ("depth", RGBColor(30, 140, 60), |row| row.change == Some("depth")),
    ("cutoff", RGBColor(140, 90, 40), |row| row.change == Some("cutoff")),
    ("size", RGBColor(110, 70, 190), |row| row.change == Some("size")),
    ("shadows", RGBColor(90, 90, 90), |row| row.change == Some("shadows")),
    ("bounce", RGBColor(0, 150, 160), |row| row.change == Some("bounce")),
];
const FRONT: Group = ("nothing beats its RMSE", RGBColor(210, 30, 30), |row| row.on_front);

fn of_tier(row: &Row, tier: TierName) -> bool {
    row.change.is_none() && row.setting.tier == tier
}

/// An error of all rows over their times, both in powers of ten, as an SVG element.
///
/// **Errors:** what plotters says.
pub(super) fn plot(report: &Report, name: &str, error: fn(&Row) -> f64) -> Result<String, Box<dyn Error>> {
    // The logarithm of no error lies below all others.
    let least = report.rows.iter().map(error).filter(|x| *x > 0.0).fold(1.0, f64::min) / 2.0;
    let point = |row: &Row| (row.times.median_s * 1e3, error(row).max(least));
    let points: Vec<(f64, f64)> = report.rows.iter().map(point).collect();
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        let spans = [range(points.iter().map(|p| p.0)), range(points.iter().map(|p| p.1))];
        let mut chart = chart(&area, ["time in ms, median", name], spans)?;
        let front = report.rows.iter().zip(&points).filter(|(row, _)| row.on_front).map(|(_, p)| *p);
        chart.draw_series(LineSeries::new(front, FRONT.1.mix(0.5)))?;
        for group in GROUPS.iter().chain([&FRONT]) {
            let inside = report.rows.iter().zip(&points).filter(|(row, _)| group.2(row)).map(|(_, p)| *p);
            dots(&mut chart, group, inside.collect())?;
        }
        legend(&mut chart, SeriesLabelPosition::LowerLeft)?;
        area.present()?;
    }
    Ok(svg)
}

fn dots(chart: &mut Chart, group: &Group, points: Vec<(f64, f64)>) -> Result<(), Box<dyn Error>> {
    let (name, color, _) = *group;
    if points.is_empty() {
        return Ok(());
    }
    let (size, style) = if name == FRONT.0 { (7, color.stroke_width(2)) } else { (4, color.filled()) };
    let series = chart.draw_series(points.into_iter().map(|p| Circle::new(p, size, style)))?;
    series.label(name).legend(move |(x, y)| Circle::new((x + 10, y), size.min(5), style));
    Ok(())
}
