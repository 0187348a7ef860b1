//! Accumulation in a fixed order and the tone curve.

mod accumulate;

pub use accumulate::{BlockNode, BlockTree, ExactSum, NotAdjacent, PixelSum, SAMPLES_PER_BLOCK, SampleSums};
