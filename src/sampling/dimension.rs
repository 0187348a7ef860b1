//! Which random decision a number is for.
//!
//! A dimension is one word: the draw in bits 0 to 2, the bounce in bits 3 to 10, the branch in bits 11 to 31. The camera
//! has bounce 0, so no dimension of a path meets one of the camera.

use crate::math::BitLane;

/// Where in the pixel filter the camera ray starts (a pair).
pub const FILTER: u32 = 0;
/// Where on the lens it starts (a pair).
pub const LENS: u32 = 1;

/// What is drawn at a bounce.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScatterDraw {
    /// The direction of a scattered ray (a pair).
    Direction = 0,
    /// Which of several lobes to follow (a single number).
    Lobe = 1,
    /// Whether the path goes on (a single number).
    Survival = 2,
    /// Where on a light to aim (a pair).
    Light = 3,
}

/// The dimension of a draw at a bounce: `depth` 0 is the first hit, `branch` comes from [`child_branch`].
///
/// Distinct for distinct (draw, depth, branch) up to depth 254 and branch 2^21 - 1; beyond, numbers repeat.
#[inline(always)]
pub fn bounce<W: BitLane>(draw: ScatterDraw, depth: u32, branch: W) -> W {
    let decision = draw as u32 | ((depth + 1) & 0xff) << 3;
    branch.shl(11) ^ W::splat(decision)
}

/// The branch code of a secondary ray: the camera ray has 0, and each split appends `which`, below 4, to its parent's.
///
/// So the reflected and the refracted part of one sample draw independent numbers. The last ten splits count.
#[inline(always)]
pub fn child_branch<W: BitLane>(parent: W, which: u32) -> W {
    parent.shl(2) ^ W::splat(which & 3)
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    const DRAWS: [ScatterDraw; 4] =
        [ScatterDraw::Direction, ScatterDraw::Lobe, ScatterDraw::Survival, ScatterDraw::Light];

    #[test]
    fn all_dimensions_of_a_path_tree_differ() {
        let mut seen = HashSet::from([FILTER, LENS]);
        let mut branches = vec![0u32];
        for depth in 0..6 {
            for (&branch, draw) in branches.iter().flat_map(|b| DRAWS.map(|d| (b, d))) {
                assert!(seen.insert(bounce(draw, depth, branch)), "{draw:?} at {depth}, branch {branch}");
            }
            branches = branches.iter().flat_map(|&b| (0..3).map(move |k| child_branch(b, k))).collect();
        }
    }
}
