//! The pair `q / a`, `c / q`: a root near zero keeps its digits, which a difference of `b` and the square root would lose.

use super::dice::Dice;
use super::{ray, ulps};
use crate::intersect::{LaneHit, RayLanes, cylinder, sphere};
use crate::math::Vec3;

/// Origins just outside of the unit circle across z, on a grid where `c` is exact, that look at its middle within 30
/// degrees; and where the circle is met, without a difference of large numbers.
fn just_outside(dice: &mut Dice) -> (RayLanes<f32>, f64) {
    let grid = dice.below(13) as f64 + 3.0;
    let angle = dice.between(-0.5, 0.5);
    let (o, d) = ([-1.0, grid / 256.0], [angle.cos() as f32, angle.sin() as f32]);
    let r = ray([o[0] as f32, o[1] as f32, 1.0], [d[0], d[1], 0.0]);
    let d = d.map(f64::from);
    let (a, b, c) = (d[0] * d[0] + d[1] * d[1], o[0] * d[0] + o[1] * d[1], grid * grid / 65536.0);
    (r, c / ((b * b - a * c).sqrt() - b))
}

fn assert_near_roots(name: &str, solve: impl Fn(&RayLanes<f32>) -> LaneHit<f32>) {
    let mut dice = Dice(71);
    for _ in 0..20_000 {
        let (r, near) = just_outside(&mut dice);
        let hit = solve(&r);
        let off = ulps(hit.t, near);
        assert!(hit.mask && off <= 8.0, "{name}: {} is {off} ulps from {near}, of {r:?}", hit.t);
    }
}

#[test]
fn a_sphere_in_f32_is_met_where_it_is_by_rays_from_its_surface() {
    let unit = sphere::Lanes { center: Vec3::splat([0.0, 0.0, 1.0]), radius: 1.0 };
    assert_near_roots("sphere", |r| sphere::solve(r, &unit));
}

#[test]
fn a_cylinder_in_f32_is_met_where_it_is_by_rays_from_its_surface() {
    let ends = [[0.0; 3], [0.0, 0.0, 2.0]].map(Vec3::splat);
    let unit = cylinder::Lanes { from: ends[0], to: ends[1], radius: 1.0, capped: true };
    assert_near_roots("cylinder", |r| cylinder::solve(r, &unit));
}
