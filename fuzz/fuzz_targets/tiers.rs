//! Small scenes against exact arithmetic: every kernel and every way through the tree keeps what its tier promises, as
//! `octray verify` measures it.
#![no_main]

use libfuzzer_sys::arbitrary::{self, Arbitrary};
use libfuzzer_sys::fuzz_target;
use octray::measure::verify::{Bounds, Claim, Shape, Trial, verify_trial};
use octray::{Ray, TierName};

/// A coordinate on a grid that makes things touch, beside it, any bits of a mantissa, or any bits at all.
#[derive(Arbitrary, Clone, Copy, Debug)]
enum Number {
    Grid(i8),
    Beside(i8),
    Mantissa(u32),
    Bits(u32),
}

/// Magnitudes whose products `f64` holds: the domain of tier `exact`.
const EXACT: std::ops::Range<f32> = 1e-30..1e18;

impl Number {
    /// In units of a scene's size, but for any bits.
    fn value(self, size: f32) -> f32 {
        match self {
            Number::Grid(i) => f32::from(i) * 0.25 * size,
            Number::Beside(i) => (f32::from(i) * 0.25 * size).next_up(),
            Number::Mantissa(bits) => {
                let one = f32::from_bits(0x3f80_0000 | bits >> 9);
                if bits & 1 == 0 { one * size } else { -one * size }
            }
            Number::Bits(bits) => Some(f32::from_bits(bits)).filter(|x| EXACT.contains(&x.abs())).unwrap_or(0.0),
        }
    }

    fn is_of_the_size(self) -> bool {
        !matches!(self, Number::Bits(_))
    }
}

type Point = [Number; 3];

#[derive(Arbitrary, Clone, Debug)]
enum Thing {
    Triangle([Point; 3]),
    Sphere(Point, Number),
    Cylinder(Point, Point, Number),
}

#[derive(Arbitrary, Debug)]
struct Input {
    /// Power of two that lengths are multiples of.
    size: i8,
    /// The same for directions.
    length: i8,
    things: Vec<Thing>,
    /// Where from, and where to: a place, or the way there.
    rays: Vec<(Point, Point, bool)>,
}

/// Most of each: every pair is asked of the oracle.
const MOST: usize = 8;

fn has_area(corners: &[[f32; 3]; 3]) -> bool {
    let [a, b, c] = corners.map(|p| p.map(f64::from));
    let [u, v]: [[f64; 3]; 2] = [b, c].map(|p| std::array::from_fn(|k| p[k] - a[k]));
    [(1, 2), (2, 0), (0, 1)].iter().any(|&(i, j)| u[i] * v[j] != u[j] * v[i])
}

impl Thing {
    fn shape(&self, size: f32) -> Option<Shape> {
        let point = |p: &Point| p.map(|x| x.value(size));
        let length = |x: Number| Some(x.value(size).abs()).filter(|r| *r > 0.0);
        match self {
            Thing::Triangle(corners) => {
                let corners = corners.map(|p| point(&p));
                has_area(&corners).then_some(Shape::Triangle(corners))
            }
            Thing::Sphere(center, radius) => {
                Some(Shape::Sphere { center: point(center), radius: length(*radius)? })
            }
            Thing::Cylinder(from, to, radius) => {
                let (from, to) = (point(from), point(to));
                (from != to).then_some(Shape::Cylinder { from, to, radius: length(*radius)? })
            }
        }
    }

    fn is_of_the_size(&self) -> bool {
        let point = |p: &Point| p.iter().all(|x| x.is_of_the_size());
        match self {
            Thing::Triangle(corners) => corners.iter().all(point),
            Thing::Sphere(center, radius) => point(center) && radius.is_of_the_size(),
            Thing::Cylinder(from, to, radius) => point(from) && point(to) && radius.is_of_the_size(),
        }
    }
}

fn trial(input: &Input, size: f32, length: f32) -> Option<Trial> {
    let shapes: Vec<Shape> = input.things.iter().take(MOST).filter_map(|thing| thing.shape(size)).collect();
    let rays: Vec<Ray> = input.rays.iter().take(MOST).filter_map(|ray| a_ray(ray, size, length)).collect();
    (!shapes.is_empty() && !rays.is_empty()).then_some(Trial { shapes, rays, claim: Claim::Exact })
}

fn a_ray((from, to, aimed): &(Point, Point, bool), size: f32, length: f32) -> Option<Ray> {
    let origin = from.map(|x| x.value(size));
    let direction = match aimed {
        true => std::array::from_fn(|k| (to[k].value(size) - origin[k]) / size * length),
        false => to.map(|x| x.value(length)),
    };
    let fits = |x: f32| x == 0.0 || EXACT.contains(&x.abs());
    (direction != [0.0; 3] && direction.iter().all(|&x| fits(x))).then(|| Ray::new(origin, direction))
}

fuzz_target!(|input: Input| {
    // Sizes of 1e-12 to 1e9, directions of length 1e-18 to 1e18.
    let exponent = |power: i8, reach: i32| i32::from(power) * reach / 128;
    let (size, length) = (exponent(input.size, 35) - 5, exponent(input.length, 58));
    let Some(trial) = trial(&input, 2f32.powi(size), 2f32.powi(length)) else { return };
    let zero = Some(0.0);
    let check = |tier, bounds: &Bounds| {
        let breaches = verify_trial(&trial, tier, bounds).breaches();
        assert!(breaches.is_empty(), "{breaches:#?}");
    };
    let points = |(from, to, _): &(Point, Point, bool)| from.iter().chain(to).all(|x| x.is_of_the_size());
    let ordinary = input.things.iter().all(Thing::is_of_the_size) && input.rays.iter().all(points);
    check(TierName::Exact, &Bounds { wrong: zero, differing: zero, ..Bounds::default() });
    let gross = if ordinary { zero } else { None };
    check(TierName::Watertight, &Bounds { gross, differing: zero, ..Bounds::default() });
    if ordinary && size.abs() < 20 && length.abs() < 20 {
        check(TierName::Fast, &Bounds { gross, differing: zero, ..Bounds::default() });
    }
});
