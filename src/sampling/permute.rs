//! Random orders of `0..length` as a function: no table, no state.

use crate::math::{BitLane, Lane, Mask};

/// Six rounds leave pairs of places within a fifth of evenly likely for all small lengths (Kensler's rounds: a factor of 3).
const ROUNDS: usize = 6;
/// Odd numbers with well-mixed bits, one a round: the fractional parts of the square roots of primes.
const MULTIPLIERS: [u32; ROUNDS] =
    [0x6a09_e667, 0xbb67_ae85, 0x3c6e_f373, 0xa54f_f53b, 0x9b05_688d, 0x5be0_cd19];

/// One if `a < b`, else zero; for words below 2^31.
#[inline(always)]
fn less<W: BitLane>(a: W, b: u32) -> W {
    a.wrapping_add(W::splat(b.wrapping_neg())).shr(31)
}

/// `yes` where `flag` is 1, `no` where it is 0.
#[inline(always)]
fn choose<W: BitLane>(flag: W, yes: W, no: W) -> W {
    no ^ ((yes ^ no) & flag.wrapping_mul(W::splat(u32::MAX)))
}

/// A keyed permutation of the words below `mask + 1`, a power of two.
///
/// Every step can be undone within the mask: sum with a key, product with an odd number, xor with own upper half.
#[inline(always)]
fn permute_power_of_two<W: BitLane>(mut i: W, mask: u32, keys: &[W; ROUNDS]) -> W {
    let half = mask.count_ones().div_ceil(2);
    for (key, multiplier) in keys.iter().zip(MULTIPLIERS) {
        i = i.wrapping_add(*key).wrapping_mul(W::splat(multiplier) ^ key.shr(20).shl(1)) & W::splat(mask);
        i = i ^ i.shr(half);
    }
    i
}

/// The place of `index` in a random order of `0..length`, one order a `key`.
///
/// A permutation of the next power of two, applied again while the result falls outside: it returns to the inside within
/// one round trip of its cycle, twice on average at worst. Lanes that are inside wait, so each gets what it gets alone.
///
/// **Needs:** `index < length`, `1 <= length < 2^31`, keys that look random. A greater index gives a place below `length`, too.
///
/// **Source:** Kensler, Correlated Multi-Jittered Sampling, 2013; the rounds are ours, and the closing rotation takes
/// a product in place of a remainder, which lanes do not have.
#[inline(always)]
pub(super) fn permute<L: Lane>(index: L::Bits, length: u32, key: L::Bits) -> L::Bits {
    let mask = (length - 1).checked_ilog2().map_or(0, |top| u32::MAX >> (31 - top));
    let keys = MULTIPLIERS.map(|m| hashed(key.wrapping_mul(L::Bits::splat(m))));
    let mut place = permute_power_of_two(index & L::Bits::splat(mask), mask, &keys);
    for _ in length..=mask {
        let inside = less(place, length);
        if !L::from_bits(inside).lt(L::one()).any() {
            break;
        }
        place = choose(inside, place, permute_power_of_two(place, mask, &keys));
    }
    rotate(place, length, hashed(key))
}

/// The upper bits of a word spread over the lower ones, which is where small masks look.
#[inline(always)]
fn hashed<W: BitLane>(word: W) -> W {
    let mixed = (word ^ word.shr(16)).wrapping_mul(W::splat(0x7feb_352d));
    mixed ^ mixed.shr(15)
}

/// `place` plus a random amount, modulo `length`: makes each single place exactly as likely as another.
#[inline(always)]
fn rotate<W: BitLane>(place: W, length: u32, key: W) -> W {
    let bits = 32 - length.leading_zeros();
    let amount = key.shr(bits).wrapping_mul(W::splat(length)).shr(32 - bits);
    let moved = place.wrapping_add(amount);
    choose(less(moved, length), moved, moved.wrapping_add(W::splat(length.wrapping_neg())))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use wide::{f32x8, u32x8};

    use super::*;
    use crate::sampling::hash::pcg4d;

    fn key(n: u32) -> u32 {
        pcg4d([n, 1, 2, 3])[0]
    }

    #[test]
    fn every_order_is_a_permutation() {
        for length in (1..70).chain([127, 128, 129, 1000, 65_537]) {
            for n in 0..if length < 100 { 50 } else { 2 } {
                let mut filled = vec![false; length as usize];
                for i in 0..length {
                    let place = permute::<f32>(i, length, key(n)) as usize;
                    assert!(!std::mem::replace(&mut filled[place], true), "length {length}, key {n}");
                }
            }
        }
    }

    /// Counts of cells over 40,000 keys, each within `tolerance` of the average.
    fn assert_even(length: u32, cells: u32, tolerance: f64, cell: impl Fn(u32) -> u32) {
        let mut counts = vec![0u32; (length * length) as usize];
        (0..40_000).for_each(|n| counts[cell(n) as usize] += 1);
        let average = 40_000.0 / f64::from(cells);
        let used: Vec<_> = counts.into_iter().filter(|&c| c > 0).collect();
        assert_eq!(used.len(), cells as usize, "length {length}");
        for count in used {
            assert!(
                (f64::from(count) / average - 1.0).abs() < tolerance,
                "length {length}: {count} of {average}"
            );
        }
    }

    /// Single places within five standard deviations; pairs of places within those and a fifth, see [`ROUNDS`].
    #[test]
    fn places_and_pairs_of_places_are_equally_likely() {
        for length in [2u32, 3, 4, 5, 7, 8, 13, 16, 25] {
            let place = |i, n| permute::<f32>(i, length, key(n));
            let noise = |cells: u32| 5.0 * (f64::from(cells) / 40_000.0).sqrt();
            assert_even(length, length, noise(length), |n| place(0, n));
            let pairs = length * (length - 1);
            assert_even(length, pairs, noise(pairs) + 0.2, |n| place(0, n) * length + place(1, n));
        }
    }

    proptest! {
        #[test]
        fn lanes_equal_the_scalar(raw in any::<[u32; 8]>(), keys in any::<[u32; 8]>(), length in 1u32..5000) {
            let index = raw.map(|r| r % length);
            let wide = permute::<f32x8>(u32x8::new(index), length, u32x8::new(keys));
            for i in 0..8 {
                prop_assert_eq!(wide.get(i), permute::<f32>(index[i], length, keys[i]));
            }
        }
    }
}
