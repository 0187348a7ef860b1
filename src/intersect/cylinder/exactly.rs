//! Whether and where a line meets a closed cylinder, where rounding in `f64` could change the answer.
//!
//! Plainly: the line meets it if it is inside the side where it passes a cap, or comes nearest to the axis between the caps
//! and passes it within the radius. With `f` and `g` from the two ends to the origin, `a` the axis, `n = d x a` and the
//! moments `f x d`, `g x d`, each of these is the sign of a form in which nothing is divided and no root taken, so that
//! pairs of `f64` decide, and whole numbers where those cannot. A ray along the axis, with `n = 0`, is decided at the caps.
//! Whether an end of the chord lies before or behind the origin is the sign of such forms too, and that of the quotient that
//! its `t` is.

use std::cmp::Ordering;

use dashu::integer::IBig;

use super::Lanes;
use crate::intersect::RayLanes;
use crate::intersect::doubt::{roots, size};
use crate::intersect::oracle::number::Unit;
use crate::intersect::question::{self, Question, Whole};
use crate::math::{Pair, Ring, Vec3, pairs, ring_cross, ring_dot, two_sum};

/// The part of a line inside a cylinder, its ends on the sides of zero that are exactly right.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chord {
    pub(super) first: f64,
    pub(super) last: f64,
    /// Whether it enters, and leaves, through the side rather than a cap; the rims belong to the side.
    pub(super) on_side: [bool; 2],
}

/// The chord of a line and a cylinder, decided without rounding; none for NaN, infinities and rays that go nowhere.
pub(super) fn chord(ray: &RayLanes<f64>, c: &Lanes<f64>) -> Option<Chord> {
    let (origin, direction, ends) = (ray.origin.get(0), ray.direction.get(0), [c.from.get(0), c.to.get(0)]);
    if direction == [0.0; 3] {
        return None;
    }
    let between = |p: [f64; 3], q: [f64; 3]| std::array::from_fn(|k| two_sum(p[k], -q[k]));
    let axis = between(ends[1], ends[0]);
    let pairs = Parts::new(ends.map(|end| between(origin, end)), pairs(direction), axis, [c.radius, 0.0]);
    let rounded = |v: &[Pair; 3]| size(Vec3::<f64>::splat(v.map(|x| x[0])));
    let length = rounded(&axis);
    let sizes = [rounded(&pairs.offset[0]) + length + c.radius, size(ray.direction), length];
    let whole = || in_whole_numbers([origin, direction], ends, c.radius);
    let question = Question::new(pairs, whole, sizes);
    question.size(Form::Near).is_finite().then(|| question.chord())?
}

/// Of origin and direction of a line, and a cylinder.
fn in_whole_numbers([origin, direction]: [[f64; 3]; 2], ends: [[f64; 3]; 2], radius: f64) -> Whole<Form> {
    let numbers = ends.as_flattened().iter().chain(&origin).chain([&radius]);
    let units = [Unit::of(numbers.copied()), Unit::of(direction)];
    let lift = |p: [f64; 3]| p.map(|x| units[0].lift(x));
    let (origin, ends) = (lift(origin), ends.map(lift));
    let between = |p: &[IBig; 3], q: &[IBig; 3]| std::array::from_fn(|k| &p[k] - &q[k]);
    let offsets = [0, 1].map(|end| between(&origin, &ends[end]));
    let direction = direction.map(|x| units[1].lift(x));
    Whole { parts: Parts::new(offsets, direction, between(&ends[1], &ends[0]), units[0].lift(radius)), units }
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
}

impl question::Form for Form {
    type Parts<N: Ring> = Parts<N>;

    fn of<N: Ring>(self, parts: &Parts<N>) -> N {
        let (n, zero) = (&parts.normal, parts.radius.minus(&parts.radius));
        match self {
            Self::Across => ring_dot(&parts.direction, &parts.axis),
            Self::InsideAt(end) => {
                let across = ring_cross(&parts.axis, &parts.moment[end]);
                let reach = parts.radius.times(&Self::Across.of(parts));
                reach.squared().minus(&ring_dot(&across, &across))
            }
            Self::Turned => ring_dot(n, n),
            Self::NotBefore => zero.minus(&ring_dot(&parts.moment[0], n)),
            Self::NotBeyond => ring_dot(&parts.moment[1], n),
            Self::Near => {
                let reach = parts.radius.squared().times(&ring_dot(n, n));
                reach.minus(&ring_dot(&parts.offset[0], n).squared())
            }
            Self::Height(end) => ring_dot(&parts.offset[end], &parts.axis),
            Self::Outside => {
                let across = ring_cross(&parts.offset[0], &parts.axis);
                let reach = parts.radius.squared().times(&ring_dot(&parts.axis, &parts.axis));
                ring_dot(&across, &across).minus(&reach)
            }
            Self::Away => ring_dot(&ring_cross(&parts.offset[0], &parts.axis), n),
        }
    }

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

/// A line and a cylinder.
impl<W: FnOnce() -> Whole<Form>> Question<Form, W> {
    fn chord(&self) -> Option<Chord> {
        let across = self.sign(Form::Across);
        if across.is_eq() {
            return self.is_near().then(|| self.between_roots([Ordering::Greater; 2]));
        }
        let at_ends = [Form::InsideAt(0), Form::InsideAt(1)].map(|form| self.sign(form).reverse());
        let meets = at_ends.iter().any(|at| at.is_le()) || self.is_near();
        meets.then(|| self.between_roots(if across.is_gt() { at_ends } else { [at_ends[1], at_ends[0]] }))
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
