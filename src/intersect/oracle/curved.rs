//! Spheres and cylinders.

use std::cmp::Ordering;

use dashu::base::{SquareRoot, UnsignedAbs};
use dashu::integer::IBig;

use super::number::{Point, Unit, ratio};
use super::{Cylinder, Line};

/// Bits after the point of a root.
const ROOT_BITS: usize = 128;

/// `a t^2 + 2 b t + c`, not above zero where the line is inside.
struct Quadratic {
    a: IBig,
    b: IBig,
    c: IBig,
}

impl Quadratic {
    fn new(offset: &Point, direction: &Point, radius: &IBig) -> Self {
        let c = offset.dot(offset) - radius * radius;
        Self { a: direction.dot(direction), b: offset.dot(direction), c }
    }
    fn discriminant(&self) -> IBig {
        &self.b * &self.b - &self.a * &self.c
    }
    /// Below zero where the line is inside at `t = p / q`.
    fn side_at(&self, p: &IBig, q: &IBig) -> Ordering {
        (&self.a * p * p + IBig::from(2) * &self.b * p * q + &self.c * q * q).cmp(&IBig::ZERO)
    }
    /// Both roots, the lesser first. The one nearer to zero comes from the other, so that neither cancels.
    fn roots(&self) -> Option<[f64; 2]> {
        let (zero, discriminant) = (IBig::ZERO, self.discriminant());
        if discriminant < zero {
            return None;
        }
        let root = IBig::from((discriminant << (2 * ROOT_BITS)).unsigned_abs().sqrt());
        let b = &self.b << ROOT_BITS;
        let far = if b >= zero { -b - root } else { root - b };
        if far == zero {
            return Some([0.0; 2]);
        }
        let near = ratio(&self.c << ROOT_BITS, far.clone());
        let far = ratio(far, &self.a << ROOT_BITS);
        Some([near.min(far), near.max(far)])
    }
}

/// Where the line enters and leaves the sphere; a tangent does both at once.
///
/// **Accuracy:** the decision is exact, each `t` is within one roundoff of `f64`.
pub fn sphere(line: &Line, center: [f64; 3], radius: f64) -> Option<[f64; 2]> {
    let unit = Unit::of([line.origin, line.direction, center].into_iter().flatten().chain([radius]));
    let offset = unit.point(line.origin).minus(&unit.point(center));
    Quadratic::new(&offset, &unit.point(line.direction), &unit.lift(radius)).roots()
}

/// Where the line enters and leaves the closed cylinder, and whether it does so on the curved side (the rims included)
/// rather than on a cap.
///
/// **Accuracy:** the decision is exact, each `t` is within one roundoff of `f64`.
pub fn cylinder(line: &Line, cylinder: &Cylinder) -> Option<[(f64, bool); 2]> {
    let Cylinder { from, to, radius, .. } = *cylinder;
    let unit = Unit::of([line.origin, line.direction, from, to].into_iter().flatten().chain([radius]));
    let from = unit.point(from);
    let axis = unit.point(to).minus(&from);
    let (f, d) = (unit.point(line.origin).minus(&from), unit.point(line.direction));
    let (axis2, along_f, along_d) = (axis.dot(&axis), f.dot(&axis), d.dot(&axis));
    // Everything across the axis times its squared length, which keeps it whole.
    let across = |v: &Point, along: &IBig| v.times(&axis2).minus(&axis.times(along));
    let side = Quadratic::new(&across(&f, &along_f), &across(&d, &along_d), &(unit.lift(radius) * &axis2));
    if along_d == IBig::ZERO {
        let between = along_f >= IBig::ZERO && along_f <= axis2;
        return side.roots().filter(|_| between).map(|roots| roots.map(|t| (t, true)));
    }
    // From here on `t = p / q` with a positive `q`.
    let (low, high) = (-&along_f, &axis2 - &along_f);
    let (enter, leave, q) = match along_d > IBig::ZERO {
        true => (low, high, along_d),
        false => (-high, -low, -along_d),
    };
    between_caps(&side, enter, leave, q)
}

/// The part of the line inside the side that lies between the caps, which it passes at `enter / q` and `leave / q`.
fn between_caps(side: &Quadratic, enter: IBig, leave: IBig, q: IBig) -> Option<[(f64, bool); 2]> {
    let at_cap = |p: &IBig| ratio(p.clone(), q.clone());
    if side.a == IBig::ZERO {
        let on_side = side.c == IBig::ZERO;
        return (side.c <= IBig::ZERO).then(|| [(at_cap(&enter), on_side), (at_cap(&leave), on_side)]);
    }
    let [first, last] = [&enter, &leave].map(|p| side.side_at(p, &q));
    if first == Ordering::Greater && last == Ordering::Greater {
        // Inside at neither cap: then the nearest approach, at t = -b / a, must lie between them.
        let height = |p: &IBig| p * &side.a + &side.b * &q;
        if height(&enter) > IBig::ZERO || height(&leave) < IBig::ZERO {
            return None;
        }
    }
    let [r0, r1] = side.roots()?;
    let end = |at: Ordering, p: &IBig, root: f64| match at {
        Ordering::Greater => (root, true),
        Ordering::Equal => (at_cap(p), true),
        Ordering::Less => (at_cap(p), false),
    };
    Some([end(first, &enter, r0), end(last, &leave, r1)])
}
