//! Primitives as the builder moves them: 32 bytes each, partitioned in place, so that every range is read in one stream.

use bytemuck::cast;
use wide::{f32x4, f32x8};

use super::BuildPrimitive;
use super::box8::Box8;

/// One primitive: its box, and in the bits of the free lanes its number and kind.
///
/// Numbers below 2^29 read as floats are tiny positive ones, never NaN, so minima may run over all lanes.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(super) struct Item {
    pub(super) bounds: Box8,
}

const NUMBER: usize = 3;
const KIND: usize = 7;

/// All lanes but the free one.
pub(super) const XYZ: f32x4 =
    f32x4::new([f32::from_bits(u32::MAX), f32::from_bits(u32::MAX), f32::from_bits(u32::MAX), 0.0]);

/// All lanes of a box but the free ones.
pub(super) const XYZXYZ: f32x8 = {
    let all = f32::from_bits(u32::MAX);
    f32x8::new([all, all, all, 0.0, all, all, all, 0.0])
};

impl Item {
    /// Nowhere.
    pub(super) const NOTHING: Self = Self { bounds: Box8::EMPTY };

    pub(super) fn new(number: u32, primitive: &BuildPrimitive) -> Self {
        Self::marked(Box8::of(&primitive.bounds), number, u32::from(primitive.kind))
    }
    #[inline(always)]
    fn marked(bounds: Box8, number: u32, kind: u32) -> Self {
        let mut lanes = bounds.0.to_array();
        (lanes[NUMBER], lanes[KIND]) = (f32::from_bits(number), f32::from_bits(kind));
        Self { bounds: Box8(f32x8::new(lanes)) }
    }
    /// The same primitive with another box.
    pub(super) fn with_bounds(&self, bounds: Box8) -> Self {
        Self::marked(bounds, self.number(), u32::from(self.kind()))
    }
    #[inline(always)]
    pub(super) fn number(&self) -> u32 {
        self.bounds.0.as_array()[NUMBER].to_bits()
    }
    #[inline(always)]
    pub(super) fn kind(&self) -> u8 {
        self.bounds.0.as_array()[KIND].to_bits() as u8
    }
    /// Twice the middle of the box. The fourth lane is cleared: products with its denormals are slow.
    #[inline(always)]
    pub(super) fn centroid(&self) -> f32x4 {
        (self.bounds.lo() + self.bounds.hi()) & XYZ
    }
    /// [`Item::centroid`] on one axis.
    #[inline(always)]
    pub(super) fn place(&self, axis: usize) -> f32 {
        let [lo, hi] = self.bounds.along(axis);
        lo + hi
    }
}

/// The box of a range and the box of its centroids.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub(super) bounds: Box8,
    pub(super) centroids: Box8,
}

impl Extent {
    pub(super) const EMPTY: Self = Self { bounds: Box8::EMPTY, centroids: Box8::EMPTY };

    pub(super) fn of(items: &[Item]) -> Self {
        let run = |run: &[Item]| run.iter().fold(Self::EMPTY, |all, item| all.join(Self::of_one(item)));
        reduce(items, &run, &Self::join)
    }

    #[inline(always)]
    fn of_one(item: &Item) -> Self {
        let [lo, less_hi]: [f32x4; 2] = cast(item.bounds.0);
        let turned: f32x8 = cast([less_hi, lo]);
        Self { bounds: item.bounds, centroids: Box8(item.bounds.0 - turned) }
    }

    #[inline(always)]
    fn join(self, o: Self) -> Self {
        Self { bounds: self.bounds.join(o.bounds), centroids: self.centroids.join(o.centroids) }
    }

    /// [`Extent::join`] where the lanes of a mask are set.
    #[inline(always)]
    fn join_where(self, mask: f32x8, o: Self) -> Self {
        let kept = |b: Box8| Box8(mask.bitselect(b.0, Box8::EMPTY.0));
        self.join(Self { bounds: kept(o.bounds), centroids: kept(o.centroids) })
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

/// Where a range parts, and what is on either side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parted {
    /// Items on the left.
    pub(super) middle: usize,
    pub(super) sides: [Extent; 2],
}

impl Parted {
    /// Looks at the sides of a range that parts at `middle`.
    pub(super) fn at(items: &[Item], middle: usize) -> Self {
        let (left, right) = items.split_at(middle);
        Self { middle, sides: [Extent::of(left), Extent::of(right)] }
    }
}

/// Moves the items that belong to the left, which have all lanes set, before the others. Deterministic; not stable.
pub(super) fn partition(items: &mut [Item], is_left: &(impl Fn(&Item) -> f32x8 + Sync)) -> Parted {
    if items.len() <= GRAIN {
        return partition_run(items, is_left);
    }
    let (a, b) = items.split_at_mut(items.len() / 2);
    let (in_a, in_b) = rayon::join(|| partition(a, is_left), || partition(b, is_left));
    let swapped = in_b.middle.min(a.len() - in_a.middle);
    a[in_a.middle..in_a.middle + swapped].swap_with_slice(&mut b[in_b.middle - swapped..in_b.middle]);
    let side = |i: usize| in_a.sides[i].join(in_b.sides[i]);
    Parted { middle: in_a.middle + in_b.middle, sides: [side(0), side(1)] }
}

/// [`partition`] by one task. The swap happens every time, so there is no branch to mispredict.
///
/// **Source:** Lomuto's partition, in the branch-free form of Alexandrescu, "Lomuto's comeback", 2020.
fn partition_run(items: &mut [Item], is_left: &impl Fn(&Item) -> f32x8) -> Parted {
    let (mut middle, mut left, mut right) = (0, Extent::EMPTY, Extent::EMPTY);
    for i in 0..items.len() {
        let item = items[i];
        let mask = is_left(&items[i]);
        (left, right) =
            (left.join_where(mask, Extent::of_one(&item)), right.join_where(!mask, Extent::of_one(&item)));
        items[i] = items[middle];
        items[middle] = item;
        middle += (mask.to_bitmask() & 1) as usize;
    }
    Parted { middle, sides: [left, right] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Aabb;

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
                let is_left = |item: &Item| item.bounds.along(0)[0] < limit;
                let mask = |item: &Item| f32x8::splat(item.bounds.along(0)[0]).simd_lt(f32x8::splat(limit));
                let left = partition(&mut shuffled, &mask).middle;
                assert!(shuffled[..left].iter().all(is_left) && !shuffled[left..].iter().any(is_left));
                let mut numbers: Vec<u32> = shuffled.iter().map(Item::number).collect();
                numbers.sort_unstable();
                assert!(numbers.into_iter().eq(0..count));
            }
        }
    }
}
