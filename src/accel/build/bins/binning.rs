//! Which bin an item falls into.

use wide::{f32x4, f32x8};

use super::super::box8::Box8;
use super::super::item::{Item, XYZ};

/// From centroids to bins: an affine map by axis.
#[derive(Clone, Copy)]
pub(in super::super) struct Binning {
    origin: f32x4,
    scale: f32x4,
}

impl Binning {
    pub(in super::super) fn new<const BINS: usize>(centroids: Box8) -> Self {
        let (origin, size) = (centroids.lo() & XYZ, centroids.hi() - centroids.lo());
        let scale = (f32x4::splat(BINS as f32) / size) & size.simd_gt(f32x4::ZERO) & XYZ;
        Self { origin, scale }
    }

    /// The bins of an item by axis. Overflow and NaN (from sizes near the ends of `f32`) end in some bin, which is
    /// always the same for the same item: all that partitioning needs.
    #[inline(always)]
    pub(super) fn bins<const BINS: usize>(&self, item: &Item) -> [usize; 4] {
        let place = (item.centroid() - self.origin) * self.scale;
        let place = place.fast_max(f32x4::ZERO).fast_min(f32x4::splat((BINS - 1) as f32));
        place.fast_trunc_int().to_array().map(|bin| bin as usize & (BINS - 1))
    }

    /// The bin of an item on one axis.
    #[inline(always)]
    pub(in super::super) fn on_axis<const BINS: usize>(self, axis: usize) -> impl Fn(&Item) -> usize + Sync {
        let [origin, scale] = [self.origin, self.scale].map(|lanes| f32x4::splat(lanes.to_array()[axis]));
        move |item| {
            let place = (f32x4::splat(item.place(axis)) - origin) * scale;
            let place = place.fast_max(f32x4::ZERO).fast_min(f32x4::splat((BINS - 1) as f32));
            place.fast_trunc_int().to_array()[0] as usize & (BINS - 1)
        }
    }

    /// All lanes set for items whose bin on an axis comes before another.
    #[inline(always)]
    pub(super) fn before<const BINS: usize>(self, axis: usize, bin: usize) -> impl Fn(&Item) -> f32x8 + Sync {
        let [origin, scale] = [self.origin, self.scale].map(|lanes| f32x8::splat(lanes.to_array()[axis]));
        let bin = f32x8::splat(bin as f32);
        move |item| {
            let place = (f32x8::splat(item.place(axis)) - origin) * scale;
            let place = place.fast_max(f32x8::ZERO).fast_min(f32x8::splat((BINS - 1) as f32));
            !place.simd_ge(bin)
        }
    }
}
