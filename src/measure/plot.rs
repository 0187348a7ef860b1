//! What plots share: ranges in powers of ten, and short numbers.

use std::error::Error;
use std::ops::Range;

use plotters::coord::combinators::LogCoord;
use plotters::prelude::*;

pub(super) type Log = LogCoord<f64>;
pub(super) type Chart<'a> = ChartContext<'a, SVGBackend<'a>, Cartesian2d<Log, Log>>;

/// A chart with both axes in powers of ten.
pub(super) fn chart<'a>(
    area: &DrawingArea<SVGBackend<'a>, plotters::coord::Shift>,
    names: [&str; 2],
    spans: [Range<f64>; 2],
) -> Result<Chart<'a>, Box<dyn Error>> {
    let [x, y] = spans;
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(70)
        .build_cartesian_2d(x.log_scale(), y.log_scale())?;
    let mut mesh = chart.configure_mesh();
    mesh.x_desc(names[0]).y_desc(names[1]).light_line_style(RGBColor(240, 240, 240));
    mesh.label_style(("sans-serif", 13)).axis_desc_style(("sans-serif", 15));
    mesh.x_label_formatter(&label).y_label_formatter(&label).draw()?;
    Ok(chart)
}

/// Names of the series in a corner.
pub(super) fn legend(chart: &mut Chart, corner: SeriesLabelPosition) -> Result<(), Box<dyn Error>> {
    let mut labels = chart.configure_series_labels();
    labels.position(corner).label_font(("sans-serif", 13));
    Ok(labels.background_style(WHITE.mix(0.85)).border_style(RGBColor(200, 200, 200)).draw()?)
}

/// A range around values with some room, in powers of ten.
pub(super) fn range(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(low, high), x| (low.min(x), high.max(x)));
    if low > high { 0.1..1.0 } else { low / 1.4..high * 1.4 }
}

/// The whole powers of ten around values: an axis over less than one would have no numbers.
pub(super) fn decades(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(low, high), x| (low.min(x), high.max(x)));
    if low > high {
        0.1..1.0
    } else {
        10.0_f64.powf(low.log10().floor())..10.0_f64.powf(high.log10().floor() + 1.0)
    }
}

/// A number as short as it can be said.
fn label(value: &f64) -> String {
    // Ticks are multiples of powers of ten, give or take a rounding.
    let rounded = (value * 1e6).round() / 1e6;
    if (0.001..100_000.0).contains(value) { rounded.to_string() } else { format!("{value:.0e}") }
}
