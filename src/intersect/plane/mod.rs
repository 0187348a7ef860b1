//! Ray against infinite plane.

use crate::intersect::{LaneHit, RayLanes};
use crate::math::{Lane, Vec3};

/// Planes as lanes.
#[derive(Clone, Copy, Debug)]
pub struct Lanes<L> {
    /// A point on the plane.
    pub point: Vec3<L>,
    /// Its normal, any length.
    pub normal: Vec3<L>,
}

/// Where the line of the ray meets the plane, solved in `f64`: a plane reaches far enough for `f32` to lose it.
#[inline(always)]
pub fn solve<L: Lane>(ray: &RayLanes<L>, p: &Lanes<L>) -> LaneHit<L> {
    let normal = p.normal.widen();
    let height = normal.dot(p.point.widen() - ray.origin.widen());
    let t = height / normal.dot(ray.direction.widen());
    LaneHit { mask: L::narrow_mask(t.is_finite()), t: L::narrow(t), u: L::zero(), v: L::zero() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parallel_ray_misses_even_inside_the_plane() {
        let plane = Lanes::<f32> { point: Vec3::splat([0.0; 3]), normal: Vec3::splat([0.0, 1.0, 0.0]) };
        for height in [0.0, 1.0] {
            let ray = RayLanes {
                origin: Vec3::splat([0.0, height, 0.0]),
                direction: Vec3::splat([1.0, 0.0, 0.0]),
                t_min: 0.0,
                t_max: f32::INFINITY,
            };
            assert!(!solve(&ray, &plane).mask);
        }
    }
}
