//! A box in one vector of eight lanes.

use bytemuck::{cast, cast_ref};
use wide::{f32x4, f32x8, f64x4};

use crate::math::Aabb;

/// Least coordinates, a free lane, greatest coordinates with the sign turned, a free lane: so one minimum joins two boxes.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(super) struct Box8(pub(super) f32x8);

impl Box8 {
    pub(super) const EMPTY: Self = Self(f32x8::new([f32::INFINITY; 8]));

    pub(super) fn of(bounds: &Aabb) -> Self {
        let ([x, y, z], [u, v, w]) = (bounds.min, bounds.max);
        Self(f32x8::new([x, y, z, 0.0, -u, -v, -w, 0.0]))
    }

    #[inline(always)]
    pub(super) fn new(lo: f32x4, hi: f32x4) -> Self {
        Self(cast([lo, -hi]))
    }

    /// Least coordinates, and greatest with the sign turned.
    #[inline(always)]
    fn halves(self) -> [f32x4; 2] {
        cast(self.0)
    }

    #[inline(always)]
    pub(super) fn lo(self) -> f32x4 {
        self.halves()[0]
    }

    #[inline(always)]
    pub(super) fn hi(self) -> f32x4 {
        -self.halves()[1]
    }

    /// Least and greatest coordinate along an axis.
    #[inline(always)]
    pub(super) fn along(&self, axis: usize) -> [f32; 2] {
        let lanes: &[[f32; 4]; 2] = cast_ref(&self.0);
        [lanes[0][axis & 3], -lanes[1][axis & 3]]
    }

    #[inline(always)]
    pub(super) fn join(self, o: Self) -> Self {
        Self(self.0.fast_min(o.0))
    }

    /// The part that both cover; may be empty.
    #[inline(always)]
    pub(super) fn intersection(self, o: Self) -> Self {
        Self(self.0.fast_max(o.0))
    }

    /// Lengths by axis with the sign turned; the fourth lane has no meaning.
    #[inline(always)]
    fn shrink(self) -> f32x4 {
        let [lo, less_hi] = self.halves();
        lo + less_hi
    }

    /// Half the surface area; in `f64`, for coordinates near 1e30 have areas that `f32` cannot hold.
    #[inline(always)]
    pub(super) fn half_area(self) -> f64 {
        let [x, y, z, _] = self.shrink().to_array().map(f64::from);
        x * y + y * z + z * x
    }

    /// [`Box8::half_area`] of four.
    #[inline(always)]
    pub(super) fn half_areas(boxes: [Self; 4]) -> f64x4 {
        let [x, y, z, _] = f32x4::transpose(boxes.map(Self::shrink));
        let [x, y, z] = [x, y, z].map(|lanes| f64x4::new(lanes.to_array().map(f64::from)));
        x * y + y * z + z * x
    }

    /// True if no point is inside.
    #[inline(always)]
    pub(super) fn is_empty(self) -> bool {
        self.lo().simd_gt(self.hi()).to_bitmask() & 7 != 0
    }

    /// [`Box8::join`] for a box that may be empty.
    #[inline(always)]
    pub(super) fn join_part(self, o: Self) -> Self {
        if o.is_empty() { self } else { self.join(o) }
    }

    /// What lies up to a plane across an axis, and what lies from there on.
    #[inline(always)]
    pub(super) fn parted(self, axis: usize, at: f32) -> (Self, Self) {
        let mut low: [[f32; 4]; 2] = cast(self.0);
        let mut high = low;
        high[0][axis] = high[0][axis].max(at);
        low[1][axis] = low[1][axis].max(-at);
        (Self(cast(low)), Self(cast(high)))
    }

    pub(super) fn to_aabb(self) -> Aabb {
        let ([x, y, z, _], [u, v, w, _]) = (self.lo().to_array(), self.hi().to_array());
        Aabb { min: [x, y, z], max: [u, v, w] }
    }

    /// The axis on which it is longest; the first of equals.
    pub(super) fn longest_axis(self) -> usize {
        let shrink = self.shrink().to_array();
        (1..3).fold(0, |best, k| if shrink[k] < shrink[best] { k } else { best })
    }
}
