//! Primitives as the builder moves them: 32 bytes each, partitioned in place, so that every range is read in one stream.

use wide::f32x4;

use super::BuildPrimitive;
use crate::math::Aabb;

/// A box in two vectors of four lanes; the fourth lane has no meaning.
#[derive(Clone, Copy, Debug)]
pub(super) struct Box4 {
    pub(super) lo: f32x4,
    pub(super) hi: f32x4,
}

impl Box4 {
    pub(super) const EMPTY: Self =
        Self { lo: f32x4::new([f32::INFINITY; 4]), hi: f32x4::new([f32::NEG_INFINITY; 4]) };

    #[inline(always)]
    pub(super) fn join(self, o: Self) -> Self {
        Self { lo: self.lo.fast_min(o.lo), hi: self.hi.fast_max(o.hi) }
    }

    /// Half the surface area; in `f64`, for coordinates near 1e30 have areas that `f32` cannot hold.
    #[inline(always)]
    pub(super) fn half_area(self) -> f64 {
        let [x, y, z, _] = (self.hi - self.lo).to_array().map(f64::from);
        x * y + y * z + z * x
    }

    pub(super) fn of(bounds: &Aabb) -> Self {
        let ([x, y, z], [u, v, w]) = (bounds.min, bounds.max);
        Self { lo: f32x4::new([x, y, z, 0.0]), hi: f32x4::new([u, v, w, 0.0]) }
    }

    /// The part that both cover; may be empty.
    #[inline(always)]
    pub(super) fn intersection(self, o: Self) -> Self {
        Self { lo: self.lo.fast_max(o.lo), hi: self.hi.fast_min(o.hi) }
    }

    /// True if no point is inside.
    #[inline(always)]
    pub(super) fn is_empty(self) -> bool {
        self.lo.simd_gt(self.hi).to_bitmask() & 7 != 0
    }

    /// [`Box4::join`] for a box that may be empty.
    #[inline(always)]
    pub(super) fn join_part(self, o: Self) -> Self {
        if o.is_empty() { self } else { self.join(o) }
    }

    /// What lies up to a plane across an axis, and what lies from there on.
    #[inline(always)]
    pub(super) fn parted(self, axis: usize, at: f32) -> (Self, Self) {
        let (mut lo, mut hi) = (self.lo.to_array(), self.hi.to_array());
        lo[axis] = lo[axis].max(at);
        hi[axis] = hi[axis].min(at);
        (Self { hi: f32x4::new(hi), ..self }, Self { lo: f32x4::new(lo), ..self })
    }

    pub(super) fn to_aabb(self) -> Aabb {
        let ([x, y, z, _], [u, v, w, _]) = (self.lo.to_array(), self.hi.to_array());
        Aabb { min: [x, y, z], max: [u, v, w] }
    }
}

/// The axis on which a box is longest; the first of equals.
pub(super) fn longest_axis(bounds: Box4) -> usize {
    let size = (bounds.hi - bounds.lo).to_array();
    (1..3).fold(0, |best, k| if size[k] > size[best] { k } else { best })
}

/// One primitive: its box, and in the bits of the fourth lanes its number (in `lo`) and kind (in `hi`).
///
/// Numbers below 2^29 read as floats are tiny positive ones, never NaN, so minima and maxima may run over all lanes.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Item {
    pub(super) bounds: Box4,
}

const XYZ: f32x4 =
    f32x4::new([f32::from_bits(u32::MAX), f32::from_bits(u32::MAX), f32::from_bits(u32::MAX), 0.0]);

impl Item {
    pub(super) fn new(number: u32, primitive: &BuildPrimitive) -> Self {
        let ([x, y, z], [u, v, w]) = (primitive.bounds.min, primitive.bounds.max);
        let (number, kind) = (f32::from_bits(number), f32::from_bits(u32::from(primitive.kind)));
        Self { bounds: Box4 { lo: f32x4::new([x, y, z, number]), hi: f32x4::new([u, v, w, kind]) } }
    }
    /// The same primitive with another box.
    pub(super) fn with_bounds(&self, bounds: Box4) -> Self {
        let put = |place: f32x4, kept: f32x4| (place & XYZ) | (kept & !XYZ);
        Self { bounds: Box4 { lo: put(bounds.lo, self.bounds.lo), hi: put(bounds.hi, self.bounds.hi) } }
    }
    pub(super) fn number(&self) -> u32 {
        self.bounds.lo.to_array()[3].to_bits()
    }
    pub(super) fn kind(&self) -> u8 {
        self.bounds.hi.to_array()[3].to_bits() as u8
    }
    /// Twice the middle of the box. The fourth lane is cleared: products with its denormals are slow.
    #[inline(always)]
    pub(super) fn centroid(&self) -> f32x4 {
        (self.bounds.lo + self.bounds.hi) & XYZ
    }
}

/// The box of a range and the box of its centroids.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub(super) bounds: Box4,
    pub(super) centroids: Box4,
}

impl Extent {
    pub(super) fn of(items: &[Item]) -> Self {
        reduce(items, &Self::of_run, &Self::join)
    }

    fn of_run(items: &[Item]) -> Self {
        items.iter().fold(Self { bounds: Box4::EMPTY, centroids: Box4::EMPTY }, |extent, item| {
            let c = item.centroid();
            extent.join(Self { bounds: item.bounds, centroids: Box4 { lo: c, hi: c } })
        })
    }

    #[inline(always)]
    fn join(self, o: Self) -> Self {
        Self { bounds: self.bounds.join(o.bounds), centroids: self.centroids.join(o.centroids) }
    }
}

/// Items that one task handles alone.
pub(super) const GRAIN: usize = 1 << 16;

/// One result for a range, from results of its runs.
///
/// Halving by position, whatever the number of threads: the same runs are joined in the same order every time.
pub(super) fn reduce<T: Send>(
    items: &[Item],
    run: &(impl Fn(&[Item]) -> T + Sync),
    join: &(impl Fn(T, T) -> T + Sync),
) -> T {
    if items.len() <= GRAIN {
        return run(items);
    }
    let (left, right) = items.split_at(items.len() / 2);
    let (left, right) = rayon::join(|| reduce(left, run, join), || reduce(right, run, join));
    join(left, right)
}

/// Moves the items that belong to the left before the others, and gives their count. Deterministic; not stable.
pub(super) fn partition(items: &mut [Item], is_left: &(impl Fn(&Item) -> bool + Sync)) -> usize {
    if items.len() <= GRAIN {
        return partition_run(items, is_left);
    }
    let (a, b) = items.split_at_mut(items.len() / 2);
    let (left_a, left_b) = rayon::join(|| partition(a, is_left), || partition(b, is_left));
    let swapped = left_b.min(a.len() - left_a);
    a[left_a..left_a + swapped].swap_with_slice(&mut b[left_b - swapped..left_b]);
    left_a + left_b
}

/// [`partition`] by one task. The swap happens every time, so there is no branch to mispredict.
///
/// **Source:** Lomuto's partition, in the branch-free form of Alexandrescu, "Lomuto's comeback", 2020.
fn partition_run(items: &mut [Item], is_left: &impl Fn(&Item) -> bool) -> usize {
    let mut left = 0;
    for i in 0..items.len() {
        let step = usize::from(is_left(&items[i]));
        items.swap(left, i);
        left += step;
    }
    left
}

#[cfg(test)]
mod tests {
    use super::*;

    fn items(count: u32) -> Vec<Item> {
        let at = |i: u32| [(i.wrapping_mul(2_654_435_761) >> 8) as f32; 3];
        let primitive = |i| BuildPrimitive { bounds: Aabb { min: at(i), max: at(i) }, kind: 3 };
        (0..count).map(|i| Item::new(i, &primitive(i))).collect()
    }

    #[test]
    fn number_and_kind_survive_the_float_lanes() {
        let bounds = Aabb { min: [-1.0, 0.0, 2.0], max: [1.0, 0.5, 3.0] };
        for number in [0, 1, 0x7f_ffff, (1 << 29) - 1] {
            let item = Item::new(number, &BuildPrimitive { bounds, kind: 6 });
            assert_eq!((item.number(), item.kind(), item.bounds.to_aabb()), (number, 6, bounds));
            assert_eq!(item.centroid().to_array(), [0.0, 0.5, 5.0, 0.0]);
        }
    }

    #[test]
    fn partition_keeps_every_item_on_its_side() {
        for count in [0, 1, 7, GRAIN as u32 * 3 + 5] {
            for limit in [-1.0, 3e6, 1e7, 1e9] {
                let mut shuffled = items(count);
                let is_left = |item: &Item| item.bounds.lo.to_array()[0] < limit;
                let left = partition(&mut shuffled, &is_left);
                assert!(shuffled[..left].iter().all(is_left) && !shuffled[left..].iter().any(is_left));
                let mut numbers: Vec<u32> = shuffled.iter().map(Item::number).collect();
                numbers.sort_unstable();
                assert!(numbers.into_iter().eq(0..count));
            }
        }
    }
}
