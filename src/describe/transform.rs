//! Transforms as a list of steps, and the matrix they make.

use super::{Factors, exact};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Steps that move an object, applied in the order written.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Transform(pub Vec<Step>);

/// One step of a transform: a table with exactly one key.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Step {
    /// Moves by a vector.
    #[serde(deserialize_with = "exact::read")]
    Translate([f64; 3]),
    /// Turns around an axis through the origin.
    RotateDeg(Rotation),
    /// Scales from the origin, by one factor or one an axis; none may be 0.
    Scale(Factors),
    /// Three rows of four numbers (the last column moves), and optionally the row `[0, 0, 0, 1]`.
    #[serde(deserialize_with = "exact::read")]
    Matrix(Vec<[f64; 4]>),
}

/// A rotation, counter-clockwise seen against the axis (right-hand rule).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rotation {
    /// The axis; any length.
    #[serde(deserialize_with = "exact::read")]
    pub axis: [f64; 3],
    /// The angle in degrees.
    pub angle: f64,
}

/// Three rows of an affine matrix: the last column moves.
type Rows = [[f64; 4]; 3];

const IDENTITY: Rows = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];

impl Transform {
    /// Whether there is no step at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Adds a move.
    #[must_use]
    pub fn translate(self, by: [f64; 3]) -> Transform {
        self.then(Step::Translate(by))
    }

    /// Adds a scaling by factors an axis.
    #[must_use]
    pub fn scale(self, by: [f64; 3]) -> Transform {
        self.then(Step::Scale(Factors(by)))
    }

    /// Adds a rotation.
    #[must_use]
    pub fn rotate_deg(self, axis: [f64; 3], angle: f64) -> Transform {
        self.then(Step::RotateDeg(Rotation { axis, angle }))
    }

    fn then(mut self, step: Step) -> Transform {
        self.0.push(step);
        self
    }

    /// Three rows of the matrix that applies all steps in order (the last column moves).
    ///
    /// **Accuracy**: each step is exact to rounding; rotations by multiples of 90 degrees have no rounding at all.
    #[must_use]
    pub fn matrix(&self) -> [[f64; 4]; 3] {
        self.0.iter().fold(IDENTITY, |before, step| product(&step.matrix(), &before))
    }
}

impl Step {
    /// Three rows of the matrix of this step.
    #[must_use]
    pub fn matrix(&self) -> [[f64; 4]; 3] {
        match self {
            Step::Translate(by) => std::array::from_fn(|r| {
                let mut row = IDENTITY[r];
                row[3] = by[r];
                row
            }),
            Step::Scale(by) => std::array::from_fn(|r| IDENTITY[r].map(|e| e * by.0[r])),
            Step::RotateDeg(rotation) => rotation.matrix(),
            Step::Matrix(rows) => std::array::from_fn(|r| rows.get(r).copied().unwrap_or(IDENTITY[r])),
        }
    }
}

impl Rotation {
    /// Rodrigues' formula: `R = cos I + sin [a]x + (1 - cos) a aT` for a unit axis `a`.
    fn matrix(&self) -> Rows {
        let a = unit(self.axis);
        let (sin, cos) = sin_cos_deg(self.angle);
        let cross = [[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]];
        std::array::from_fn(|r| {
            std::array::from_fn(|c| match c {
                3 => 0.0,
                _ => cos * IDENTITY[r][c] + sin * cross[r][c] + (1.0 - cos) * a[r] * a[c],
            })
        })
    }
}

/// The determinant of the linear part: 0 for a transform that flattens.
pub(super) fn determinant(m: &Rows) -> f64 {
    let minor = |a: usize, b: usize| m[1][a] * m[2][b] - m[1][b] * m[2][a];
    m[0][0] * minor(1, 2) - m[0][1] * minor(0, 2) + m[0][2] * minor(0, 1)
}

/// Applies `b` first, then `a`.
fn product(a: &Rows, b: &Rows) -> Rows {
    std::array::from_fn(|r| {
        std::array::from_fn(|c| {
            let moved = if c == 3 { a[r][3] } else { 0.0 };
            a[r][0] * b[0][c] + a[r][1] * b[1][c] + a[r][2] * b[2][c] + moved
        })
    })
}

/// The vector at length 1, scaled first so that no square overflows or vanishes.
fn unit(v: [f64; 3]) -> [f64; 3] {
    let largest = v.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let v = v.map(|x| x / largest);
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    v.map(|x| x / length)
}

/// Sine and cosine of degrees, exact at multiples of 90, the same bits on every platform (libm).
pub(super) fn sin_cos_deg(angle: f64) -> (f64, f64) {
    let turns = (angle / 90.0).round();
    let rest = (angle - 90.0 * turns).to_radians();
    let (sin, cos) = (libm::sin(rest), libm::cos(rest));
    match turns.rem_euclid(4.0) as i64 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn apply(m: &Rows, p: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|r| m[r][0] * p[0] + m[r][1] * p[1] + m[r][2] * p[2] + m[r][3])
    }

    #[test]
    fn steps_apply_in_the_order_written() {
        let up = [0.0, 1.0, 0.0];
        let t = Transform::default().scale([10.0; 3]).rotate_deg(up, 90.0).translate([0.0, -1.0, 2.0]);
        assert_eq!(apply(&t.matrix(), [1.0, 0.0, 0.0]), [0.0, -1.0, -8.0]);
    }

    #[test]
    fn quarter_turns_are_exact() {
        for quarter in -8..8 {
            let (sin, cos) = sin_cos_deg(90.0 * f64::from(quarter));
            assert_eq!(sin.abs() + cos.abs(), 1.0, "{quarter}");
        }
        let (sin, cos) = sin_cos_deg(210.0);
        assert!((sin + 0.5).abs() < 1e-15 && (cos + 0.75f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn tiny_and_huge_axes_have_a_direction() {
        for length in [1e-300, 1e300] {
            let m = Step::RotateDeg(Rotation { axis: [0.0, 0.0, length], angle: 90.0 }).matrix();
            assert_eq!(apply(&m, [1.0, 0.0, 0.0]), [0.0, 1.0, 0.0]);
        }
    }

    #[test]
    fn mirrors_have_a_negative_determinant() {
        assert_eq!(determinant(&Transform::default().scale([-1.0, 2.0, 3.0]).matrix()), -6.0);
        assert_eq!(determinant(&IDENTITY), 1.0);
    }
}
