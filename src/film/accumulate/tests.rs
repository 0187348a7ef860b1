use proptest::prelude::*;

use super::*;

fn bits<const C: usize>(sum: [f32; C]) -> [u32; C] {
    sum.map(f32::to_bits)
}

/// The tree of the blocks `from..to` of a long list.
fn tree(blocks: &[[f32; 2]], from: usize, to: usize) -> BlockTree<2> {
    let mut tree = BlockTree::starting_at(from as u64);
    blocks[from..to].iter().for_each(|&b| tree.push_block(b));
    tree
}

/// Plain version: a full tree by recursion over halves.
fn recursive_sum(blocks: &[[f32; 2]]) -> [f32; 2] {
    match blocks {
        [] => [0.0; 2],
        [one] => *one,
        _ => {
            let (left, right) = blocks.split_at(blocks.len().next_power_of_two() / 2);
            plus(recursive_sum(left), recursive_sum(right))
        }
    }
}

#[test]
fn gaps_and_overlaps_are_refused() {
    let blocks = [[1.0, 2.0]; 8];
    let mut first = tree(&blocks, 0, 4);
    let before = first.clone();
    assert_eq!(first.append(&tree(&blocks, 5, 8)), Err(NotAdjacent { expected: 4, found: 5 }));
    assert_eq!(first.append(&tree(&blocks, 3, 8)), Err(NotAdjacent { expected: 4, found: 3 }));
    assert_eq!(first, before);
}

#[test]
fn a_total_is_that_of_the_tree_for_few_and_many_samples() {
    for samples in [0, 1, 15, 16, 17, 33, 200] {
        let (mut whole, mut blocks) = (PixelSum::<1>::default(), PixelSum::<1>::default());
        for i in 0..samples {
            whole.push([1.0 / (i as f32 + 0.3)]);
            blocks.push([1.0 / (i as f32 + 0.3)]);
        }
        assert_eq!(bits(whole.total()), bits(blocks.finish().total()), "{samples} samples");
    }
}

#[test]
fn no_samples_sum_to_zero() {
    assert_eq!(PixelSum::<3>::default().finish().total(), [0.0; 3]);
}

#[test]
fn a_pixel_is_its_blocks_and_their_tree() {
    let samples: Vec<[f32; 1]> = (0..100).map(|k| [1.0 / (k as f32 + 1.0)]).collect();
    let (mut pixel, mut by_hand) = (PixelSum::default(), BlockTree::default());
    samples.iter().for_each(|&s| pixel.push(s));
    for block in samples.chunks(SAMPLES_PER_BLOCK as usize) {
        by_hand.push_block(block.iter().fold([0.0], |a, &b| plus(a, b)));
    }
    assert_eq!(*pixel.finish(), by_hand);
    let exact: f64 = samples.iter().map(|s| f64::from(s[0])).sum();
    assert!((f64::from(by_hand.total()[0]) - exact).abs() < 1e-6);
}

fn any_blocks() -> impl Strategy<Value = Vec<[f32; 2]>> {
    prop::collection::vec([-1e3f32..1e3, 1e-6f32..1e6], 1..200)
}

proptest! {
    #[test]
    fn the_tree_is_the_recursive_sum(blocks in any_blocks()) {
        prop_assert_eq!(bits(tree(&blocks, 0, blocks.len()).total()), bits(recursive_sum(&blocks)));
    }

    /// Cuts anywhere, aligned or not, merged from the left or from the right.
    #[test]
    fn shards_merge_to_the_bits_of_one_run(blocks in any_blocks(), cuts in prop::collection::vec(0usize..200, 0..6)) {
        let mut edges: Vec<_> = cuts.into_iter().map(|c| c % blocks.len()).chain([0, blocks.len()]).collect();
        edges.sort_unstable();
        let shards: Vec<_> = edges.windows(2).map(|e| tree(&blocks, e[0], e[1])).collect();
        let mut from_left = BlockTree::default();
        for shard in &shards {
            from_left.append(shard).unwrap();
        }
        let from_right = shards.iter().rev().cloned().reduce(|later, mut earlier| {
            earlier.append(&later).unwrap();
            earlier
        });
        let whole = tree(&blocks, 0, blocks.len());
        prop_assert_eq!(&from_left, &whole);
        prop_assert_eq!(from_right.unwrap(), whole);
    }
}
