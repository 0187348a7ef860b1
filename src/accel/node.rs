//! The node of the 8-wide tree, and the 32-bit reference that leads from a node to what is below.

use crate::intersect::PrimKind;
use crate::math::{Aabb, WIDTH};
use wide::u32x8;

/// Eight boxes and what each of them holds.
///
/// **Shape:** six columns of eight floats, then eight references: 224 bytes in four cache lines. Children stand in
/// octant slots, which [`super::build`] explains; the free slots hold the box of nothing, which no ray can hit.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node8 {
    /// Least coordinates: axis, then slot.
    pub lo: [[f32; WIDTH]; 3],
    /// Greatest coordinates: axis, then slot.
    pub hi: [[f32; WIDTH]; 3],
    /// What each slot leads to.
    pub child: [ChildRef; WIDTH],
}

impl Node8 {
    /// The node without children.
    pub const EMPTY: Self = Self {
        lo: [[f32::INFINITY; WIDTH]; 3],
        hi: [[f32::NEG_INFINITY; WIDTH]; 3],
        child: [ChildRef::EMPTY; WIDTH],
    };

    /// Bytes from a column of least coordinates to that of greatest on the same axis.
    pub(super) const ACROSS: u8 = size_of::<[[f32; WIDTH]; 3]>() as u8;

    /// Slots that lead anywhere, as bits.
    #[inline(always)]
    pub(super) fn children(&self) -> u32 {
        let nowhere = u32x8::splat(ChildRef::EMPTY.bits());
        u32x8::new(self.child.map(ChildRef::bits)).simd_eq(nowhere).to_bitmask() ^ 0xff
    }

    /// The box of a slot.
    pub fn bounds(&self, slot: usize) -> Aabb {
        Aabb { min: self.lo.map(|row| row[slot]), max: self.hi.map(|row| row[slot]) }
    }

    /// Writes the box of a slot.
    pub fn set_bounds(&mut self, slot: usize, bounds: &Aabb) {
        for k in 0..3 {
            self.lo[k][slot] = bounds.min[k];
            self.hi[k][slot] = bounds.max[k];
        }
    }
}

/// Where a slot of a node leads: to a node, to a leaf of some kind of primitive, or nowhere.
///
/// **Shape:** the top 3 bits tell the kind (0 node, 1 to 6 leaf of that kind of primitive, 7 nowhere), the low 29 bits
/// the index: of the node, or of the leaf among the leaves of its kind.
#[repr(transparent)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChildRef(u32);

const INDEX_BITS: u32 = 29;
const INDEX_MASK: u32 = (1 << INDEX_BITS) - 1;

impl ChildRef {
    /// Leads nowhere.
    pub const EMPTY: Self = Self(u32::MAX);
    /// The kind that stands for a node.
    pub const NODE: u8 = 0;
    /// The last kind that stands for a leaf; the first is 1.
    pub const LAST_KIND: u8 = 6;
    /// Nodes, or leaves of one kind, that can be told apart.
    pub const CAPACITY: usize = 1 << INDEX_BITS;

    /// Leads to node `index`. **Needs:** `index` below [`Self::CAPACITY`].
    #[inline(always)]
    pub const fn node(index: u32) -> Self {
        debug_assert!(index <= INDEX_MASK);
        Self(index & INDEX_MASK)
    }
    /// Leads to leaf `index` of `kind`. **Needs:** `kind` from 1 to 6, `index` below [`Self::CAPACITY`].
    #[inline(always)]
    pub const fn leaf(kind: u8, index: u32) -> Self {
        debug_assert!(kind >= 1 && kind <= Self::LAST_KIND && index <= INDEX_MASK);
        Self((kind as u32) << INDEX_BITS | index & INDEX_MASK)
    }
    /// 0 for a node, 1 to 6 for a leaf of that kind, 7 for nowhere.
    #[inline(always)]
    pub const fn kind(self) -> u8 {
        (self.0 >> INDEX_BITS) as u8
    }
    /// Number of the node, or of the leaf within its kind.
    #[inline(always)]
    pub const fn index(self) -> u32 {
        self.0 & INDEX_MASK
    }
    /// True if it leads to a node.
    #[inline(always)]
    pub const fn is_node(self) -> bool {
        self.0 <= INDEX_MASK
    }
    /// True if it leads to a leaf of triangles.
    #[inline(always)]
    pub(super) const fn is_triangles(self) -> bool {
        self.kind() == PrimKind::Triangle as u8
    }
    /// True if it leads nowhere.
    #[inline(always)]
    pub const fn is_empty(self) -> bool {
        self.0 == Self::EMPTY.0
    }
    /// True if it leads to a leaf.
    #[inline(always)]
    pub const fn is_leaf(self) -> bool {
        !self.is_node() && !self.is_empty()
    }
    /// The reference of these 32 bits.
    #[inline(always)]
    pub(super) const fn from_bits(bits: u32) -> Self {
        Self(bits)
    }
    /// The 32 bits.
    #[inline(always)]
    pub const fn bits(self) -> u32 {
        self.0
    }
    /// The same target after it moved up by `by[kind]` places.
    ///
    /// **Panics** if the index leaves its 29 bits: a wrong reference would render a wrong picture in silence.
    pub fn moved(self, by: &[u32; WIDTH]) -> Self {
        if self.is_empty() {
            return self;
        }
        let index = self.index().checked_add(by[self.kind() as usize]).filter(|&i| i <= INDEX_MASK);
        Self((self.0 & !INDEX_MASK) | index.expect("more nodes or leaves than 29 bits can number"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_node_fills_four_cache_lines() {
        assert_eq!(size_of::<Node8>(), 256);
        assert_eq!(align_of::<Node8>(), 64);
    }

    #[test]
    fn references_keep_kind_and_index() {
        let last = INDEX_MASK;
        for index in [0, 1, last] {
            let node = ChildRef::node(index);
            assert!(node.is_node() && !node.is_leaf() && !node.is_empty() && node.index() == index);
            for kind in 1..=ChildRef::LAST_KIND {
                let leaf = ChildRef::leaf(kind, index);
                assert!(leaf.is_leaf() && !leaf.is_node() && !leaf.is_empty());
                assert_eq!((leaf.kind(), leaf.index()), (kind, index));
            }
        }
        assert!(ChildRef::EMPTY.is_empty() && !ChildRef::EMPTY.is_node() && ChildRef::EMPTY.kind() == 7);
    }

    #[test]
    fn moving_shifts_by_kind_and_leaves_nowhere_alone() {
        let by = [10, 20, 0, 0, 0, 0, 0, 99];
        assert_eq!(ChildRef::node(1).moved(&by), ChildRef::node(11));
        assert_eq!(ChildRef::leaf(1, 1).moved(&by), ChildRef::leaf(1, 21));
        assert_eq!(ChildRef::EMPTY.moved(&by), ChildRef::EMPTY);
    }

    #[test]
    #[should_panic(expected = "29 bits")]
    fn moving_past_the_index_bits_is_refused() {
        let _ = ChildRef::leaf(6, INDEX_MASK).moved(&[1; 8]);
    }
}
