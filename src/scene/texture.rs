//! Looking up textures.

use crate::load::Texture;

/// The linear colour of a texture at a place, between its four nearest texels; the picture repeats.
///
/// **Units:** `uv` spans the picture once from 0 to 1, `v` upwards. A place that is not finite is black.
pub fn sample_texture(texture: &Texture, [u, v]: [f32; 2]) -> [f32; 3] {
    if !(u.is_finite() && v.is_finite()) {
        return [0.0; 3];
    }
    let (x0, x1, fx) = neighbours(u, texture.width);
    let (y0, y1, fy) = neighbours(1.0 - v, texture.height);
    let mix = |a: [f32; 3], b: [f32; 3], f: f32| std::array::from_fn(|c| a[c] * (1.0 - f) + b[c] * f);
    let row = |y| mix(texture.linear(x0, y), texture.linear(x1, y), fx);
    mix(row(y0), row(y1), fy)
}

/// The two texels around a coordinate, and how far it is from the first to the second.
fn neighbours(coordinate: f32, size: u32) -> (u32, u32, f32) {
    let at = (coordinate - coordinate.floor()) * size as f32 - 0.5;
    let first = at.floor();
    let wrap = |i: f32| (i as i64).rem_euclid(i64::from(size)) as u32;
    (wrap(first), wrap(first + 1.0), at - first)
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
