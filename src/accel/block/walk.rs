//! How leaves are walked.

use crate::math::{BitLane, Lane, Mask, Real, Vec3, WIDTH};

/// How a leaf is walked: which primitive stands in which lane at a step.
pub trait Walk: Copy {
    /// A stored column at a step.
    fn value<L: Lane>(column: &[f32; WIDTH], step: usize) -> L;
    /// Stored ids at a step.
    fn ids<B: BitLane>(column: &[u32; WIDTH], step: usize) -> B;
    /// Stored vectors at a step.
    #[inline(always)]
    fn vec3<L: Lane>(columns: &[[f32; WIDTH]; 3], step: usize) -> Vec3<L> {
        let [x, y, z] = columns;
        Vec3::new(Self::value(x, step), Self::value(y, step), Self::value(z, step))
    }
    /// Stored truth values at a step.
    fn flags<M: Mask>(bits: u32, step: usize) -> M;
}

/// Eight rays against one primitive a step.
#[derive(Clone, Copy, Debug)]
pub struct RaysByPrimitive;

/// One ray against eight primitives at once.
#[derive(Clone, Copy, Debug)]
pub struct PrimitivesByRay;

impl Walk for RaysByPrimitive {
    #[inline(always)]
    fn value<L: Lane>(column: &[f32; WIDTH], step: usize) -> L {
        L::splat(L::Scalar::from_f32(column[step]))
    }
    #[inline(always)]
    fn ids<B: BitLane>(column: &[u32; WIDTH], step: usize) -> B {
        B::splat(column[step])
    }
    #[inline(always)]
    fn flags<M: Mask>(bits: u32, step: usize) -> M {
        M::splat(bits >> step & 1 != 0)
    }
}

impl Walk for PrimitivesByRay {
    #[inline(always)]
    fn value<L: Lane>(column: &[f32; WIDTH], _: usize) -> L {
        L::load_f32(column)
    }
    #[inline(always)]
    fn ids<B: BitLane>(column: &[u32; WIDTH], _: usize) -> B {
        B::from_fn(|i| column[i])
    }
    #[inline(always)]
    fn flags<M: Mask>(bits: u32, _: usize) -> M {
        M::from_bits(bits)
    }
}
