//! Cost against size as SVG.

use std::error::Error;

use plotters::coord::Shift;
use plotters::prelude::*;

use super::{Curve, Quantity, Scaling};
use crate::measure::plot::{Chart, chart, decades, legend, range};

/// Width and height of the plot in units of SVG, and the height of the upper part.
const SIZE: (u32, u32) = (860, 900);
const UPPER: u32 = 520;

const COLORS: [RGBColor; 6] = [
    RGBColor(28, 100, 200),
    RGBColor(20, 20, 20),
    RGBColor(30, 140, 60),
    RGBColor(210, 30, 30),
    RGBColor(230, 119, 0),
    RGBColor(110, 70, 190),
];

/// Places along a law that is drawn: it bends where axes are powers of ten.
const STEPS: i32 = 48;

/// What was measured as dots and the laws as lines, over the number of primitives: rays above, building and memory below.
///
/// **Errors:** what plotters says.
pub fn scaling_plot(scaling: &Scaling) -> Result<String, Box<dyn Error>> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        area.fill(&WHITE)?;
        let (upper, lower) = area.split_vertically(UPPER);
        let (left, right) = lower.split_horizontally(SIZE.0 / 2);
        panel(&upper, "ns a ray", &scaling.curves_of(Quantity::NanosecondsARay))?;
        panel(&left, "build, s", &scaling.curves_of(Quantity::BuildSeconds))?;
        panel(&right, "bytes a primitive", &scaling.curves_of(Quantity::BytesAPrimitive))?;
        area.present()?;
    }
    Ok(svg)
}

fn panel(
    area: &DrawingArea<SVGBackend<'_>, Shift>,
    name: &str,
    curves: &[&Curve],
) -> Result<(), Box<dyn Error>> {
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let sizes = range(points().map(|p| p.primitives as f64));
    let mut chart = chart(area, ["primitives", name], [sizes, decades(points().map(|p| p.cost))])?;
    for (curve, color) in curves.iter().zip(COLORS.iter().cycle()) {
        draw(&mut chart, curve, *color)?;
    }
    legend(&mut chart, SeriesLabelPosition::UpperLeft)
}

fn draw(chart: &mut Chart, curve: &Curve, color: RGBColor) -> Result<(), Box<dyn Error>> {
    let ends = [curve.points.first(), curve.points.last()].map(|p| p.map_or(1.0, |p| p.primitives as f64));
    let size = |step: i32| ends[0] * (ends[1] / ends[0]).powf(f64::from(step) / f64::from(STEPS));
    let law = (0..=STEPS).map(|step| (size(step), curve.law.at(size(step))));
    // A line that falls below zero has no logarithm there.
    let law = law.filter(|&(_, cost)| cost > 0.0);
    let series = chart.draw_series(LineSeries::new(law, color.mix(0.6).stroke_width(1)))?;
    let name = format!("{}: {}", curve.name, curve.law);
    series.label(name).legend(move |(x, y)| Circle::new((x + 10, y), 4, color.filled()));
    let dots = curve.points.iter().map(|p| Circle::new((p.primitives as f64, p.cost), 4, color.filled()));
    chart.draw_series(dots)?;
    Ok(())
}
