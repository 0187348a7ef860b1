//! Primitives of eight blocks, one of each.

use wide::{f32x8, u32x8};

use super::{CylinderBlock, SphereBlock, TriangleBlock};
use crate::intersect::{cylinder, sphere};
use crate::math::{Lane, Mask, Vec3, WIDTH, eight, three};

/// Eight blocks, and a lane of each.
pub type Picks<'a, B> = (&'a [&'a B; WIDTH], &'a [usize; WIDTH]);

/// A column, each lane from its own block.
#[inline(always)]
fn column<'a, B, L: Lane>((blocks, lanes): Picks<'a, B>, of: impl Fn(&'a B) -> &'a [f32; WIDTH]) -> L {
    // Each lane from a column loaded whole: eight loads of a number each become a gather, which is slow on many CPUs.
    let lane = |i: usize| f32x8::new(*of(blocks[i])).shuffle_wrapping(u32x8::splat(lanes[i] as u32));
    let mut gathered = lane(0);
    for i in 1..WIDTH {
        gathered = Lane::select(Mask::from_bits(1 << i), lane(i), gathered);
    }
    L::load_f32(&gathered.to_array())
}

/// Columns by axis.
#[inline(always)]
fn columns<'a, B, L: Lane>(picks: Picks<'a, B>, of: impl Fn(&'a B) -> &'a [[f32; WIDTH]; 3]) -> Vec3<L> {
    let [x, y, z] = three(|k| column(picks, |block| &of(block)[k]));
    Vec3 { x, y, z }
}

impl TriangleBlock {
    /// Corners of picked triangles.
    #[inline(always)]
    pub fn gather<L: Lane>(picks: Picks<Self>) -> [Vec3<L>; 3] {
        three(|v| columns(picks, |block| &block.corner[v]))
    }
}

impl SphereBlock {
    /// Picked spheres.
    #[inline(always)]
    pub fn gather<L: Lane>(picks: Picks<Self>) -> sphere::Lanes<L> {
        sphere::Lanes {
            center: columns(picks, |block| &block.center),
            radius: column(picks, |block| &block.radius),
        }
    }
}

impl CylinderBlock {
    /// Picked cylinders.
    #[inline(always)]
    pub fn gather<L: Lane>(picks: Picks<Self>) -> cylinder::Lanes<L> {
        let capped = eight(|i| (picks.0[i].capped >> picks.1[i] & 1) << i);
        cylinder::Lanes {
            from: columns(picks, |block| &block.from),
            to: columns(picks, |block| &block.to),
            radius: column(picks, |block| &block.radius),
            capped: Mask::from_bits(capped.iter().sum()),
        }
    }
}
