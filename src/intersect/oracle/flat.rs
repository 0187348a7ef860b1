//! Triangles and boxes.

use dashu::integer::IBig;

use super::Line;
use super::number::{Unit, ratio};

/// `t` where the line meets the closed triangle; nothing for one seen exactly edge-on or without area.
///
/// **Accuracy:** the decision is exact, `t` is the nearest `f64`.
pub fn triangle(line: &Line, corners: [[f64; 3]; 3]) -> Option<f64> {
    let numbers = corners.iter().chain([&line.origin, &line.direction]).flatten();
    let unit = Unit::of(numbers.copied());
    let (origin, d) = (unit.point(line.origin), unit.point(line.direction));
    let [a, b, c] = corners.map(|v| unit.point(v).minus(&origin));
    let volumes = [d.dot(&b.cross(&c)), d.dot(&c.cross(&a)), d.dot(&a.cross(&b))];
    let zero = IBig::ZERO;
    let inside = volumes.iter().all(|v| *v >= zero) || volumes.iter().all(|v| *v <= zero);
    // The sum of the volumes is the product of normal and direction: zero where the plane is seen edge-on.
    let slope: IBig = volumes.into_iter().sum();
    (inside && slope != zero).then(|| {
        let normal = b.minus(&a).cross(&c.minus(&a));
        ratio(normal.dot(&a), slope)
    })
}

/// First and last `t` of the line inside the closed box.
///
/// **Accuracy:** the decision is exact, each `t` is the nearest `f64`.
pub fn aabb(line: &Line, min: [f64; 3], max: [f64; 3]) -> Option<[f64; 2]> {
    let unit = Unit::of([min, max, line.origin, line.direction].into_iter().flatten());
    let mut inside = Span::everything();
    for k in 0..3 {
        let [lo, hi, o, d] = [min[k], max[k], line.origin[k], line.direction[k]].map(|x| unit.lift(x));
        let (enter, leave) = (lo - &o, hi - o);
        match d.cmp(&IBig::ZERO) {
            std::cmp::Ordering::Greater => inside.clip((enter, d.clone()), (leave, d)),
            std::cmp::Ordering::Less => inside.clip((-leave, -d.clone()), (-enter, -d)),
            std::cmp::Ordering::Equal if enter > IBig::ZERO || leave < IBig::ZERO => return None,
            std::cmp::Ordering::Equal => {}
        }
    }
    inside.ends()
}

/// A quotient with a positive denominator.
type Quotient = (IBig, IBig);

fn is_less(a: &Quotient, b: &Quotient) -> bool {
    &a.0 * &b.1 < &b.0 * &a.1
}

/// An interval of `t`; an end that is not there is infinite.
struct Span {
    first: Option<Quotient>,
    last: Option<Quotient>,
}

impl Span {
    fn everything() -> Self {
        Self { first: None, last: None }
    }
    fn clip(&mut self, enter: Quotient, leave: Quotient) {
        if self.first.as_ref().is_none_or(|first| is_less(first, &enter)) {
            self.first = Some(enter);
        }
        if self.last.as_ref().is_none_or(|last| is_less(&leave, last)) {
            self.last = Some(leave);
        }
    }
    fn ends(self) -> Option<[f64; 2]> {
        let (first, last) = (self.first?, self.last?);
        (!is_less(&last, &first)).then(|| [ratio(first.0, first.1), ratio(last.0, last.1)])
    }
}
