//! Hit or miss without rounding: all coordinates as whole numbers of the same tiny unit.
//!
//! Decisions compare squares and never take a root; only the value of `t` does, with hundreds of spare digits.

use dashu::base::{SquareRoot, UnsignedAbs};
use dashu::integer::IBig;
use dashu::rational::Relaxed;

use crate::intersect::RayLanes;
use crate::math::{Real, Vec3};

/// Coordinates are multiples of 2^-300: all `f32`, and `f64` down to 1e-74.
const UNIT_EXPONENT: i32 = 300;

#[derive(Clone)]
pub(crate) struct Point([IBig; 3]);

fn lift(x: f64) -> IBig {
    assert!(x.is_finite());
    let bits = x.to_bits();
    let biased = (bits >> 52 & 0x7ff) as i32;
    let mantissa = (bits & ((1 << 52) - 1)) | if biased == 0 { 0 } else { 1 << 52 };
    let shift = biased.max(1) - 1075 + UNIT_EXPONENT;
    let magnitude = if shift >= 0 {
        IBig::from(mantissa) << shift as usize
    } else {
        assert!(
            mantissa.trailing_zeros() as i32 >= -shift || mantissa == 0,
            "{x} is no multiple of the unit"
        );
        IBig::from(mantissa) >> (-shift) as usize
    };
    if x < 0.0 { -magnitude } else { magnitude }
}

impl Point {
    pub(crate) fn new<R: Real>(p: Vec3<R>) -> Self {
        Self(p.get(0).map(|x| lift(x.to_f64())))
    }
    fn minus(&self, o: &Self) -> Self {
        Self(std::array::from_fn(|k| &self.0[k] - &o.0[k]))
    }
    fn times(&self, s: &IBig) -> Self {
        Self(std::array::from_fn(|k| &self.0[k] * s))
    }
    fn dot(&self, o: &Self) -> IBig {
        (0..3).map(|k| &self.0[k] * &o.0[k]).sum()
    }
    fn cross(&self, o: &Self) -> Self {
        let term = |i: usize, j: usize| &self.0[i] * &o.0[j] - &self.0[j] * &o.0[i];
        Self([term(1, 2), term(2, 0), term(0, 1)])
    }
}

fn ratio(numerator: IBig, denominator: IBig) -> f64 {
    Relaxed::from_parts_signed(numerator, denominator).to_f64().value()
}

/// `t` where the line meets the triangle, edges included; nothing for one seen edge-on.
pub(crate) fn triangle<R: Real>(ray: &RayLanes<R>, vertices: [Vec3<R>; 3]) -> Option<f64> {
    let (origin, d) = (Point::new(ray.origin), Point::new(ray.direction));
    let [a, b, c] = vertices.map(|v| Point::new(v).minus(&origin));
    let volumes = [d.dot(&b.cross(&c)), d.dot(&c.cross(&a)), d.dot(&a.cross(&b))];
    let zero = IBig::ZERO;
    let inside = volumes.iter().all(|v| *v >= zero) || volumes.iter().all(|v| *v <= zero);
    let normal = b.minus(&a).cross(&c.minus(&a));
    let slope = normal.dot(&d);
    (inside && slope != zero).then(|| ratio(normal.dot(&a), slope))
}

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
    /// Whether the line is inside at `t = p / q`.
    fn inside_at(&self, p: &IBig, q: &IBig) -> bool {
        &self.a * p * p + IBig::from(2) * &self.b * p * q + &self.c * q * q <= IBig::ZERO
    }
    /// Both roots rounded to `f64`.
    fn roots(&self) -> Option<[f64; 2]> {
        let discriminant = self.discriminant();
        if discriminant < IBig::ZERO {
            return None;
        }
        // More digits before the root: it rounds down to a whole number.
        let root = IBig::from((discriminant << 256usize).unsigned_abs().sqrt());
        let (b, a) = (&self.b << 128usize, &self.a << 128usize);
        Some([ratio(-&b - &root, a.clone()), ratio(root - b, a)])
    }
}

/// Where the line enters and leaves the sphere.
pub(crate) fn sphere<R: Real>(ray: &RayLanes<R>, center: Vec3<R>, radius: f64) -> Option<[f64; 2]> {
    let offset = Point::new(ray.origin).minus(&Point::new(center));
    Quadratic::new(&offset, &Point::new(ray.direction), &lift(radius)).roots()
}

/// Whether the line meets the capped cylinder with the radius and both ends grown by `margin`, which may be negative.
pub(crate) fn cylinder<R: Real>(ray: &RayLanes<R>, ends: [Vec3<R>; 2], radius: f64, margin: f64) -> bool {
    let [from, to] = ends.map(Point::new);
    let axis = to.minus(&from);
    let (f, d) = (Point::new(ray.origin).minus(&from), Point::new(ray.direction));
    let (axis2, along_f, along_d) = (axis.dot(&axis), f.dot(&axis), d.dot(&axis));
    // Everything across the axis times its squared length, which keeps it whole.
    let across = |v: &Point, along: &IBig| v.times(&axis2).minus(&axis.times(along));
    let side = Quadratic::new(
        &across(&f, &along_f),
        &across(&d, &along_d),
        &(lift(rounded(radius + margin)) * &axis2),
    );
    let length = ends[1].widen() + -ends[0].widen();
    let growth = lift(rounded(margin)) * lift(rounded(length.length()));
    let (low, high) = (-&growth, &axis2 + &growth);
    let zero = IBig::ZERO;
    if along_d == zero {
        return along_f >= low && along_f <= high && side.discriminant() >= zero && side.a != zero;
    }
    if side.a == zero {
        return side.c <= zero;
    }
    let level_t = |level: IBig| level - &along_f;
    let (p0, p1) = (level_t(low), level_t(high));
    if side.inside_at(&p0, &along_d) || side.inside_at(&p1, &along_d) {
        return true;
    }
    // Inside at neither cap: then the nearest approach, at t = -b / a, must lie between them.
    let height = |p: &IBig| p * &side.a + &side.b * &along_d;
    let (h0, h1) = (height(&p0), height(&p1));
    side.discriminant() >= zero && ((h0 <= zero && h1 >= zero) || (h0 >= zero && h1 <= zero))
}

/// Numbers that a margin made finer than the unit.
fn rounded(x: f64) -> f64 {
    if x.abs() < 1e-70 { 0.0 } else { x }
}

#[test]
fn decides_what_f64_cannot() {
    let sliver = [[0.0, 0.0, 1.0], [1e30, 0.0, 1.0], [0.0, 1e-30, 1.0]].map(Vec3::<f64>::splat);
    let at = |y: f64| super::line([1e29, y, 0.0], [0.0, 0.0, 1.0]);
    assert!(triangle(&at(0.8e-30), sliver).is_some() && triangle(&at(0.95e-30), sliver).is_none());
    let tangent = super::line([1.0f64, 0.0, -5.0], [0.0, 0.0, 1.0]);
    let beside = super::line([1.0f64.next_up(), 0.0, -5.0], [0.0, 0.0, 1.0]);
    assert_eq!(sphere(&tangent, Vec3::zero(), 1.0), Some([5.0, 5.0]));
    assert_eq!(sphere(&beside, Vec3::zero(), 1.0), None);
    let ends = [Vec3::zero(), Vec3::splat([0.0, 2.0, 0.0])];
    assert!(cylinder(&tangent, ends, 1.0, 0.0) && !cylinder(&beside, ends, 1.0, 0.0));
}
