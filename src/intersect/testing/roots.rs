//! The pair `q / a`, `c / q`: a root near zero keeps its digits, which a difference of `b` and the square root would lose.

use super::dice::Dice;
use super::ray;
use crate::intersect::{Curved, LaneHit, RayLanes, curved, cylinder, sphere};
use crate::math::{Real, Vec3};

/// Origins just outside of the unit circle across z, on a grid where `c` is exact, that look at its middle within 30
/// degrees; and where the circle is met, without a difference of large numbers.
fn just_outside<R: Real>(dice: &mut Dice, cells: f64) -> (RayLanes<R>, f64) {
    let aside = (dice.below(13) as f64 + 3.0) / cells;
    let angle = dice.between(-0.5, 0.5);
    let d = [angle.cos(), angle.sin()].map(R::from_f64);
    let r = ray([-1.0, aside, 1.0].map(R::from_f64), [d[0], d[1], R::zero()]);
    let d = d.map(Real::to_f64);
    let (a, b, c) = (d[0] * d[0] + d[1] * d[1], aside * d[1] - d[0], aside * aside);
    (r, c / ((b * b - a * c).sqrt() - b))
}

fn assert_near_roots<R: Real>(name: &str, cells: f64, solve: impl Fn(&RayLanes<R>) -> LaneHit<R>) {
    let mut dice = Dice(71);
    for _ in 0..20_000 {
        let (r, near) = just_outside(&mut dice, cells);
        let hit = solve(&r);
        let off = (hit.t.to_f64() - near).abs() / (near * R::ROUNDOFF);
        assert!(
            hit.mask && off <= 16.0,
            "{name}: the root near zero lost its digits: {:?} is {off} roundoffs from {near:e}, of {r:?}",
            hit.t
        );
    }
}

/// Cells of the grids: `c` is 1e-4 and more in `f32`, 1e-14 and more in `f64`.
const F32_CELLS: f64 = 256.0;
const F64_CELLS: f64 = 16_777_216.0;

fn ball<R: Real>() -> sphere::Lanes<R> {
    sphere::Lanes { center: Vec3::splat([0.0, 0.0, 1.0].map(R::from_f64)), radius: R::one() }
}

fn rod<R: Real>() -> cylinder::Lanes<R> {
    let ends = [[0.0; 3], [0.0, 0.0, 2.0]].map(|p| Vec3::splat(p.map(R::from_f64)));
    cylinder::Lanes { from: ends[0], to: ends[1], radius: R::one(), capped: true }
}

#[test]
fn a_sphere_in_f32_is_met_where_it_is_by_rays_from_its_surface() {
    assert_near_roots::<f32>("sphere in f32", F32_CELLS, |r| sphere::solve(r, &ball()));
}

#[test]
fn a_cylinder_in_f32_is_met_where_it_is_by_rays_from_its_surface() {
    assert_near_roots::<f32>("cylinder in f32", F32_CELLS, |r| cylinder::solve(r, &rod()));
}

/// As the tier `Exact` asks.
#[test]
fn a_sphere_in_f64_is_met_where_it_is_by_rays_from_its_surface() {
    assert_near_roots::<f64>("sphere in f64", F64_CELLS, |r| curved::Widened::sphere(r, &ball()));
}

/// As the tier `Exact` asks.
#[test]
fn a_cylinder_in_f64_is_met_where_it_is_by_rays_from_its_surface() {
    assert_near_roots::<f64>("cylinder in f64", F64_CELLS, |r| curved::Widened::cylinder(r, &rod()));
}
