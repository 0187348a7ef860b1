//! Sums of the samples of a pixel that do not depend on who computed which.
//!
//! The samples of a pixel come in order, so `f32` will do: blocks of 16 are summed in sample order and the blocks by a tree
//! that depends on their numbers alone; so shards made of whole blocks merge to the bits of one run.

/// Samples summed one after the other before the tree takes over; a shard holds a multiple of it.
pub const SAMPLES_PER_BLOCK: u32 = 16;

/// The sum of the blocks `index << level` to `(index + 1) << level`, the end excluded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockNode<const C: usize> {
    /// Height in the tree: 0 is one block.
    pub level: u32,
    /// Place among the nodes of this level.
    pub index: u64,
    /// Sum by channel.
    pub sum: [f32; C],
}

impl<const C: usize> BlockNode<C> {
    /// The first block summed.
    pub fn first_block(&self) -> u64 {
        self.index << self.level
    }

    /// The block after the last one summed.
    pub fn end_block(&self) -> u64 {
        (self.index + 1) << self.level
    }

    /// True if both are the halves of one node, `self` the left.
    fn is_left_twin_of(&self, right: &Self) -> bool {
        self.level == right.level && self.index.is_multiple_of(2) && self.index + 1 == right.index
    }

    fn joined_with(&self, right: &Self) -> Self {
        Self { level: self.level + 1, index: self.index / 2, sum: plus(self.sum, right.sum) }
    }
}

#[inline(always)]
fn plus<const C: usize>(a: [f32; C], b: [f32; C]) -> [f32; C] {
    let mut sum = a;
    for (sum, b) in sum.iter_mut().zip(b) {
        *sum += b;
    }
    sum
}

/// Two ranges of blocks that do not meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the sums end before block {expected}, so block {found} cannot follow")]
pub struct NotAdjacent {
    /// The block that comes next.
    pub expected: u64,
    /// The block that was given.
    pub found: u64,
}

/// The sum of a range of consecutive blocks as the fewest nodes of one infinite binary tree over block numbers.
///
/// The sum in a node depends on its place alone, however the range was cut before: so trees of adjacent ranges, split at any
/// blocks, [append](BlockTree::append) to the bits that pushing block by block gives. A range from block 0 works like a
/// binary counter: one node for each 1 in the number of blocks.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockTree<const C: usize> {
    nodes: Vec<BlockNode<C>>,
    next_block: u64,
}

impl<const C: usize> Default for BlockTree<C> {
    fn default() -> Self {
        Self::starting_at(0)
    }
}

impl<const C: usize> BlockTree<C> {
    /// The empty range before a block.
    pub fn starting_at(first_block: u64) -> Self {
        Self { nodes: Vec::new(), next_block: first_block }
    }

    /// Empties the range, now before the given block; keeps memory.
    pub fn reset(&mut self, first_block: u64) {
        self.nodes.clear();
        self.next_block = first_block;
    }

    /// The block that comes next.
    pub fn next_block(&self) -> u64 {
        self.next_block
    }

    /// The nodes in order: what a shard stores.
    pub fn nodes(&self) -> &[BlockNode<C>] {
        &self.nodes
    }

    /// Adds the next block.
    pub fn push_block(&mut self, sum: [f32; C]) {
        self.join(BlockNode { level: 0, index: self.next_block, sum });
    }

    /// Adds a node. **Errors:** it does not begin with the next block.
    pub fn push(&mut self, node: BlockNode<C>) -> Result<(), NotAdjacent> {
        if node.first_block() != self.next_block {
            return Err(NotAdjacent { expected: self.next_block, found: node.first_block() });
        }
        self.join(node);
        Ok(())
    }

    /// Adds the range that follows. **Errors:** a gap or an overlap; then nothing changes.
    pub fn append(&mut self, later: &Self) -> Result<(), NotAdjacent> {
        later.nodes.iter().try_for_each(|&node| self.push(node))
    }

    fn join(&mut self, mut node: BlockNode<C>) {
        self.next_block = node.end_block();
        while let Some(left) = self.nodes.pop_if(|left| left.is_left_twin_of(&node)) {
            node = left.joined_with(&node);
        }
        self.nodes.push(node);
    }

    /// The sum of the range: its nodes from the last to the first.
    pub fn total(&self) -> [f32; C] {
        total(self.nodes.iter().map(|node| node.sum))
    }
}

/// The sum of a range from the sums of its nodes in order: from the last to the first.
#[inline(always)]
pub fn total<const C: usize>(nodes: impl DoubleEndedIterator<Item = [f32; C]>) -> [f32; C] {
    nodes.rev().reduce(|later, earlier| plus(earlier, later)).unwrap_or([0.0; C])
}

/// The sum of the samples of one pixel, pushed in sample order; `C` channels, the filter weight as one of them if needed.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelSum<const C: usize> {
    block: [f32; C],
    samples_in_block: u32,
    tree: BlockTree<C>,
}

impl<const C: usize> Default for PixelSum<C> {
    fn default() -> Self {
        Self { block: [0.0; C], samples_in_block: 0, tree: BlockTree::default() }
    }
}

impl<const C: usize> PixelSum<C> {
    /// Forgets all samples; the next one opens the given block. Keeps memory.
    pub fn reset(&mut self, first_block: u64) {
        self.block = [0.0; C];
        self.samples_in_block = 0;
        self.tree.reset(first_block);
    }

    /// Adds the next sample.
    #[inline(always)]
    pub fn push(&mut self, sample: [f32; C]) {
        self.block = plus(self.block, sample);
        self.samples_in_block += 1;
        if self.samples_in_block == SAMPLES_PER_BLOCK {
            self.close_block();
        }
    }

    fn close_block(&mut self) {
        self.tree.push_block(self.block);
        self.block = [0.0; C];
        self.samples_in_block = 0;
    }

    /// The sum of all samples pushed. **Needs:** `reset` before the next one.
    #[inline(always)]
    pub fn total(&mut self) -> [f32; C] {
        // A pixel of few samples is one block and needs no tree.
        if self.tree.nodes().is_empty() { self.block } else { self.finish().total() }
    }

    /// Closes the last block, which may be short, and gives the sums. A short block ends the pixel: nothing can follow it.
    pub fn finish(&mut self) -> &BlockTree<C> {
        if self.samples_in_block > 0 {
            self.close_block();
        }
        &self.tree
    }
}

#[cfg(test)]
mod tests;
