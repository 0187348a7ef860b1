//! The one room with unchecked access: what the loops over many rays load and store.
//!
//! Measured on one Zen 4 core with diffuse rays: with every access checked, 0.91 of the rays a second on a mesh of 69
//! thousand triangles and 0.93 inside a hall of 66 thousand; without prefetching too, 0.69 on 871 thousand. Without huge
//! pages 0.92 on 871 thousand, and 0.83 with random rays on 5 million.
//!
//! Every index here comes out of a tree that [`super::build`] made and `validate` describes: a reference leads to a node
//! or block that is there, and no stack grows beyond the bound that the depth of the tree sets. Debug builds check
//! each of them.
#![allow(unsafe_code)]

use wide::{f32x8, u32x8};

use super::Accel;
use super::block::TriangleBlock;
use super::node::{ChildRef, Node8};
use super::order::ascending;
use crate::math::{Lane, Mask, WIDTH};

/// The node that a reference leads to.
#[inline(always)]
pub(super) fn node(accel: &Accel, child: ChildRef) -> &Node8 {
    let index = child.index() as usize;
    debug_assert!(child.is_node() && index < accel.nodes.len());
    // SAFETY: references to nodes hold indices of nodes that were built, see the module.
    unsafe { accel.nodes.get_unchecked(index) }
}

/// The planes of a node on an axis that a ray meets first, and last. **Needs:** `backward` is 0 where the ray goes along the
/// axis, else [`Node8::ACROSS`].
#[inline(always)]
pub(super) fn planes(node: &Node8, axis: usize, backward: u8) -> [f32x8; 2] {
    debug_assert!(axis < 3 && (backward == 0 || backward == Node8::ACROSS));
    let start = std::ptr::from_ref(node).cast::<[f32; WIDTH]>().wrapping_add(axis).cast::<u8>();
    [backward, backward ^ Node8::ACROSS].map(|side| {
        // SAFETY: six columns of planes stand at the start of a node, those of the greatest coordinates `ACROSS` further.
        f32x8::new(unsafe { *start.add(usize::from(side)).cast::<[f32; WIDTH]>() })
    })
}

/// The block of triangles that a reference leads to.
#[inline(always)]
pub(super) fn triangles(accel: &Accel, child: ChildRef) -> &TriangleBlock {
    let index = child.index() as usize;
    debug_assert!(index < accel.triangles.len());
    // SAFETY: references to leaves hold indices of blocks that were packed, see the module.
    unsafe { accel.triangles.get_unchecked(index) }
}

/// Asks for the memory that a reference leads to, so that it is there when it is visited.
#[inline(always)]
pub(super) fn prefetch(accel: &Accel, child: ChildRef) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        let (nodes, blocks) = (accel.nodes.as_ptr().cast::<i8>(), accel.triangles.as_ptr().cast::<i8>());
        let (index, more) = (child.index() as usize, size_of::<TriangleBlock>() - size_of::<Node8>());
        let as_node = index * size_of::<Node8>();
        let first = match child.is_node() {
            true => nodes.wrapping_add(as_node),
            false => blocks.wrapping_add(as_node + index * more),
        };
        for line in 0..5 {
            // SAFETY: a prefetch reads nothing that the program sees, and faults at no address.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(first.wrapping_add(64 * line)) };
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (accel, child);
}

/// Bytes of the pages that addresses have to begin with to be advised on.
#[cfg(target_os = "linux")]
const PAGE_BYTES: usize = 4096;

/// Bytes below which huge pages of two megabytes would rather waste memory than save time.
#[cfg(target_os = "linux")]
const LEAST_HUGE_BYTES: usize = 2 << 20;

/// Makes room for exactly so many more elements, where those are many in huge pages if the system hands them out on
/// request: rays that go anywhere then seldom wait for addresses to be translated.
pub(in crate::accel) fn reserve<T>(to: &mut Vec<T>, more: usize) {
    to.reserve_exact(more);
    #[cfg(target_os = "linux")]
    {
        use rustix::mm::{Advice, madvise};
        let room = to.spare_capacity_mut().as_mut_ptr_range();
        let skip = room.start.cast::<u8>().align_offset(PAGE_BYTES);
        let size = (room.end.addr() - room.start.addr()).saturating_sub(skip);
        if size < LEAST_HUGE_BYTES {
            return;
        }
        // SAFETY: the advice changes how memory that nothing refers to yet is mapped, and neither contents nor validity.
        // That it may be refused changes nothing.
        let _ = unsafe {
            madvise(room.start.cast::<u8>().wrapping_add(skip).cast(), size, Advice::LinuxHugepage)
        };
    }
}

/// Rows of up to eight columns whose memory is asked for a bit at a time: asked for all at once, it would be waited for.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Ahead {
    addresses: [usize; 8],
    columns: usize,
    /// Bytes of each column that are still to be asked for.
    bytes: usize,
}

impl Ahead {
    /// No rows yet of columns to come.
    pub(super) fn of_rows<R>(rows: usize) -> Self {
        Self { bytes: rows * size_of::<R>(), ..Self::default() }
    }
    /// Adds a column, from row `at` on, there or not.
    #[inline(always)]
    pub(super) fn add<R>(&mut self, column: &[R], at: usize) {
        self.addresses[self.columns % 8] = column.as_ptr().wrapping_add(at).addr();
        self.columns += 1;
    }
    /// Asks for a cache line of each column; false if nothing is left to ask for.
    #[inline(always)]
    pub(super) fn step(&mut self) -> bool {
        if self.bytes == 0 {
            return false;
        }
        #[cfg(target_arch = "x86_64")]
        for address in self.addresses.iter_mut().take(self.columns) {
            use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
            // SAFETY: as above.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(std::ptr::without_provenance(*address)) };
            *address = address.wrapping_add(64);
        }
        self.bytes = self.bytes.saturating_sub(64);
        true
    }
}

/// Stacks of many rays, one after the other: references and where the ray enters them, the next to visit last.
#[derive(Debug)]
pub(super) struct Stacks {
    child: Vec<u32>,
    near: Vec<f32>,
    stride: usize,
}

impl Stacks {
    /// What stands at the bottom of every stack.
    pub(super) const END: ChildRef = ChildRef::from_bits(7 << 29);

    /// Stacks of up to `bound` entries, none so far.
    pub(super) fn new(bound: usize) -> Self {
        // Eight entries are written at a time; an odd number of cache lines keeps the stacks in different cache sets.
        let stride = (bound + 2 * WIDTH).next_multiple_of(16) | 16;
        Self { child: Vec::new(), near: Vec::new(), stride }
    }

    /// Makes sure that there are `count` stacks: only streams with rays that go alone need any.
    pub(super) fn make(&mut self, count: usize) {
        if self.child.len() < count * self.stride {
            self.child.resize(count * self.stride, Self::END.bits());
            self.near.resize(count * self.stride, 0.0);
        }
    }

    /// The place of a stack where [`Self::END`] stands.
    #[inline(always)]
    pub(super) fn bottom(&self, stack: usize) -> usize {
        stack * self.stride
    }

    /// Writes eight entries from a place on.
    #[inline(always)]
    pub(super) fn write(&mut self, place: usize, child: u32x8, near: f32x8) {
        debug_assert!(place + WIDTH <= self.child.len() && place % self.stride + WIDTH <= self.stride);
        // SAFETY: places lie on stacks that were made, and the depth of the tree bounds how high, see the module.
        unsafe {
            *self.child.as_mut_ptr().add(place).cast::<[u32; WIDTH]>() = child.to_array();
            *self.near.as_mut_ptr().add(place).cast::<[f32; WIDTH]>() = near.to_array();
        }
    }

    /// The reference at a place.
    #[inline(always)]
    pub(super) fn child(&self, place: usize) -> ChildRef {
        debug_assert!(place < self.child.len());
        // SAFETY: as above.
        ChildRef::from_bits(unsafe { *self.child.get_unchecked(place) })
    }

    /// Keeps those entries above the bottom and below `top` that the ray enters within its limit; gives the new top.
    #[inline(always)]
    pub(super) fn keep_within(&mut self, bottom: usize, top: usize, limit: f32) -> usize {
        let limit = f32x8::splat(limit);
        let mut kept = bottom + 1;
        for place in (kept..top).step_by(WIDTH) {
            let (child, near) = self.read(place);
            let inside = Lane::le(near, limit).bits() & first_lanes(top - place);
            let order = ascending(inside);
            self.write(kept, child.shuffle_wrapping(order), near.shuffle_wrapping(order));
            kept += inside.count_ones() as usize;
        }
        kept
    }

    /// Eight entries from a place on.
    #[inline(always)]
    fn read(&self, place: usize) -> (u32x8, f32x8) {
        debug_assert!(place + WIDTH <= self.child.len());
        // SAFETY: as for writing: what is on a stack lies within it, and eight more entries do.
        unsafe {
            let child = *self.child.as_ptr().add(place).cast::<[u32; WIDTH]>();
            let near = *self.near.as_ptr().add(place).cast::<[f32; WIDTH]>();
            (u32x8::new(child), f32x8::new(near))
        }
    }
}

/// Bits of the first `count` lanes, of all eight if there are more.
#[inline(always)]
fn first_lanes(count: usize) -> u32 {
    if count < WIDTH { (1 << count) - 1 } else { 0xff }
}
