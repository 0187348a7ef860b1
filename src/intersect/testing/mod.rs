//! What the tests of the kernels and `octray verify` share: dice, closed meshes, ulps; and for the tests alone the exact
//! oracle, one battery for all widths, lines.

#[cfg(test)]
mod conservative;
pub(crate) mod dice;
#[cfg(test)]
pub(crate) mod exact;
#[cfg(test)]
pub(crate) mod grazing;
#[cfg(test)]
mod lanes;
pub(crate) mod meshes;
#[cfg(test)]
pub(crate) mod pressed;
#[cfg(test)]
mod roots;
#[cfg(test)]
mod starts;

#[cfg(test)]
use super::{LaneHit, RayLanes};
#[cfg(test)]
use crate::math::{Real, Vec3};

/// A ray without bounds, so that a test sees every meeting of the line.
#[cfg(test)]
pub(crate) fn line<R: Real>(origin: [R; 3], direction: [R; 3]) -> RayLanes<R> {
    let (t_min, t_max) = (R::constant(f64::NEG_INFINITY), R::constant(f64::INFINITY));
    RayLanes { origin: Vec3::splat(origin), direction: Vec3::splat(direction), t_min, t_max }
}

/// A ray that starts at its origin.
#[cfg(test)]
pub(crate) fn ray<R: Real>(origin: [R; 3], direction: [R; 3]) -> RayLanes<R> {
    RayLanes { t_min: R::constant(0.0), ..line(origin, direction) }
}

/// `t` of a scalar hit, if it is one.
#[cfg(test)]
pub(crate) fn t_of<R: Real>(hit: LaneHit<R>) -> Option<R> {
    hit.mask.then_some(hit.t)
}

/// How many representable `f32` lie between the two, or half of one for less than that.
pub(crate) fn ulps(got: f32, exact: f64) -> f64 {
    let nearest = exact as f32;
    let spacing = f64::from(nearest.abs().next_up()) - f64::from(nearest.abs());
    (f64::from(got) - exact).abs() / spacing
}

/// The value below which the given share of the numbers lies.
pub(crate) fn percentile(values: &mut [f64], share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[((values.len() - 1) as f64 * share) as usize]
}
