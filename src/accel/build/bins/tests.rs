//! Against one axis after the other.

use super::super::tests::{cube, unit};
use super::*;

/// Three axes side by side, two sets of bins and counts in registers choose what one axis after the other does.
#[test]
fn the_best_cut_of_all_axes_is_that_of_each() {
    for round in 0..400_u32 {
        let len = [2, 7, 48, 49, 333, 5_000][round as usize % 6] - round as usize % 2;
        let kind = 1 + 3 * (round % 3 / 2) as u8;
        let at = |i: u32| [0, 1, 2].map(|k| unit(91 * round + 3 * i + k));
        let at = |i: u32| at(i).map(|x| if round / 6 % 2 == 0 { x } else { (5.0 * x).floor() });
        let item = |i: u32| Item::new(i, &cube(at(i), 0.2 * unit(7 * round + i), kind));
        let items: Vec<Item> = (0..len as u32).map(item).collect();
        let extent = Extent::of(&items);
        let on = |axis| best_on(axis, &sides_on::<MANY>(axis, &items, &extent));
        let expected = (0..3).filter_map(on).reduce(Cut::better);
        let found = Bins::<MANY>::of(&items, &extent).best();
        let key = |cut: Cut| (cut.axis, cut.bin, cut.cost, cut.larger_side);
        assert_eq!(found.map(key), expected.map(key));
        let Some(cut) = found else { continue };
        let bin = Binning::new::<MANY>(extent.centroids).on_axis::<MANY>(cut.axis);
        let mut parted = items.clone();
        let Parted { middle, sides } = part_at::<MANY>(&mut parted, &extent, &cut);
        let is_left = |item: &Item| bin(item) < cut.bin;
        assert!(parted[..middle].iter().all(is_left) && !parted[middle..].iter().any(is_left));
        for (side, range) in sides.iter().zip([&parted[..middle], &parted[middle..]]) {
            let around = range.iter().fold(Box8::EMPTY, |all, item| all.join(item.bounds));
            assert_eq!(side.bounds.to_aabb(), around.to_aabb());
            assert_eq!(side.centroids.to_aabb(), Extent::of(range).centroids.to_aabb());
        }
    }
}
