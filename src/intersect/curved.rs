//! How a tier meets spheres and cylinders. What certainly misses is sorted out before, for all tiers alike, in the number type of
//! the lanes and without a quotient or a root.

use super::{LaneHit, RayLanes, cylinder, sphere};
use crate::math::{Lane, Mask};

/// How spheres and cylinders are met.
pub trait Curved: Copy + Send + Sync + 'static {
    /// Meets those lanes, which may hit, with their spheres.
    fn hit_sphere<L: Lane>(lanes: L::Mask, ray: &RayLanes<L>, sphere: &sphere::Lanes<L>) -> LaneHit<L>;
    /// Meets those lanes, which may hit, with their cylinders.
    fn hit_cylinder<L: Lane>(lanes: L::Mask, ray: &RayLanes<L>, cylinder: &cylinder::Lanes<L>) -> LaneHit<L>;

    /// Meets rays with spheres.
    #[inline(always)]
    fn sphere<L: Lane>(ray: &RayLanes<L>, sphere: &sphere::Lanes<L>) -> LaneHit<L> {
        let lanes = sphere::may_hit(ray, sphere);
        if lanes.any() { Self::hit_sphere(lanes, ray, sphere) } else { LaneHit::none() }
    }
    /// Meets rays with cylinders.
    #[inline(always)]
    fn cylinder<L: Lane>(ray: &RayLanes<L>, cylinder: &cylinder::Lanes<L>) -> LaneHit<L> {
        let lanes = cylinder::may_hit(ray, cylinder);
        if lanes.any() { Self::hit_cylinder(lanes, ray, cylinder) } else { LaneHit::none() }
    }
}

/// Solves in the number type of the lanes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Direct;

/// Solves in `f64`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Widened;

impl Curved for Direct {
    #[inline(always)]
    fn hit_sphere<L: Lane>(lanes: L::Mask, ray: &RayLanes<L>, s: &sphere::Lanes<L>) -> LaneHit<L> {
        sphere::solve(ray, s).among(lanes)
    }
    #[inline(always)]
    fn hit_cylinder<L: Lane>(lanes: L::Mask, ray: &RayLanes<L>, c: &cylinder::Lanes<L>) -> LaneHit<L> {
        cylinder::solve(ray, c).among(lanes)
    }
}

impl Curved for Widened {
    #[inline(always)]
    fn hit_sphere<L: Lane>(lanes: L::Mask, ray: &RayLanes<L>, s: &sphere::Lanes<L>) -> LaneHit<L> {
        sphere::solve_widened(lanes, ray, s)
    }
    #[inline(always)]
    fn hit_cylinder<L: Lane>(lanes: L::Mask, ray: &RayLanes<L>, c: &cylinder::Lanes<L>) -> LaneHit<L> {
        cylinder::solve_widened(lanes, ray, c)
    }
}
