//! A seed of its own for every picture.

use crate::sampling::splitmix64;

/// What a whole number in a TOML file can hold.
const MASK: u64 = u64::MAX >> 1;

/// The seed of a picture by its number in the plan: pictures of one base count on from a place that the base chooses, so that
/// they never share a seed, and those of neighbouring bases do not either.
pub(super) fn of_picture(base: u64, picture: u64) -> u64 {
    splitmix64(base).wrapping_add(picture) & MASK
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::HashSet;

    proptest! {
        #[test]
        fn pictures_of_a_base_never_share_a_seed(base: u64, a: u64, b: u64) {
            prop_assert_eq!((a ^ b) & MASK == 0, of_picture(base, a) == of_picture(base, b));
            prop_assert!(i64::try_from(of_picture(base, a)).is_ok(), "a TOML file can hold it");
        }
    }

    #[test]
    fn neighbouring_bases_share_none_of_their_first_seeds() {
        let seeds = (0..50).flat_map(|base| (0..2000).map(move |picture| of_picture(base, picture)));
        assert_eq!(seeds.collect::<HashSet<_>>().len(), 50 * 2000);
    }
}
