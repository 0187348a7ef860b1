//! Spheres and cylinders against the rays of a pyramid, by how far the rays pass by.
//!
//! Plainly: a ray of direction `d` passes a point `c` at `|c x d| / |d|`, and the line from `p` to `q` at
//! `|d . (p x q)| / |d x (q - p)|`, all relative to the apex. Departures:
//! - what is multiplied by `d = (x + a, y + b, 1)`, with `x` and `y` the middle slopes, is sheared by those, as for
//!   [`super::edges`]: then a ray counts by its slopes about the middle, few products each;
//! - lengths that change little from ray to ray are bounded for all: with `s` the largest slope about the middle,
//!   `|d x (q - p)|` is no more than that of the middle and `1.5 s |q - p|`, and of `|c x d|^2`, which is
//!   `u^2 + v^2 + (u y - v x + (u b - v a))^2` where the ray has `u, v` to go across to `c`, what stands in inner brackets
//!   takes no more than `4 s max(|x|, |y|)` of the rest;
//! - rays may be off by as much as the sides of the pyramid are moved outwards, on both axes, so distances by 1.5 times that:
//!   most of it is for boxes, and left for what the primitive tests of any tier may be off by.

use wide::f32x8;

use super::Frustum;
use crate::accel::block::Round;
use crate::math::{Lane, Mask, Real, Vec3, WIDTH, fused_cross};

/// Roundoffs in the products of corners: as in [`super::edges`].
const PRODUCT_ROUNDOFFS: f64 = 64.0;
/// More than what squares and roots are rounded by.
const SQUARES: f32 = 1.0 + 1e-5;

/// What rays that miss eight primitives have to exceed.
#[derive(Clone, Copy, Debug)]
pub(in super::super) enum Rounds {
    /// Spheres: the square of the way across to `center`, sheared, and of what `turn` makes of it.
    Spheres { center: Vec3<f32x8>, turn: [f32x8; 2], reach2: f32x8 },
    /// Cylinders: what the axis' moment makes of the ray.
    Cylinders { moment: Vec3<f32x8>, reach: f32x8 },
}

impl Frustum {
    /// What tells of eight primitives which rays may hit them.
    #[inline(always)]
    pub(in super::super) fn rounds(&self, round: Round<'_>) -> Rounds {
        // Parallel rays see all at one distance, and their slopes are coordinates there.
        let (directions, spread) = match self.view.lean {
            Some(lean) => (lean.map(f32x8::splat), f32x8::ZERO),
            None => (self.middle.slopes, self.middle.spread),
        };
        let [x, y] = directions;
        let steepest = Lane::max(x.abs(), y.abs());
        let [x1, y1] = directions.map(|slope| slope.abs() + spread);
        let direction2 = f32x8::ONE + x1 * x1 + y1 * y1;
        let off = self.side_pad * f32x8::splat(1.5);
        match round {
            Round::Spheres { center, radius } => {
                let left = f32x8::ONE - f32x8::splat(4.0) * spread * steepest;
                let is_narrow = left.gt(f32x8::splat(0.5));
                // Where rays go far apart the last square is left out, whatever it is.
                let turn = [x, y].map(|slope| Lane::select(is_narrow, slope, f32x8::ZERO));
                let left = Lane::select(is_narrow, left, f32x8::ONE);
                let reach = (f32x8::new(*radius) + off) * f32x8::splat(SQUARES);
                let reach2 = reach * reach * direction2 / left + f32x8::splat(f32::MIN_POSITIVE);
                Rounds::Spheres { center: self.sheared(self.seen(center)), turn, reach2 }
            }
            Round::Cylinders { ends, radius } => {
                let ends = ends.map(|end| self.seen(end));
                let length = (ends[1] - ends[0]).abs();
                let length = length.x + length.y + length.z;
                let [p, q] = ends.map(|end| self.sheared(end));
                let (axis, size) = (q - p, p.abs().max(q.abs()));
                let turned = x * axis.y - y * axis.x;
                let product = (axis.x * axis.x + axis.y * axis.y + turned * turned).sqrt();
                let product = (product + f32x8::splat(1.5) * spread * length) * f32x8::splat(SQUARES);
                let about = Lane::max(size.x, size.y) + self.middle.spread * size.z;
                let rounding = about * about * f32x8::splat((PRODUCT_ROUNDOFFS * f32::ROUNDOFF) as f32);
                let reach =
                    (f32x8::new(*radius) + off) * product + rounding + f32x8::splat(f32::MIN_POSITIVE);
                Rounds::Cylinders { moment: fused_cross(p, q), reach }
            }
        }
    }

    #[inline(always)]
    fn seen(&self, columns: &[[f32; WIDTH]; 3]) -> Vec3<f32x8> {
        self.view.point(|k| f32x8::new(columns[k]))
    }

    /// A point as rays of the middle slopes see it, before them.
    #[inline(always)]
    fn sheared(&self, p: Vec3<f32x8>) -> Vec3<f32x8> {
        let ([x, y], z) = (self.middle.slopes, if self.view.lean.is_some() { f32x8::ONE } else { p.z });
        Vec3::new(p.x - x * z, p.y - y * z, z)
    }

    /// Lanes of packet `j` whose rays do not certainly miss primitive `i`, as bits.
    #[inline(always)]
    pub(in super::super) fn may_hit(&self, rounds: &Rounds, i: usize, j: usize) -> u32 {
        let at = |v: &f32x8| f32x8::splat(v.get(i));
        let [a, b] = self.rays[j].slopes;
        let misses = match rounds {
            Rounds::Spheres { center: c, turn: [x, y], reach2 } => {
                let z = at(&-c.z);
                let (u, v) = (z.mul_add_fast(a, at(&c.x)), z.mul_add_fast(b, at(&c.y)));
                let turned = u * *y - v * *x;
                u.mul_add_fast(u, v.mul_add_fast(v, turned * turned)).gt(at(reach2))
            }
            Rounds::Cylinders { moment: m, reach } => {
                a.mul_add_fast(at(&m.x), b.mul_add_fast(at(&m.y), at(&m.z))).abs().gt(at(reach))
            }
        };
        misses.bits() ^ 0xff
    }
}
