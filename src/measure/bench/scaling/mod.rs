//! Cost against size: what building, memory and each class of rays cost over the number of primitives, and the laws
//! that fit.

mod fit;
mod plot;

use serde::{Deserialize, Serialize};

use super::report::{Report, SceneReport};
use super::table::aligned;
pub use fit::{Law, Point};
pub use plot::scaling_plot;

/// Fewer sizes lie on a law whatever they cost.
const FEWEST_SIZES: usize = 3;

/// What grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Seconds to build the tree: CPU time of one thread, wall time of several.
    BuildSeconds,
    /// Bytes of the tree and its leaves a primitive.
    BytesAPrimitive,
    /// Nanoseconds a ray of a class, on all threads together.
    NanosecondsARay,
}

/// A cost over the number of primitives.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Curve {
    /// What is counted.
    pub quantity: Quantity,
    /// `build`, `memory`, or the class of rays.
    pub name: String,
    /// What fits best by least squares.
    pub law: Law,
    /// Where the cost is farthest from the law.
    pub farthest: Point,
    /// How far above the law, as a share of the law; negative below.
    pub deviation: f64,
    /// Where the cost grows fastest from one size to the next: what a cliff would show in.
    pub steepest: Step,
    /// What was measured, sizes ascending.
    pub points: Vec<Point>,
}

/// From one size to the next.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Step {
    /// The smaller number of primitives.
    pub from: usize,
    /// The larger number of primitives.
    pub to: usize,
    /// The power of the number of primitives that the cost grows with between them.
    pub exponent: f64,
}

/// Every cost over the number of primitives.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scaling {
    /// Build, memory, then the classes of rays.
    pub curves: Vec<Curve>,
}

/// Too few sizes for a law.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "expected scenes of at least {FEWEST_SIZES} numbers of primitives, such as `terrain:1000 terrain:10000 \
     terrain:100000`; found {0}"
)]
pub struct TooFewSizes(pub usize);

impl Scaling {
    /// **Errors:** fewer than three scenes cannot have three sizes.
    pub fn expects(scenes: usize) -> Result<(), TooFewSizes> {
        if scenes < FEWEST_SIZES { Err(TooFewSizes(scenes)) } else { Ok(()) }
    }

    /// octray's own costs over the scenes of a report.
    ///
    /// **Errors:** fewer than three different numbers of primitives.
    pub fn of(report: &Report) -> Result<Self, TooFewSizes> {
        let scenes = &report.scenes;
        let build = |scene: &SceneReport| scene.builds.first().map(|build| build.seconds);
        let memory = |scene: &SceneReport| scene.builds.first().and_then(|build| build.bytes_a_prim);
        let own = [
            Curve::of(Quantity::BuildSeconds, "build", points(scenes, build)),
            Curve::of(Quantity::BytesAPrimitive, "memory", points(scenes, memory)),
        ];
        let own: Vec<Curve> = own.into_iter().collect::<Result<_, _>>()?;
        // A class that too few scenes have, such as shadow rays where the camera sees nothing, has no law.
        let rays = report.classes().into_iter().filter_map(|class| {
            Curve::of(Quantity::NanosecondsARay, class, points(scenes, |scene| a_ray(scene, class))).ok()
        });
        Ok(Self { curves: own.into_iter().chain(rays).collect() })
    }

    /// The curves of a quantity.
    fn curves_of(&self, quantity: Quantity) -> Vec<&Curve> {
        self.curves.iter().filter(|curve| curve.quantity == quantity).collect()
    }

    /// The laws and what was measured, for people.
    pub fn table(&self) -> String {
        let head =
            ["cost", "unit", "law over n primitives", "farthest", "at n", "steepest", "from n", "to n"]
                .map(String::from)
                .to_vec();
        let laws = self.curves.iter().map(|curve| {
            vec![
                curve.name.clone(),
                curve.quantity.unit().into(),
                curve.law.to_string(),
                format!("{:+.0}%", 100.0 * curve.deviation),
                curve.farthest.primitives.to_string(),
                format!("n^{:.2}", curve.steepest.exponent),
                curve.steepest.from.to_string(),
                curve.steepest.to.to_string(),
            ]
        });
        let laws: Vec<_> = std::iter::once(head).chain(laws).collect();
        format!("{}\n{}", aligned(&self.costs()), aligned(&laws))
    }

    /// A row for each size, a column for each curve.
    fn costs(&self) -> Vec<Vec<String>> {
        let name = |curve: &Curve| format!("{}, {}", curve.name, curve.quantity.unit());
        let head = std::iter::once("n".to_owned()).chain(self.curves.iter().map(name)).collect();
        let mut rows = vec![head];
        for (i, point) in self.curves[0].points.iter().enumerate() {
            let cost = |curve: &Curve| curve.cost_at(i, point.primitives);
            rows.push(
                std::iter::once(point.primitives.to_string()).chain(self.curves.iter().map(cost)).collect(),
            );
        }
        rows
    }
}

impl Curve {
    fn of(quantity: Quantity, name: &str, points: Vec<Point>) -> Result<Self, TooFewSizes> {
        let sizes = points.chunk_by(|a, b| a.primitives == b.primitives).count();
        if sizes < FEWEST_SIZES {
            return Err(TooFewSizes(sizes));
        }
        let law = quantity.law(&points);
        let far = |point: &Point| law.deviation(point).abs();
        let farthest = points.iter().copied().max_by(|a, b| far(a).total_cmp(&far(b)));
        let (farthest, steepest) = farthest.zip(Step::steepest(&points)).ok_or(TooFewSizes(sizes))?;
        let deviation = law.deviation(&farthest);
        Ok(Self { quantity, name: name.into(), law, farthest, deviation, steepest, points })
    }

    fn cost_at(&self, row: usize, primitives: usize) -> String {
        let here = self.points.get(row).filter(|point| point.primitives == primitives);
        let point = here.or_else(|| self.points.iter().find(|point| point.primitives == primitives));
        point.map_or("-".into(), |point| self.quantity.text(point.cost))
    }
}

impl Step {
    /// Of points with sizes ascending; `None` if all sizes are the same.
    fn steepest(points: &[Point]) -> Option<Self> {
        let step = |pair: &[Point]| {
            let [a, b] = [pair[0], pair[1]];
            let growth = (b.primitives as f64 / a.primitives as f64).ln();
            let exponent = (b.cost / a.cost).ln() / growth;
            (growth > 0.0).then_some(Self { from: a.primitives, to: b.primitives, exponent })
        };
        points.windows(2).filter_map(step).max_by(|a, b| a.exponent.total_cmp(&b.exponent))
    }
}

impl Quantity {
    fn unit(self) -> &'static str {
        match self {
            Self::BuildSeconds => "s",
            Self::BytesAPrimitive => "B/n",
            Self::NanosecondsARay => "ns",
        }
    }
    fn law(self, points: &[Point]) -> Law {
        match self {
            Self::NanosecondsARay => Law::nearest(points),
            _ => Law::power(points),
        }
    }
    fn text(self, cost: f64) -> String {
        match self {
            Self::BuildSeconds => format!("{cost:.4}"),
            _ => format!("{cost:.1}"),
        }
    }
}

/// Costs of the scenes that have one, sizes ascending.
fn points(scenes: &[SceneReport], cost: impl Fn(&SceneReport) -> Option<f64>) -> Vec<Point> {
    let point = |scene: &SceneReport| {
        let cost = cost(scene).filter(|cost| *cost > 0.0)?;
        Some(Point { primitives: scene.primitives(), cost })
    };
    let mut points: Vec<Point> = scenes.iter().filter_map(point).filter(|p| p.primitives > 0).collect();
    points.sort_by_key(|point| point.primitives);
    points
}

fn a_ray(scene: &SceneReport, class: &str) -> Option<f64> {
    let class = scene.classes.iter().find(|c| c.class == class)?;
    Some(1e3 / class.octray()?.mrays_s.median)
}

#[cfg(test)]
mod tests;
