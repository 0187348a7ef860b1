//! The box around all that some rays look at: what culls eight boxes at once where rays are short.
//!
//! Plainly: a ray from `o` along `d` between `t_min` and `t_max` stays within the box around the two ends of that stretch.

use wide::f32x8;

use super::instance::TreeRoot;
use super::node::Node8;
use crate::intersect::{RayLanes, Tier};
use crate::math::{Lane, Mask, Real, Vec3, three};

/// Roundoffs of the largest coordinate by which the box is widened: the 36 by which boxes of a tree are padded, 4 for where
/// the stretches end, 4 for rays of more digits; the rest is slack, which costs nothing.
const ROUNDOFFS: f64 = 256.0;

/// The box, in all lanes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    lo: [f32x8; 3],
    hi: [f32x8; 3],
}

impl Region {
    /// The box around the rays of some packets that all end; `None` where any goes on without end, or starts before its
    /// origin.
    #[inline(always)]
    pub(super) fn around<T: Tier>(packets: &[RayLanes<T::Wide>], tree: TreeRoot) -> Option<Self> {
        let mut ends = Ends::default();
        for rays in packets {
            ends.add::<T>(rays, tree)?;
        }
        Some(ends.around())
    }

    /// Of the children of a node, those whose boxes overlap it, as bits.
    #[inline(always)]
    pub(super) fn children(&self, node: &Node8) -> u32 {
        self.overlapped(|k| [f32x8::new(node.lo[k]), f32x8::new(node.hi[k])])
    }

    /// Of eight boxes, given by least and greatest coordinates along an axis, those that overlap it, as bits.
    #[inline(always)]
    pub(super) fn overlapped(&self, extent: impl Fn(usize) -> [f32x8; 2]) -> u32 {
        let along = |k: usize| {
            let [lo, hi] = extent(k);
            Lane::le(lo, self.hi[k]) & Lane::ge(hi, self.lo[k])
        };
        (along(0) & along(1) & along(2)).bits()
    }
}

/// Ends of rays: least coordinates by axis, then greatest with the sign turned; and what roundoffs are relative to.
struct Ends {
    least: [f32x8; 6],
    scale: f32x8,
}

impl Default for Ends {
    fn default() -> Self {
        Self { least: [f32x8::splat(f32::INFINITY); 6], scale: f32x8::ZERO }
    }
}

impl Ends {
    #[inline(always)]
    fn add<T: Tier>(&mut self, rays: &RayLanes<T::Wide>, tree: TreeRoot) -> Option<()> {
        let (t_min, t_max) = (T::below_f32(rays.t_min), T::above_f32(rays.t_max));
        let asked = t_max.gt(f32x8::splat(f32::NEG_INFINITY));
        let ends = t_max.lt(f32x8::splat(f32::MAX)) & t_min.ge(f32x8::ZERO);
        if (asked & !ends).any() {
            return None;
        }
        let from = [rays.origin.x, rays.origin.y, rays.origin.z].map(T::nearest_f32);
        let along = [rays.direction.x, rays.direction.y, rays.direction.z].map(T::nearest_f32);
        for k in 0..3 {
            let [a, b] = [t_min, t_max].map(|t| t.mul_add_fast(along[k], from[k]));
            let kept = |v: f32x8| Lane::select(asked, v, f32x8::splat(f32::INFINITY));
            self.least[k] = Lane::min(self.least[k], kept(Lane::min(a, b)));
            self.least[k + 3] = Lane::min(self.least[k + 3], kept(-Lane::max(a, b)));
        }
        let from = Vec3::new(from[0], from[1], from[2]);
        let scale = Lane::max(tree.scale_for(from), from.abs().max_component());
        self.scale = Lane::select(asked, Lane::max(self.scale, scale), self.scale);
        Some(())
    }

    #[inline(always)]
    fn around(self) -> Region {
        let [a, b, c, d, e, f] = self.least;
        let rows = f32x8::transpose([a, b, c, d, e, f, -self.scale, -self.scale]);
        let all = rows.into_iter().reduce(Lane::min).unwrap_or_default().to_array();
        let size = all.iter().fold(0.0f32, |size, x| size.max(x.abs()));
        let pad = size * (ROUNDOFFS * f32::ROUNDOFF) as f32;
        Region { lo: three(|k| f32x8::splat(all[k] - pad)), hi: three(|k| f32x8::splat(pad - all[k + 3])) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::intersect::testing::dice::Dice;
    use crate::intersect::{Ray, Watertight};
    use crate::math::{Aabb, WIDTH};

    fn region(rays: &[Ray; WIDTH]) -> Option<Region> {
        let world = TreeRoot::new(0, &Aabb { min: [-4.0; 3], max: [4.0; 3] });
        let each = rays.each_ref().map(RayLanes::from);
        Region::around::<Watertight>(&[RayLanes::gather(|i| &each[i])], world)
    }

    #[test]
    fn boxes_that_a_ray_reaches_are_overlapped_and_most_others_not() {
        let dice = &mut Dice(5);
        let mut beyond = 0;
        for _ in 0..2_000 {
            let point = |dice: &mut Dice| dice.point().map(|x| x as f32);
            let start = point(dice);
            let rays: [Ray; WIDTH] = std::array::from_fn(|_| {
                let (by, t_max) = (point(dice), dice.between(0.01, 0.5) as f32);
                let origin = three(|k| start[k] + 0.01 * by[k]);
                Ray { t_max, ..Ray::new(origin, point(dice)) }
            });
            let region = region(&rays).expect("they all end");
            let ray = &rays[dice.below(WIDTH)];
            let t = dice.unit() as f32 * ray.t_max;
            let on = three(|k| ray.origin[k] + t * ray.direction[k]);
            assert_eq!(region.overlapped(|k| [f32x8::splat(on[k]); 2]), 0xff, "{ray:?} at {t}");
            let off = three(|k| if k == 0 { start[0] + 0.6 } else { on[k] });
            beyond += u32::from(region.overlapped(|k| [f32x8::splat(off[k]); 2]) == 0);
        }
        assert!(beyond > 1_900, "{beyond}");
    }

    #[test]
    fn rays_without_end_have_none_and_those_not_asked_do_not_count() {
        let short = Ray { t_max: 1.0, ..Ray::new([0.0; 3], [1.0, 0.0, 0.0]) };
        let rays = |last: Ray| std::array::from_fn(|i| if i == 7 { last } else { short });
        assert!(region(&rays(Ray { t_max: f32::INFINITY, ..short })).is_none());
        let off = Ray { origin: [f32::NAN; 3], t_max: f32::NEG_INFINITY, ..short };
        let region = region(&rays(off)).expect("those asked end");
        assert_eq!(region.overlapped(|k| [f32x8::splat([0.9, 0.0, 0.0][k]); 2]), 0xff);
        assert_eq!(region.overlapped(|k| [f32x8::splat([1.1, 0.0, 0.0][k]); 2]), 0);
    }
}
