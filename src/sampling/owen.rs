//! Owen-scrambled Sobol points in two dimensions, in integer operations that lanes have.

use crate::math::BitLane;

/// Bit `i` of each word becomes bit `31 - i`.
#[inline(always)]
pub(super) fn reverse_bits<W: BitLane>(mut v: W) -> W {
    for (by, mask) in [(1, 0x5555_5555), (2, 0x3333_3333), (4, 0x0f0f_0f0f), (8, 0x00ff_00ff)] {
        let mask = W::splat(mask);
        v = (v.shr(by) & mask) | (v & mask).shl(by);
    }
    v.shr(16) | v.shl(16)
}

/// A random permutation in which each bit is flipped depending only on the bits below it: on reversed bits, Owen's
/// nested uniform scramble in base 2.
///
/// **Source:** Laine and Karras, Stratified Sampling for Stochastic Transparency, 2011, with the constants of Vegdahl,
/// Building a Better LK Hash, 2021. `seed` has to look random itself.
#[inline(always)]
fn laine_karras<W: BitLane>(mut v: W, seed: W) -> W {
    let xor_multiple = |v: W, even: u32| v ^ v.wrapping_mul(W::splat(even));
    v = xor_multiple(v, 0x3d20_adea).wrapping_add(seed);
    v = v.wrapping_mul(seed.shr(16) | W::splat(1));
    xor_multiple(xor_multiple(v, 0x0552_6c56), 0x53a2_2864)
}

/// The second Sobol coordinate of point `index`, its bits reversed.
///
/// The generator matrix is Pascal's triangle modulo 2, the fifth Kronecker power of `[1 1; 0 1]`: so the product takes five
/// masked shifts in place of 32 conditional direction numbers.
#[inline(always)]
fn sobol_second_reversed<W: BitLane>(index: W) -> W {
    let halves = [(16, 0xffff_0000), (8, 0xff00_ff00), (4, 0xf0f0_f0f0), (2, 0xcccc_cccc), (1, 0xaaaa_aaaa)];
    halves.into_iter().fold(index, |v, (by, upper)| v ^ (v & W::splat(upper)).shr(by))
}

/// Point `index` of a shuffled and scrambled Sobol sequence as two 32-bit fractions.
///
/// Each aligned block of `2^k` indices is a (0, k, 2)-net: one point in every elementary interval of area `2^-k`. Points
/// of different seeds are independent, so pairs of dimensions are padded with seeds rather than with further matrices.
///
/// **Source:** Burley, Practical Hash-based Owen Scrambling, JCGT 9(4), 2020. The first coordinate of the sequence is the
/// reversed index itself, so two of his reversals cancel.
#[inline(always)]
pub(super) fn scrambled_sobol<W: BitLane>(index: W, [shuffle, first, second]: [W; 3]) -> [W; 2] {
    let shuffled = reverse_bits(laine_karras(reverse_bits(index), shuffle));
    let x = laine_karras(shuffled, first);
    let y = laine_karras(sobol_second_reversed(shuffled), second);
    [reverse_bits(x), reverse_bits(y)]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use wide::u32x8;

    use super::*;
    use crate::sampling::hash::pcg4d;

    /// Plain version: direction numbers, one at a time.
    fn sobol_second_by_direction_numbers(index: u32) -> u32 {
        let mut direction = 1u32 << 31;
        let mut value = 0;
        for bit in 0..32 {
            if index >> bit & 1 != 0 {
                value ^= direction;
            }
            direction ^= direction >> 1;
        }
        value
    }

    proptest! {
        #[test]
        fn the_kronecker_form_is_the_sobol_matrix(index in any::<u32>()) {
            prop_assert_eq!(sobol_second_reversed(index).reverse_bits(), sobol_second_by_direction_numbers(index));
            prop_assert_eq!(reverse_bits(index), index.reverse_bits());
        }

        #[test]
        fn lanes_equal_the_scalar(index in any::<[u32; 8]>(), seeds in any::<[[u32; 8]; 3]>()) {
            let wide = scrambled_sobol(u32x8::new(index), seeds.map(u32x8::new));
            for i in 0..8 {
                let scalar = scrambled_sobol(index[i], seeds.map(|s| s[i]));
                prop_assert_eq!([wide[0].get(i), wide[1].get(i)], scalar);
            }
        }
    }

    fn assert_net(points: &[[u32; 2]], log2: u32, what: &str) {
        for columns in 0..=log2 {
            let mut filled = vec![false; points.len()];
            for &[x, y] in points {
                let column = u64::from(x) >> (32 - columns);
                let row = u64::from(y) >> (32 - (log2 - columns));
                let cell = (column << (log2 - columns) | row) as usize;
                assert!(
                    !std::mem::replace(&mut filled[cell], true),
                    "{what}: 2^{columns} columns, cell {cell}"
                );
            }
        }
    }

    #[test]
    fn every_aligned_block_is_a_net() {
        for seed in 0..20 {
            let [a, b, c, _] = pcg4d([seed, 1, 2, 3]);
            for log2 in [0, 1, 2, 3, 4, 6, 8, 10] {
                for start in [0u32, 1, 5, 1 << 12] {
                    let first = start << log2;
                    let points: Vec<_> =
                        (first..first + (1 << log2)).map(|i| scrambled_sobol(i, [a, b, c])).collect();
                    assert_net(&points, log2, &format!("seed {seed}, {first} + 2^{log2}"));
                }
            }
        }
    }

    #[test]
    fn a_long_sequence_is_a_net() {
        let points: Vec<_> =
            (0..1 << 17).map(|i| scrambled_sobol(i, pcg4d([9; 4])[..3].try_into().unwrap())).collect();
        assert_net(&points, 17, "2^17");
    }
}
