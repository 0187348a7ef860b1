//! What must hold of a difference that people see.

use super::*;
use crate::intersect::testing::dice::Dice;

fn picture(width: usize, height: usize, mut value: impl FnMut(usize, usize) -> [f64; 3]) -> Colors {
    let values = (0..width * height).map(|i| value(i % width, i / width)).collect();
    Colors { width, height, values }
}

fn flat(color: [f64; 3]) -> Colors {
    picture(24, 20, |_, _| color)
}

fn mean(a: &Colors, b: &Colors) -> f64 {
    let map = flip(a, b);
    assert!(map.iter().all(|x| (0.0..=1.0).contains(x)));
    map.iter().sum::<f64>() / map.len() as f64
}

fn noisy(dice: &mut Dice, amount: f64) -> Colors {
    picture(24, 20, |x, _| {
        let base = 0.2 + 0.5 * (x as f64 / 24.0);
        std::array::from_fn(|_| (base + amount * dice.between(-1.0, 1.0)).clamp(0.0, 1.0))
    })
}

#[test]
fn a_picture_is_like_itself() {
    let a = noisy(&mut Dice(1), 0.2);
    assert!(flip(&a, &a).iter().all(|&x| x == 0.0));
}

#[test]
fn which_comes_first_does_not_matter() {
    let (a, b) = (noisy(&mut Dice(1), 0.2), noisy(&mut Dice(2), 0.1));
    assert_eq!(flip(&a, &b), flip(&b, &a));
}

#[test]
fn larger_differences_count_more() {
    let a = flat([0.4; 3]);
    let steps = [0.0, 0.02, 0.1, 0.3, 0.6].map(|by| mean(&a, &flat([0.4 + by; 3])));
    assert!(steps.is_sorted_by(|a, b| a < b), "{steps:?}");
    let clean = noisy(&mut Dice(1), 0.0);
    let noise = [0.01, 0.05, 0.2].map(|amount| mean(&clean, &noisy(&mut Dice(3), amount)));
    assert!(noise.is_sorted_by(|a, b| a < b), "{noise:?}");
}

/// The range ends at the difference of green and blue, which is the largest; that of black and white is known to be 0.967.
#[test]
fn the_range_is_that_of_the_paper() {
    assert!((mean(&flat([0.0, 1.0, 0.0]), &flat([0.0, 0.0, 1.0])) - 1.0).abs() < 1e-9);
    let black_white = mean(&flat([0.0; 3]), &flat([1.0; 3]));
    assert!((black_white - 0.967).abs() < 1e-3, "{black_white}");
}

/// What the eye cannot resolve is hardly seen: pixels that alternate, against their mean.
#[test]
fn what_is_too_fine_is_blurred_away() {
    let fine = picture(48, 48, |x, y| [if (x + y) % 2 == 0 { 0.0 } else { 1.0 }; 3]);
    // The sRGB value of half the light.
    let grey = picture(48, 48, |_, _| [0.735_357; 3]);
    let coarse = picture(48, 48, |x, y| [if (x / 12 + y / 12) % 2 == 0 { 0.0 } else { 1.0 }; 3]);
    assert!(
        mean(&fine, &grey) < 0.4 * mean(&coarse, &grey),
        "{} {}",
        mean(&fine, &grey),
        mean(&coarse, &grey)
    );
}

/// An edge that appears counts for more than the same change of colour without one.
#[test]
fn edges_and_points_raise_the_difference() {
    let (grey, brighter) = (flat([0.5; 3]), flat([0.55; 3]));
    let stripe = picture(24, 20, |x, _| [if x < 12 { 0.5 } else { 0.55 }; 3]);
    let at_edge = flip(&grey, &stripe)[10 * 24 + 12];
    assert!(at_edge > mean(&grey, &brighter), "{at_edge}");
}

#[test]
fn one_pixel_is_a_picture() {
    let one = |x: f64| picture(1, 1, |_, _| [x; 3]);
    assert!(mean(&one(0.0), &one(1.0)) > 0.9);
}
