//! Rays that start on curved surfaces, or so near to them that `f64` does not tell on which side: tier `Exact` hits what exact
//! arithmetic says is ahead of them, and nothing else.

use std::ops::Range;

use proptest::prelude::*;
use proptest::sample::select;

use super::ray;
use crate::intersect::curved::Widened;
use crate::intersect::oracle::{self, Line, Shape, surfaces};
use crate::intersect::{Curved, LaneHit, RayLanes, cylinder, sphere};
use crate::math::{Real, Vec3};

type Point = [f64; 3];

/// Vectors at right angles, all of one length, and that.
type Frame = ([Point; 3], f64);

fn frames() -> impl Strategy<Value = Frame> {
    let upright = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let askew = [[1.0, 2.0, 2.0], [2.0, 1.0, -2.0], [2.0, -2.0, 1.0]];
    (select(vec![(upright, 1.0), (askew, 3.0)]), 0..3usize).prop_map(|((mut axes, length), turns)| {
        axes.rotate_left(turns);
        (axes, length)
    })
}

fn combined(axes: &[Point; 3], by: [f64; 3]) -> Point {
    std::array::from_fn(|k| (0..3).map(|i| axes[i][k] * by[i]).sum())
}

/// A circle of radius 5 through points of the grid.
fn on_circle() -> impl Strategy<Value = [f64; 2]> {
    select(vec![[5.0, 0.0], [0.0, -5.0], [3.0, 4.0], [4.0, -3.0], [-4.0, -3.0], [-3.0, 4.0]])
}

fn whole(range: Range<i32>) -> impl Strategy<Value = f64> {
    range.prop_map(f64::from)
}

/// What becomes of a coordinate, in a scene of some size.
#[derive(Clone, Copy, Debug)]
enum Nudge {
    Ulps(i64),
    By(f64),
}

impl Nudge {
    fn of(self, x: f64, size: f64) -> f64 {
        match self {
            Self::Ulps(n) if x != 0.0 => f64::from_bits(x.to_bits().wrapping_add_signed(n)),
            Self::Ulps(_) => x,
            Self::By(by) => x + by * size,
        }
    }
}

fn nudges() -> impl Strategy<Value = [Nudge; 3]> {
    let tiny = (-45.0..-8.0f64, any::<bool>()).prop_map(|(power, up)| {
        let by = 10f64.powf(power);
        Nudge::By(if up { by } else { -by })
    });
    let one = prop_oneof![5 => Just(Nudge::Ulps(0)), 3 => (-3..4i64).prop_map(Nudge::Ulps), 2 => tiny];
    prop::array::uniform3(one)
}

/// Where a ray starts on the grid, in units of the frame, and goes.
#[derive(Clone, Debug)]
struct Start {
    frame: Frame,
    middle: Point,
    size: f64,
    nudges: [Nudge; 3],
    way: [f64; 3],
    way_nudges: [Nudge; 3],
}

fn starts() -> impl Strategy<Value = Start> {
    let on_grid = || prop::array::uniform3(whole(-3..4));
    let ways = prop_oneof![on_grid(), prop::array::uniform3(-1.0..1.0f64)]
        .prop_filter("a ray goes somewhere", |way| *way != [0.0; 3]);
    (frames(), on_grid(), -30..30i32, nudges(), ways, nudges()).prop_map(
        |(frame, middle, power, nudges, way, way_nudges)| Start {
            frame,
            middle,
            size: 2f64.powi(power),
            nudges,
            way,
            way_nudges,
        },
    )
}

impl Start {
    /// A point of the grid, in the frame around the middle.
    fn place(&self, by: [f64; 3]) -> Point {
        let moved = combined(&self.frame.0, by);
        std::array::from_fn(|k| (self.middle[k] + moved[k]) * self.size)
    }

    fn ray_from(&self, by: [f64; 3]) -> RayLanes<f64> {
        let (on, way) = (self.place(by), combined(&self.frame.0, self.way));
        let origin = std::array::from_fn(|k| self.nudges[k].of(on[k], self.size));
        ray(origin, std::array::from_fn(|k| self.way_nudges[k].of(way[k], 1.0)))
    }

    fn radius(&self) -> f64 {
        5.0 * self.frame.1 * self.size
    }
}

fn assert_right(r: &RayLanes<f64>, hit: LaneHit<f64>, shape: &Shape) -> Result<(), TestCaseError> {
    let line = Line { origin: r.origin.get(0), direction: r.direction.get(0) };
    let ends = surfaces(&line, shape);
    let ahead = (0..2).find(|&i| ends[i].is_some_and(|t| t > 0.0));
    let (got, want) = ((hit.mask && hit.t > 0.0).then_some(hit.t), ahead.and_then(|i| ends[i]));
    prop_assert_eq!(got.is_some(), want.is_some(), "{:?}, exactly {:?}: {:?} by {:?}", got, want, shape, r);
    if let (Some(got), Some(want), Some(i)) = (got, want, ahead) {
        // What is out of doubt is still known no better than as if the surface were some roundoffs aside.
        let by = 64.0 * f64::ROUNDOFF * (shape.magnitude() + r.origin.length());
        let moved = [by, -by].map(|by| shape.grown(by).and_then(|shape| surfaces(&line, &shape)[i]));
        let off = moved.map(|t| t.map_or(f64::INFINITY, |t| (t - want).abs()));
        let slack = 1e-7 * want + off[0].max(off[1]);
        prop_assert!((got - want).abs() <= slack, "{} for {}: {:?} by {:?}", got, want, shape, r);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn what_is_ahead_of_a_ray_from_a_sphere_is_hit_and_nothing_else(start in starts(), at in on_circle()) {
        let (r, center, radius) = (start.ray_from([at[0], at[1], 0.0]), start.place([0.0; 3]), start.radius());
        let hit = Widened::sphere(&r, &sphere::Lanes { center: Vec3::splat(center), radius });
        assert_right(&r, hit, &Shape::Sphere { center, radius })?;
    }

    /// From the side, where it ends, or a cap.
    #[test]
    fn what_is_ahead_of_a_ray_from_a_cylinder_is_hit_and_nothing_else(
        start in starts(),
        at in on_circle(),
        [end, height] in prop::array::uniform2(whole(0..4)),
        inwards in select(vec![1.0, 1.0, 0.5, 0.0]),
        capped in any::<bool>(),
    ) {
        let end = end + 1.0;
        let r = start.ray_from([at[0] * inwards, at[1] * inwards, height.min(end)]);
        let ([from, to], radius) = ([start.place([0.0; 3]), start.place([0.0, 0.0, end])], start.radius());
        let ends = [from, to].map(Vec3::splat);
        let hit = Widened::cylinder(&r, &cylinder::Lanes { from: ends[0], to: ends[1], radius, capped });
        assert_right(&r, hit, &Shape::Cylinder(oracle::Cylinder { from, to, radius, capped }))?;
    }
}
