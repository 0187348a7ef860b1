//! Looking up textures.

use wide::f32x8;

use crate::load::{Texture, linear_from_srgb};
use crate::math::{Lane, Vec3, WIDTH, eight, three};

/// The linear colour of a texture at a place, between its four nearest texels; the picture repeats.
///
/// **Units:** `uv` spans the picture once from 0 to 1, `v` upwards. A place that is not finite is black.
pub fn sample_texture(texture: &Texture, [u, v]: [f32; 2]) -> [f32; 3] {
    sample_lanes(texture, (u, v)).get(0)
}

/// The same at the places of eight lanes.
#[inline(never)]
pub(crate) fn sample_eight(texture: &Texture, uv: (f32x8, f32x8)) -> Vec3<f32x8> {
    sample_lanes(texture, uv)
}

#[inline(always)]
fn sample_lanes<L: Lane<Scalar = f32>>(texture: &Texture, (u, v): (L, L)) -> Vec3<L> {
    let finite = u.is_finite() & v.is_finite();
    let (columns, fx) = neighbours(u, texture.width);
    let (rows, fy) = neighbours(L::one() - v, texture.height);
    let table = linear_from_srgb();
    let texels = |row: &[u32; WIDTH], column: &[u32; WIDTH]| -> Vec3<L> {
        let texel = eight(|i| texture.texel(column[i % L::WIDTH], row[i % L::WIDTH]));
        let [x, y, z] = three(|c| L::from_fn(|i| table[usize::from(texel[i][c])]));
        Vec3 { x, y, z }
    };
    let mix = |a: Vec3<L>, b: Vec3<L>, f: L| a * (L::one() - f) + b * f;
    let row = |row: &[u32; WIDTH]| mix(texels(row, &columns[0]), texels(row, &columns[1]), fx);
    Vec3::select(finite, mix(row(&rows[0]), row(&rows[1]), fy), Vec3::zero())
}

/// The two texels around coordinates, and how far those are from the first to the second.
#[inline(always)]
fn neighbours<L: Lane<Scalar = f32>>(coordinate: L, size: u32) -> ([[u32; WIDTH]; 2], L) {
    let at = (coordinate - coordinate.floor()) * L::splat(size as f32) - L::constant(0.5);
    let first = at.floor();
    // From one before the first texel to the one after the last; what is not a number is 0.
    let wrap = |i: f32| match i as i64 {
        -1 => size - 1,
        i if i >= i64::from(size) => 0,
        i => i as u32,
    };
    let texels = |of: L| eight(|i| wrap(of.get(i % L::WIDTH)));
    ([texels(first), texels(first + L::one())], at - first)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::intersect::testing::dice::Dice;

    #[test]
    fn the_middle_of_a_texel_is_its_colour_and_the_picture_repeats() {
        let (black, white) = ([0, 0, 0, 255], [255; 4]);
        let texture = Texture { width: 2, height: 2, texels: vec![white, black, black, black] };
        for turn in [-3.0, 0.0, 7.0] {
            assert_eq!(sample_texture(&texture, [0.25 + turn, 0.75 - turn]), [1.0; 3], "top left is first");
            assert_eq!(sample_texture(&texture, [0.75 + turn, 0.75]), [0.0; 3]);
        }
        assert_eq!(sample_texture(&texture, [0.5, 0.75]), [0.5; 3]);
        assert_eq!(sample_texture(&texture, [f32::NAN, 0.0]), [0.0; 3]);
    }

    #[test]
    fn eight_lanes_equal_one() {
        let texels = (0..35u8).map(|i| [7 * i, 255 - i, 3 * i, 255]).collect();
        let texture = Texture { width: 7, height: 5, texels };
        let odd =
            [0.0, -0.0, 1.0, -1e-9, 0.999_999_94, 1e9, -3.7, f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
        let mut dice = Dice(61);
        for _ in 0..10_000 {
            let mut coordinates =
                || eight(|_| [dice.between(-3.0, 3.0) as f32, odd[dice.below(10)]][dice.below(2)]);
            let (u, v) = (coordinates(), coordinates());
            let together = sample_eight(&texture, (f32x8::new(u), f32x8::new(v)));
            for i in 0..WIDTH {
                let alone = sample_texture(&texture, [u[i], v[i]]);
                assert_eq!(together.get(i).map(f32::to_bits), alone.map(f32::to_bits), "{} {}", u[i], v[i]);
            }
        }
    }
}
