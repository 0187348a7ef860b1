//! Whether and where a line meets a sphere, where rounding in `f64` could change the answer.
//!
//! Plainly: with `f` from the centre to the origin the line meets it if `|f x d|` is not more than `r |d|`, and the origin is
//! inside if `|f|` is less than `r`; outside, the sphere is ahead if `f . d` is negative. Each is the sign of a form in which nothing
//! is divided and no root taken, so that pairs of `f64` decide, and whole numbers where those cannot. The roots have the signs of
//! those forms.

use std::cell::OnceCell;

use dashu::integer::IBig;

use crate::intersect::RayLanes;
use crate::intersect::doubt::{roots, size};
use crate::intersect::oracle::number::Unit;
use crate::math::{Pair, Ring, pairs, ring_cross, ring_dot, sign, two_sum, value};

/// Where the line enters and leaves, on the side of zero that is exactly right; none for NaN, infinities and rays that go nowhere.
pub(super) fn ends(ray: &RayLanes<f64>, center: [f64; 3], radius: f64) -> Option<[f64; 2]> {
    let (origin, direction) = (ray.origin.get(0), ray.direction.get(0));
    if direction == [0.0; 3] {
        return None;
    }
    let offset: [Pair; 3] = std::array::from_fn(|k| two_sum(origin[k], -center[k]));
    let reach = offset.iter().map(|x| x[0].abs()).sum::<f64>() + radius;
    let pairs = Parts { offset, direction: pairs(direction), radius: [radius, 0.0] };
    let question = Question {
        pairs,
        whole: OnceCell::new(),
        line: [origin, direction],
        center,
        sizes: [reach, size(ray.direction)],
    };
    question.size(Form::Met).is_finite().then(|| question.ends())?
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

impl Form {
    /// How often a length is a factor, and the direction.
    fn factors(self) -> [usize; 2] {
        match self {
            Self::Met => [2, 2],
            Self::Outside => [2, 0],
            Self::Away => [1, 1],
        }
    }
}

/// The vectors that the forms are made of.
struct Parts<N> {
    offset: [N; 3],
    direction: [N; 3],
    radius: N,
}

impl<N: Ring> Parts<N> {
    fn value(&self, form: Form) -> N {
        let (f, d) = (&self.offset, &self.direction);
        match form {
            Form::Met => {
                let n = ring_cross(f, d);
                self.radius.squared().times(&ring_dot(d, d)).minus(&ring_dot(&n, &n))
            }
            Form::Outside => ring_dot(f, f).minus(&self.radius.squared()),
            Form::Away => ring_dot(f, d),
        }
    }
}

/// Whole numbers of a unit of lengths and one of the direction.
struct Whole {
    parts: Parts<IBig>,
    units: [Unit; 2],
}

/// A line and a sphere.
struct Question {
    pairs: Parts<Pair>,
    whole: OnceCell<Whole>,
    /// Origin and direction.
    line: [[f64; 3]; 2],
    center: [f64; 3],
    /// Sums of magnitudes: of lengths, and of the direction.
    sizes: [f64; 2],
}

impl Question {
    fn ends(&self) -> Option<[f64; 2]> {
        let whole = || self.whole().parts.value(Form::Met);
        if sign(self.pairs.value(Form::Met), self.size(Form::Met), whole).is_lt() {
            return None;
        }
        let [met, outside, away] = [Form::Met, Form::Outside, Form::Away].map(|form| self.value(form));
        let speed2 = ring_dot(&self.pairs.direction, &self.pairs.direction)[0];
        Some(roots([speed2, away, outside], met.sqrt()))
    }

    /// The product of the sizes of the factors.
    fn size(&self, form: Form) -> f64 {
        let factors = self.sizes.iter().zip(form.factors());
        factors.flat_map(|(size, times)| std::iter::repeat_n(size, times)).product()
    }

    fn value(&self, form: Form) -> f64 {
        value(self.pairs.value(form), self.size(form), || {
            let ([lengths, directions], Whole { parts, units }) = (form.factors(), self.whole());
            units[0].drop(lengths, units[1], directions, parts.value(form))
        })
    }

    fn whole(&self) -> &Whole {
        self.whole.get_or_init(|| {
            let ([origin, direction], center, radius) = (self.line, self.center, self.pairs.radius[0]);
            let lengths = Unit::of(origin.into_iter().chain(center).chain([radius]));
            let offset = std::array::from_fn(|k| lengths.lift(origin[k]) - lengths.lift(center[k]));
            let along = Unit::of(direction);
            let direction = direction.map(|x| along.lift(x));
            Whole {
                parts: Parts { offset, direction, radius: lengths.lift(radius) },
                units: [lengths, along],
            }
        })
    }
}
