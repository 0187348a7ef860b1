//! Part of a picture: sums of some samples of the pixels of some tiles, to be put together with others.

use super::{BlockNode, BlockTree};

/// The sums of one tile.
///
/// **Shape:** pixels in the order in which a tile is rendered; one slice of pixels a node, one a channel beside colour.
#[derive(Clone, Debug, PartialEq)]
pub struct TileSums {
    /// Red, green, blue and weight of each pixel, node by node.
    pub nodes: Vec<[f32; 4]>,
    /// Bits of the values beside colour, channel by channel; empty unless the samples begin with the first.
    pub aovs: Vec<u32>,
}

/// The places of the nodes that sum the blocks from `first` to `end`, which is left out: `(level, index)`, in order.
///
/// They depend on the range alone, so a file of sums need not hold them.
pub fn node_places(first: u64, end: u64) -> Vec<(u32, u64)> {
    let mut tree = BlockTree::<0>::starting_at(first);
    for _ in first..end {
        tree.push_block([]);
    }
    tree.nodes().iter().map(|node| (node.level, node.index)).collect()
}

/// The sum of a pixel from the sums of ranges of blocks, in order of blocks.
///
/// Ranges that meet give the bits of one run over both; where some are missing, it is the sum of what is there.
pub fn joined(nodes: impl IntoIterator<Item = BlockNode<4>>) -> [f32; 4] {
    let mut runs: Vec<BlockTree<4>> = Vec::new();
    for node in nodes {
        match runs.last_mut().filter(|run| run.next_block() == node.first_block()) {
            Some(run) => run.push(node).expect("it begins with the next block"),
            None => {
                let mut run = BlockTree::starting_at(node.first_block());
                run.push(node).expect("it begins with the next block");
                runs.push(run);
            }
        }
    }
    let totals = runs.iter().map(BlockTree::total);
    totals.reduce(|a, b| std::array::from_fn(|c| a[c] + b[c])).unwrap_or([0.0; 4])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn tree(blocks: std::ops::Range<u64>) -> BlockTree<4> {
        let mut tree = BlockTree::starting_at(blocks.start);
        blocks.for_each(|block| tree.push_block([0.1 + block as f32, 1e7, -0.3 * block as f32, 16.0]));
        tree
    }

    proptest! {
        /// However a run is cut, its parts have the bits of the whole.
        #[test]
        fn cuts_do_not_show(end in 1u64..70, cuts in prop::collection::vec(0u64..70, 0..5)) {
            let mut ends: Vec<u64> = cuts.into_iter().filter(|&cut| cut < end).chain([0, end]).collect();
            ends.sort_unstable();
            let parts = ends.windows(2).flat_map(|w| tree(w[0]..w[1]).nodes().to_vec());
            let bits = |sum: [f32; 4]| sum.map(f32::to_bits);
            prop_assert_eq!(bits(joined(parts)), bits(tree(0..end).total()));
        }

        #[test]
        fn places_are_those_of_a_tree(first in 0u64..50, blocks in 0u64..50) {
            let tree = tree(first..first + blocks);
            let places: Vec<_> = tree.nodes().iter().map(|node| (node.level, node.index)).collect();
            prop_assert_eq!(node_places(first, first + blocks), places);
        }
    }

    #[test]
    fn what_is_missing_is_left_out() {
        let nodes = [tree(0..1), tree(5..6)].map(|tree| tree.nodes()[0]);
        assert_eq!(joined(nodes)[3], 32.0);
        assert_eq!(joined([]), [0.0; 4]);
    }
}
