//! Hashes: words to words that look random, and words to numbers in `[0, 1)`.

use crate::math::{BitLane, Lane};

/// Four words that look random and independent, as a function of all four given.
///
/// Reversible, so no two inputs share an output. Counters go in as they are.
///
/// **Source:** Jarzynski and Olano, Hash Functions for GPU Rendering, JCGT 9(3), 2020, `pcg4d`.
#[inline(always)]
pub fn pcg4d<W: BitLane>([x, y, z, w]: [W; 4]) -> [W; 4] {
    let congruence = |v: W| v.wrapping_mul(W::splat(1_664_525)).wrapping_add(W::splat(1_013_904_223));
    let [x, y, z, w] = cross_multiply([congruence(x), congruence(y), congruence(z), congruence(w)]);
    let fold = |v: W| v ^ v.shr(16);
    cross_multiply([fold(x), fold(y), fold(z), fold(w)])
}

/// Adds to each word the product of two others, one after the other: each step can be undone.
#[inline(always)]
fn cross_multiply<W: BitLane>([mut x, mut y, mut z, mut w]: [W; 4]) -> [W; 4] {
    x = x.wrapping_add(y.wrapping_mul(w));
    y = y.wrapping_add(z.wrapping_mul(x));
    z = z.wrapping_add(x.wrapping_mul(y));
    w = w.wrapping_add(y.wrapping_mul(z));
    [x, y, z, w]
}

/// A number in `[0, 1)` from the top 24 bits of a word, exactly.
///
/// 24 bits are what `f32` holds, so nothing rounds and 1 is never reached.
#[inline(always)]
pub fn unit<L: Lane>(word: L::Bits) -> L {
    L::from_bits(word.shr(8)) * L::constant(1.0 / 16_777_216.0)
}

/// Two key words from a seed: seeds 0, 1, 2 ... give unrelated keys.
pub(super) fn key(seed: u64) -> [u32; 2] {
    let z = splitmix64(seed);
    [z as u32, (z >> 32) as u32]
}

/// One number for another, each once: 0, 1, 2 ... give unrelated ones.
///
/// **Source:** Steele, Lea and Flood, Fast Splittable Pseudorandom Number Generators, 2014, the `SplitMix64` output.
pub(crate) fn splitmix64(seed: u64) -> u64 {
    let mut z = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use wide::{f32x8, u32x8};

    use super::*;
    use crate::sampling::twin::assert_lanes;

    proptest! {
        #[test]
        fn lanes_equal_the_scalar(words in any::<[[u32; 8]; 4]>()) {
            let wide = pcg4d(words.map(u32x8::new));
            for i in 0..8 {
                let scalar = pcg4d(words.map(|w| w[i]));
                for k in 0..4 {
                    prop_assert_eq!(wide[k].get(i), scalar[k]);
                }
            }
            assert_lanes(unit(u32x8::new(words[0])), |i| unit(words[0][i]));
            let _: f32x8 = unit(wide[0]);
        }
    }

    #[test]
    fn unit_covers_its_interval_and_never_reaches_one() {
        assert_eq!(unit::<f32>(0), 0.0);
        assert_eq!(unit::<f32>(u32::MAX), 1.0 - 1.0 / 16_777_216.0);
        assert_eq!(unit::<f64>(u32::MAX), f64::from(unit::<f32>(u32::MAX)));
    }

    /// Flipping any one input bit flips each output bit about half the time (average over 256 small counters).
    #[test]
    fn every_input_bit_reaches_every_top_bit() {
        for (word, bit) in (0..4).flat_map(|w| (0..32).map(move |b| (w, b))) {
            let mut flips = [[0u32; 24]; 4];
            for n in 0..256u32 {
                let input = [n & 15, n >> 4, n % 7, key(u64::from(n))[0]];
                let mut other = input;
                other[word] ^= 1 << bit;
                let (a, b) = (pcg4d(input), pcg4d(other));
                for (k, counts) in flips.iter_mut().enumerate() {
                    for (j, count) in counts.iter_mut().enumerate() {
                        *count += (a[k] ^ b[k]) >> (j + 8) & 1;
                    }
                }
            }
            let average = flips.iter().flatten().sum::<u32>() as f64 / (96.0 * 256.0);
            assert!((average - 0.5).abs() < 0.2, "word {word} bit {bit}: {average}");
        }
    }
}
