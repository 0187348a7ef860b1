//! How products are added.

use crate::math::{Lane, Vec3, fused_dot};

pub(super) trait Products {
    fn dot<L: Lane>(a: Vec3<L>, b: Vec3<L>) -> L;
    /// `a - times b`.
    fn less<L: Lane>(a: Vec3<L>, b: Vec3<L>, times: L) -> Vec3<L>;
}

/// Each rounded on its own, which gives the same bits everywhere.
pub(super) struct Plain;

/// Fused where the build fuses: see [`Lane::mul_add_fast`].
pub(super) struct Fused;

impl Products for Plain {
    #[inline(always)]
    fn dot<L: Lane>(a: Vec3<L>, b: Vec3<L>) -> L {
        a.dot(b)
    }
    #[inline(always)]
    fn less<L: Lane>(a: Vec3<L>, b: Vec3<L>, times: L) -> Vec3<L> {
        a - b * times
    }
}

impl Products for Fused {
    #[inline(always)]
    fn dot<L: Lane>(a: Vec3<L>, b: Vec3<L>) -> L {
        fused_dot(a, b)
    }
    #[inline(always)]
    fn less<L: Lane>(a: Vec3<L>, b: Vec3<L>, times: L) -> Vec3<L> {
        let less = -times;
        Vec3::new(b.x.mul_add_fast(less, a.x), b.y.mul_add_fast(less, a.y), b.z.mul_add_fast(less, a.z))
    }
}
