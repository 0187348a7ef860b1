//! Errors over times as SVG.

use std::error::Error;
use std::ops::Range;

use plotters::coord::combinators::LogCoord;
use plotters::prelude::*;

use super::report::{Report, Row};
use crate::intersect::TierName;

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
const FRONT: Group = ("nothing beats it", RGBColor(210, 30, 30), |row| row.on_front);

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
        let spans = (range(points.iter().map(|p| p.0)), range(points.iter().map(|p| p.1)));
        let mut chart = ChartBuilder::on(&area)
            .margin(12)
            .x_label_area_size(44)
            .y_label_area_size(70)
            .build_cartesian_2d(spans.0.log_scale(), spans.1.log_scale())?;
        axes(&mut chart, name)?;
        let front = report.rows.iter().zip(&points).filter(|(row, _)| row.on_front).map(|(_, p)| *p);
        chart.draw_series(LineSeries::new(front, FRONT.1.mix(0.5)))?;
        for group in GROUPS.iter().chain([&FRONT]) {
            let inside = report.rows.iter().zip(&points).filter(|(row, _)| group.2(row)).map(|(_, p)| *p);
            dots(&mut chart, group, inside.collect())?;
        }
        legend(&mut chart)?;
        area.present()?;
    }
    Ok(svg)
}

type Log = LogCoord<f64>;
type Chart<'a> = ChartContext<'a, SVGBackend<'a>, Cartesian2d<Log, Log>>;

fn axes(chart: &mut Chart, name: &str) -> Result<(), Box<dyn Error>> {
    let mut mesh = chart.configure_mesh();
    mesh.x_desc("time in ms, median").y_desc(name).light_line_style(RGBColor(240, 240, 240));
    mesh.label_style(("sans-serif", 13)).axis_desc_style(("sans-serif", 15));
    Ok(mesh.x_label_formatter(&label).y_label_formatter(&label).draw()?)
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

fn legend(chart: &mut Chart) -> Result<(), Box<dyn Error>> {
    let mut labels = chart.configure_series_labels();
    labels.position(SeriesLabelPosition::LowerLeft).label_font(("sans-serif", 13));
    Ok(labels.background_style(WHITE.mix(0.85)).border_style(RGBColor(200, 200, 200)).draw()?)
}

/// A range around values with some room, in powers of ten.
fn range(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(low, high), x| (low.min(x), high.max(x)));
    if low > high { 0.1..1.0 } else { low / 1.4..high * 1.4 }
}

/// A number as short as it can be said.
fn label(value: &f64) -> String {
    // Ticks are multiples of powers of ten, give or take a rounding.
    let rounded = (value * 1e6).round() / 1e6;
    if (0.001..100_000.0).contains(value) { rounded.to_string() } else { format!("{value:.0e}") }
}
