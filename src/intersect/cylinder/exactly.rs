//! Whether and where a line meets a closed cylinder, where rounding in `f64` could change the answer.
//!
//! Plainly: the line meets it if it is inside the side where it passes a cap, or comes nearest to the axis between the caps
//! and passes it within the radius. With `f` and `g` from the two ends to the origin, `a` the axis, `n = d x a` and the
//! moments `f x d`, `g x d`, each of these is the sign of a form in which nothing is divided and no root taken, so that
//! pairs of `f64` decide, and whole numbers where those cannot. A ray along the axis, with `n = 0`, is decided at the caps.
//! Whether an end of the chord lies before or behind the origin is the sign of such forms too, and that of the quotient that
//! its `t` is.

use std::cell::OnceCell;
use std::cmp::Ordering;

use dashu::integer::IBig;

use super::Lanes;
use crate::intersect::RayLanes;
use crate::intersect::doubt::{roots, size};
use crate::intersect::oracle::number::Unit;
use crate::math::{Pair, Ring, Vec3, pairs, ring_cross, ring_dot, sign, two_sum, value};

/// The part of a line inside a cylinder, its ends on the sides of zero that are exactly right.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chord {
    pub(super) first: f64,
    pub(super) last: f64,
    /// Whether it enters, and leaves, through the side rather than a cap; the rims belong to the side.
    pub(super) on_side: [bool; 2],
}

/// The chord of a line and a cylinder, decided without rounding; none for NaN, infinities and rays that go nowhere.
pub(super) fn chord(ray: &RayLanes<f64>, cylinder: &Lanes<f64>) -> Option<Chord> {
    let question = Question::new(ray, cylinder)?;
    let across = question.sign(Form::Across);
    if across.is_eq() {
        return question.is_near().then(|| question.between_roots([Ordering::Greater; 2]));
    }
    let at_ends = [Form::InsideAt(0), Form::InsideAt(1)].map(|form| question.sign(form).reverse());
    let meets = at_ends.iter().any(|at| at.is_le()) || question.is_near();
    meets.then(|| question.between_roots(if across.is_gt() { at_ends } else { [at_ends[1], at_ends[0]] }))
}

/// What is asked the sign of.
#[derive(Clone, Copy)]
enum Form {
    /// Of `d . a`: which cap comes first.
    Across,
    /// Whether the line is inside the side where it passes the plane of a cap: `r^2 (d . a)^2 - |a x (f x d)|^2`.
    InsideAt(usize),
    /// Whether the line is not along the axis: `|n|^2`.
    Turned,
    /// Whether the point of the axis nearest to the line is not before its begin: `-(f x d) . n`.
    NotBefore,
    /// Nor beyond its end: `(g x d) . n`.
    NotBeyond,
    /// Whether the lines pass each other within the radius: `r^2 |n|^2 - (f . n)^2`.
    Near,
    /// How far the origin is beyond the plane of a cap: `f . a`, or `g . a`.
    Height(usize),
    /// What the origin is outside of the side: `|f x a|^2 - r^2 |a|^2`.
    Outside,
    /// Whether the line goes away from the axis: `(f x a) . n`.
    Away,
}

impl Form {
    /// How often a length across, the direction and the axis are factors.
    fn factors(self) -> [usize; 3] {
        match self {
            Self::Across => [0, 1, 1],
            Self::Turned => [0, 2, 2],
            Self::NotBefore | Self::NotBeyond => [1, 2, 1],
            Self::InsideAt(_) | Self::Near => [2, 2, 2],
            Self::Height(_) => [1, 0, 1],
            Self::Outside => [2, 0, 2],
            Self::Away => [1, 1, 2],
        }
    }
}

/// The vectors that the forms are made of.
struct Parts<N> {
    offset: [[N; 3]; 2],
    direction: [N; 3],
    axis: [N; 3],
    radius: N,
    /// Offsets by direction.
    moment: [[N; 3]; 2],
    /// Direction by axis.
    normal: [N; 3],
}

impl<N: Ring> Parts<N> {
    fn new(offset: [[N; 3]; 2], direction: [N; 3], axis: [N; 3], radius: N) -> Self {
        let moment = [0, 1].map(|end| ring_cross(&offset[end], &direction));
        let normal = ring_cross(&direction, &axis);
        Self { offset, direction, axis, radius, moment, normal }
    }

    fn value(&self, form: Form) -> N {
        let (n, zero) = (&self.normal, self.radius.minus(&self.radius));
        match form {
            Form::Across => ring_dot(&self.direction, &self.axis),
            Form::InsideAt(end) => {
                let across = ring_cross(&self.axis, &self.moment[end]);
                let reach = self.radius.times(&self.value(Form::Across));
                reach.squared().minus(&ring_dot(&across, &across))
            }
            Form::Turned => ring_dot(n, n),
            Form::NotBefore => zero.minus(&ring_dot(&self.moment[0], n)),
            Form::NotBeyond => ring_dot(&self.moment[1], n),
            Form::Near => {
                let reach = self.radius.squared().times(&ring_dot(n, n));
                reach.minus(&ring_dot(&self.offset[0], n).squared())
            }
            Form::Height(end) => ring_dot(&self.offset[end], &self.axis),
            Form::Outside => {
                let across = ring_cross(&self.offset[0], &self.axis);
                let reach = self.radius.squared().times(&ring_dot(&self.axis, &self.axis));
                ring_dot(&across, &across).minus(&reach)
            }
            Form::Away => ring_dot(&ring_cross(&self.offset[0], &self.axis), n),
        }
    }
}

/// Whole numbers of a unit of lengths and one of the direction.
struct Whole {
    parts: Parts<IBig>,
    units: [Unit; 2],
}

/// A line and a cylinder.
struct Question {
    pairs: Parts<Pair>,
    whole: OnceCell<Whole>,
    origin: [f64; 3],
    direction: [f64; 3],
    ends: [[f64; 3]; 2],
    radius: f64,
    /// Sums of magnitudes: of all lengths, of the direction, and of the axis.
    sizes: [f64; 3],
}

impl Question {
    fn new(ray: &RayLanes<f64>, c: &Lanes<f64>) -> Option<Self> {
        let (origin, direction) = (ray.origin.get(0), ray.direction.get(0));
        if direction == [0.0; 3] {
            return None;
        }
        let (ends, radius) = ([c.from.get(0), c.to.get(0)], c.radius);
        let between = |p: [f64; 3], q: [f64; 3]| std::array::from_fn(|k| two_sum(p[k], -q[k]));
        let axis = between(ends[1], ends[0]);
        let pairs = Parts::new(ends.map(|end| between(origin, end)), pairs(direction), axis, [radius, 0.0]);
        let rounded = |v: &[Pair; 3]| size(Vec3::<f64>::splat(v.map(|x| x[0])));
        let (d, a) = (size(ray.direction), rounded(&axis));
        let sizes = [rounded(&pairs.offset[0]) + a + radius, d, a];
        let whole = OnceCell::new();
        let question = Self { pairs, whole, origin, direction, ends, radius, sizes };
        question.size(Form::Near).is_finite().then_some(question)
    }

    /// The product of the sizes of the factors.
    fn size(&self, form: Form) -> f64 {
        let factors = self.sizes.iter().zip(form.factors());
        factors.flat_map(|(size, times)| std::iter::repeat_n(size, times)).product()
    }

    fn sign(&self, form: Form) -> Ordering {
        sign(self.pairs.value(form), self.size(form), || self.whole().parts.value(form))
    }

    fn value(&self, form: Form) -> f64 {
        value(self.pairs.value(form), self.size(form), || {
            let ([across, along, axes], Whole { parts, units }) = (form.factors(), self.whole());
            units[0].drop(across + axes, units[1], along, parts.value(form))
        })
    }

    /// No sign depends on the units.
    fn whole(&self) -> &Whole {
        self.whole.get_or_init(|| {
            let numbers = self.ends.as_flattened().iter().chain(&self.origin).chain([&self.radius]);
            let units = [Unit::of(numbers.copied()), Unit::of(self.direction)];
            let lift = |p: [f64; 3]| p.map(|x| units[0].lift(x));
            let (origin, ends) = (lift(self.origin), self.ends.map(lift));
            let between = |p: &[IBig; 3], q: &[IBig; 3]| std::array::from_fn(|k| &p[k] - &q[k]);
            let offsets = [0, 1].map(|end| between(&origin, &ends[end]));
            let direction = self.direction.map(|x| units[1].lift(x));
            let radius = units[0].lift(self.radius);
            Whole { parts: Parts::new(offsets, direction, between(&ends[1], &ends[0]), radius), units }
        })
    }

    /// Whether the line, not along the axis, passes it between the caps and within the radius.
    fn is_near(&self) -> bool {
        self.sign(Form::Turned).is_gt()
            && [Form::NotBefore, Form::NotBeyond, Form::Near].iter().all(|&form| self.sign(form).is_ge())
    }

    /// The chord: from the plane of a cap where the line is inside the side there, else from the side. The ends in the order
    /// in which the line comes to them.
    fn between_roots(&self, at_ends: [Ordering; 2]) -> Chord {
        let none = [f64::NAN; 2];
        let sides = if at_ends.iter().any(|at| at.is_gt()) { self.side_roots() } else { none };
        let caps = if at_ends.iter().any(|at| at.is_le()) { self.cap_roots() } else { none };
        let end = |i: usize| if at_ends[i].is_gt() { sides[i] } else { caps[i] };
        let (first, last) = (end(0), end(1));
        Chord { first, last: last.max(first), on_side: at_ends.map(Ordering::is_ge) }
    }

    /// Where the line meets the planes of the caps.
    fn cap_roots(&self) -> [f64; 2] {
        let speed = self.value(Form::Across);
        let [from, to] = [0, 1].map(|end| 0.0 - self.value(Form::Height(end)) / speed);
        [from.min(to), from.max(to)]
    }

    /// Where the line meets the infinite side, as if it did: of `|n|^2 t^2 + 2 (f x a) . n t + |f x a|^2 - r^2 |a|^2`.
    fn side_roots(&self) -> [f64; 2] {
        let axis2 = ring_dot(&self.pairs.axis, &self.pairs.axis)[0];
        let root = (axis2 * self.value(Form::Near).max(0.0)).sqrt();
        roots([Form::Turned, Form::Away, Form::Outside].map(|form| self.value(form)), root)
    }
}
