//! What plots share: ranges in powers of ten, and short numbers.

use std::error::Error;
use std::ops::Range;

use plotters::coord::combinators::{BindKeyPoints, LogCoord, WithKeyPoints};
use plotters::prelude::*;

pub(super) type Log = WithKeyPoints<LogCoord<f64>>;
pub(super) type Chart<'a> = ChartContext<'a, SVGBackend<'a>, Cartesian2d<Log, Log>>;

/// A chart with both axes in powers of ten.
pub(super) fn chart<'a>(
    area: &DrawingArea<SVGBackend<'a>, plotters::coord::Shift>,
    names: [&str; 2],
    spans: [Range<f64>; 2],
) -> Result<Chart<'a>, Box<dyn Error>> {
    let [x, y] = spans.map(axis);
    let mut chart = ChartBuilder::on(area)
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(70)
        .build_cartesian_2d(x, y)?;
    let mut mesh = chart.configure_mesh();
    mesh.x_desc(names[0]).y_desc(names[1]).light_line_style(RGBColor(240, 240, 240));
    mesh.label_style(("sans-serif", 13)).axis_desc_style(("sans-serif", 15));
    mesh.x_label_formatter(&label).y_label_formatter(&label).draw()?;
    Ok(chart)
}

/// An axis in powers of ten with numbers where [`ticks`] says, and light lines at all multiples.
fn axis(span: Range<f64>) -> Log {
    let (numbers, lines) = (ticks(&span), multiples(&span, &[1, 2, 3, 4, 5, 6, 7, 8, 9]));
    span.log_scale().with_key_points(numbers).with_light_points(lines)
}

/// Where numbers stand at an axis: few enough that they do not touch, two at least unless the span is tiny.
fn ticks(span: &Range<f64>) -> Vec<f64> {
    let choices: [&[u32]; 3] = [&[1], &[1, 2, 5], &[1, 2, 3, 4, 5, 6, 7, 8, 9]];
    let [few, some, all] = choices.map(|of| multiples(span, of));
    if few.len() > 3 {
        few
    } else if some.len() > 1 {
        some
    } else {
        all
    }
}

/// Multiples of powers of ten within a span.
fn multiples(span: &Range<f64>, of: &[u32]) -> Vec<f64> {
    let powers = span.start.log10().floor() as i32..=span.end.log10().ceil() as i32;
    let all = powers.flat_map(|power| of.iter().map(move |&n| f64::from(n) * 10f64.powi(power)));
    all.filter(|x| span.contains(x)).collect()
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

#[cfg(test)]
mod tests {
    use super::*;

    /// As they are written: a crowd of numbers cannot be read, one alone gives no scale.
    #[test]
    fn an_axis_has_some_numbers_but_no_crowd() {
        let written = |span: Range<f64>| ticks(&span).iter().map(label).collect::<Vec<_>>().join(" ");
        assert_eq!(written(0.0018..0.23), "0.002 0.005 0.01 0.02 0.05 0.1 0.2");
        assert_eq!(written(0.06..0.095), "0.06 0.07 0.08 0.09");
        assert_eq!(written(40.0..600.0), "50 100 200 500");
        assert_eq!(written(700.0..4e7), "1000 10000 1e5 1e6 1e7");
    }
}
