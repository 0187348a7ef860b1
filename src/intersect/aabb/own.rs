//! The box of the primitive itself, in plain operations: part of what counts as a hit.

use super::safe_reciprocal;
use crate::math::{Lane, Real, Vec3};

/// Roundoffs of the largest coordinate that a hit may lie outside the triangle's box: the shear of the Woop test costs
/// 4, its edge functions 3 a product, the slab below 4; the rest is slack.
const PAD_ROUNDOFFS: f64 = 24.0;

/// Rays prepared for the slab test against a primitive's own box.
///
/// A triangle counts as hit where the edge test accepts it *and* the ray meets its own box; `t` is confined to the
/// interval inside. Since every box of a tree holds that box with a wider pad, no tree can cull a hit that would have
/// counted, nor a nearer one: which hit is nearest does not depend on the tree. For trees that hold triangles in parts
/// this box is too large to tell; there the hit itself lies at the triangle (`triangle::near`).
#[derive(Clone, Copy, Debug)]
pub struct OwnBox<L> {
    origin: Vec3<L>,
    reciprocal: Vec3<L>,
    reach: L,
}

impl<L: Lane> OwnBox<L> {
    /// Prepares rays.
    #[inline(always)]
    pub fn new(origin: Vec3<L>, direction: Vec3<L>) -> Self {
        let reach = origin.abs().max_component();
        Self { origin, reciprocal: safe_reciprocal(direction), reach }
    }

    /// The largest coordinate of the ray's origin plus that of the boxes: what roundoffs are relative to.
    #[inline(always)]
    pub fn magnitude(&self, lo: Vec3<L>, hi: Vec3<L>) -> L {
        self.reach + lo.abs().max(hi.abs()).max_component()
    }

    /// Where the rays are inside the boxes, first and last `t`; empty where first is beyond last.
    #[inline(always)]
    pub fn interval(&self, lo: Vec3<L>, hi: Vec3<L>) -> (L, L) {
        let pad = self.magnitude(lo, hi) * L::constant(PAD_ROUNDOFFS * <L::Scalar as Real>::ROUNDOFF);
        let slab = |lo: L, hi: L, o: L, r: L| {
            let (a, b) = ((lo - o - pad) * r, (hi - o + pad) * r);
            (a.min(b), a.max(b))
        };
        let (o, r) = (self.origin, self.reciprocal);
        let (nx, fx) = slab(lo.x, hi.x, o.x, r.x);
        let (ny, fy) = slab(lo.y, hi.y, o.y, r.y);
        let (nz, fz) = slab(lo.z, hi.z, o.z, r.z);
        (nx.max(ny).max(nz), fx.min(fy).min(fz))
    }
}
