//! Whether and where a line meets a sphere, where rounding in `f64` could change the answer.
//!
//! Plainly: with `f` from the centre to the origin the line meets it if `|f x d|` is not more than `r |d|`, and the origin is
//! inside if `|f|` is less than `r`; outside, the sphere is ahead if `f . d` is negative. Each is the sign of a form in which nothing
//! is divided and no root taken, so that pairs of `f64` decide, and whole numbers where those cannot. The roots have the signs of
//! those forms.

use crate::intersect::RayLanes;
use crate::intersect::doubt::{roots, size};
use crate::intersect::oracle::number::Unit;
use crate::intersect::question::{self, Question, Whole};
use crate::math::{Pair, Ring, pairs, ring_cross, ring_dot, two_sum};

/// Where the line enters and leaves, on the side of zero that is exactly right; none for NaN, infinities and rays that go nowhere.
pub(super) fn ends(ray: &RayLanes<f64>, center: [f64; 3], radius: f64) -> Option<[f64; 2]> {
    let (origin, direction) = (ray.origin.get(0), ray.direction.get(0));
    if direction == [0.0; 3] {
        return None;
    }
    let offset: [Pair; 3] = std::array::from_fn(|k| two_sum(origin[k], -center[k]));
    let reach = offset.iter().map(|x| x[0].abs()).sum::<f64>() + radius;
    let pairs = Parts { offset, direction: pairs(direction), radius: [radius, 0.0] };
    let whole = || in_whole_numbers([origin, direction], center, radius);
    let question = Question::new(pairs, whole, [reach, size(ray.direction), 0.0]);
    if !question.size(Form::Met).is_finite() || question.sign(Form::Met).is_lt() {
        return None;
    }
    let [met, outside, away] = [Form::Met, Form::Outside, Form::Away].map(|form| question.value(form));
    let speed2 = ring_dot(&question.pairs.direction, &question.pairs.direction)[0];
    Some(roots([speed2, away, outside], met.sqrt()))
}

/// Of origin and direction of a line, and a sphere.
fn in_whole_numbers([origin, direction]: [[f64; 3]; 2], center: [f64; 3], radius: f64) -> Whole<Form> {
    let lengths = Unit::of(origin.into_iter().chain(center).chain([radius]));
    let offset = std::array::from_fn(|k| lengths.lift(origin[k]) - lengths.lift(center[k]));
    let along = Unit::of(direction);
    let direction = direction.map(|x| along.lift(x));
    Whole { parts: Parts { offset, direction, radius: lengths.lift(radius) }, units: [lengths, along] }
}

/// What is asked the sign or the value of.
#[derive(Clone, Copy)]
enum Form {
    /// What the squares of radius and distance leave, times that of the direction's length: `r^2 |d|^2 - |f x d|^2`.
    Met,
    /// What the origin is outside: `|f|^2 - r^2`.
    Outside,
    /// Whether the line goes away from the centre: `f . d`.
    Away,
}

/// The vectors that the forms are made of.
struct Parts<N> {
    offset: [N; 3],
    direction: [N; 3],
    radius: N,
}

impl question::Form for Form {
    type Parts<N: Ring> = Parts<N>;

    fn of<N: Ring>(self, parts: &Parts<N>) -> N {
        let (f, d) = (&parts.offset, &parts.direction);
        match self {
            Self::Met => {
                let n = ring_cross(f, d);
                parts.radius.squared().times(&ring_dot(d, d)).minus(&ring_dot(&n, &n))
            }
            Self::Outside => ring_dot(f, f).minus(&parts.radius.squared()),
            Self::Away => ring_dot(f, d),
        }
    }

    fn factors(self) -> [usize; 3] {
        match self {
            Self::Met => [2, 2, 0],
            Self::Outside => [2, 0, 0],
            Self::Away => [1, 1, 0],
        }
    }
}
