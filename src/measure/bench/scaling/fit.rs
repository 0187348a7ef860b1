//! Least squares: how a cost grows with the number of primitives.

use std::fmt;

use serde::{Deserialize, Serialize};

/// A cost at a number of primitives.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Point {
    /// Number of primitives, `n`.
    pub primitives: usize,
    /// What it cost.
    pub cost: f64,
}

/// A cost as a function of the number of primitives `n`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "form", rename_all = "snake_case", deny_unknown_fields)]
pub enum Law {
    /// `start + a_doubling * log2(n)`.
    Logarithm {
        /// Cost of one primitive.
        start: f64,
        /// What twice as many add.
        a_doubling: f64,
    },
    /// `factor * n ^ exponent`.
    Power {
        /// Cost of one primitive.
        factor: f64,
        /// 1 where twice as many cost twice as much.
        exponent: f64,
    },
}

impl Law {
    /// The logarithm of least squared differences, each as a share of its cost. **Needs:** two sizes that differ, costs
    /// above zero.
    pub fn logarithm(points: &[Point]) -> Self {
        let term = |p: &Point| Term { x: (p.primitives as f64).log2(), y: p.cost, weight: p.cost.powi(-2) };
        let (start, a_doubling) = line(points.iter().map(term));
        Self::Logarithm { start, a_doubling }
    }
    /// The power that least squares of the costs' logarithms give. **Needs:** two sizes that differ, costs above zero.
    pub fn power(points: &[Point]) -> Self {
        let term = |p: &Point| Term { x: (p.primitives as f64).ln(), y: p.cost.ln(), weight: 1.0 };
        let (start, exponent) = line(points.iter().map(term));
        Self::Power { factor: start.exp(), exponent }
    }
    /// The logarithm or the power, whichever no cost is as far from. **Needs:** two sizes that differ, costs above zero.
    pub fn nearest(points: &[Point]) -> Self {
        let [a, b] = [Self::logarithm(points), Self::power(points)];
        let far = |law: &Self| points.iter().map(|p| law.deviation(p).abs()).fold(0.0, f64::max);
        if far(&a) <= far(&b) { a } else { b }
    }
    /// The cost of so many primitives.
    pub fn at(&self, primitives: f64) -> f64 {
        match *self {
            Self::Logarithm { start, a_doubling } => start + a_doubling * primitives.log2(),
            Self::Power { factor, exponent } => factor * primitives.powf(exponent),
        }
    }
    /// How far a cost lies above the law, as a share of the law; negative below.
    pub fn deviation(&self, point: &Point) -> f64 {
        point.cost / self.at(point.primitives as f64) - 1.0
    }
}

impl fmt::Display for Law {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Logarithm { start, a_doubling } => {
                let sign = if a_doubling < 0.0 { '-' } else { '+' };
                write!(f, "{start:.3} {sign} {:.3} log2 n", a_doubling.abs())
            }
            Self::Power { factor, exponent } if (0.1..1e4).contains(&factor) => {
                write!(f, "{factor:.2} n^{exponent:.3}")
            }
            Self::Power { factor, exponent } => write!(f, "{factor:.3e} n^{exponent:.3}"),
        }
    }
}

/// A point that a line should go through, and how much that counts.
struct Term {
    x: f64,
    y: f64,
    weight: f64,
}

/// Where the line of least squares meets `x = 0`, and its slope.
fn line(terms: impl Iterator<Item = Term> + Clone) -> (f64, f64) {
    let sum = |of: &dyn Fn(&Term) -> f64| terms.clone().map(|t| t.weight * of(&t)).sum::<f64>();
    let all = sum(&|_| 1.0);
    let (x, y) = (sum(&|t| t.x) / all, sum(&|t| t.y) / all);
    let slope = sum(&|t| (t.x - x) * (t.y - y)) / sum(&|t| (t.x - x) * (t.x - x));
    (y - slope * x, slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZES: [usize; 5] = [1, 8, 1_000, 30_000, 1 << 25];

    fn points(cost: impl Fn(f64) -> f64) -> Vec<Point> {
        SIZES.map(|primitives| Point { primitives, cost: cost(primitives as f64) }).to_vec()
    }

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() <= 1e-9 * b.abs()
    }

    #[test]
    fn laws_are_found_again() {
        let points_of = points(|n| 7.0 + 3.0 * n.log2());
        let Law::Logarithm { start, a_doubling } = Law::logarithm(&points_of) else { panic!() };
        assert!(close(start, 7.0) && close(a_doubling, 3.0), "{start} {a_doubling}");
        let law = Law::power(&points(|n| 2e-7 * n.powf(1.25)));
        let Law::Power { factor, exponent } = law else { panic!() };
        assert!(close(factor, 2e-7) && close(exponent, 1.25), "{factor} {exponent}");
        assert!(close(law.at(16.0), 2e-7 * 32.0));
    }

    /// By hand: over x = 0, 2, 4 the logarithms 0, 0, 3 (of costs to base 2) have the line -0.5 + 0.75 x, so the costs
    /// are off by factors of 2 to the 0.5, -1 and 0.5.
    #[test]
    fn what_no_law_fits_deviates_by_known_shares() {
        let costs = [(1, 1.0), (4, 1.0), (16, 8.0)];
        let points = costs.map(|(primitives, cost)| Point { primitives, cost });
        let law = Law::power(&points);
        let expected = [0.5, -1.0, 0.5].map(|x| 2.0_f64.powf(x) - 1.0);
        for (point, expected) in points.iter().zip(expected) {
            assert!(close(law.deviation(point), expected), "{point:?}: {}", law.deviation(point));
        }
        assert_eq!(law.to_string(), "0.71 n^0.750");
    }

    /// By hand: over x = 0, 1 and twice 1 with costs 1, 2, 1 the weights are 1, 1/4 and 1, so the line goes through 1 and
    /// the weighted mean 1.5 / 1.25 = 1.2.
    #[test]
    fn differences_count_as_shares_of_costs() {
        let points = [(1, 1.0), (2, 2.0), (2, 1.0)].map(|(primitives, cost)| Point { primitives, cost });
        let Law::Logarithm { start, a_doubling } = Law::logarithm(&points) else { panic!() };
        assert!(close(start, 1.0) && close(a_doubling, 0.2), "{start} {a_doubling}");
    }

    #[test]
    fn the_nearer_law_is_taken() {
        assert!(matches!(Law::nearest(&points(|n| 5.0 + n.log2())), Law::Logarithm { .. }));
        assert!(matches!(Law::nearest(&points(|n| 5.0 * n.powf(0.3))), Law::Power { .. }));
    }

    #[test]
    fn costs_that_fall_are_said_so() {
        assert_eq!(Law::logarithm(&points(|n| 100.0 - n.log2())).to_string(), "100.000 - 1.000 log2 n");
        assert_eq!(Law::power(&points(|n| 100.0 / n)).to_string(), "100.00 n^-1.000");
    }
}
