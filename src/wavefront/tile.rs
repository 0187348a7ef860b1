//! Tiles: which pixels a worker renders at a time, and in which order.

use crate::film::PixelSum;

/// Edge of a tile in pixels.
pub(super) const TILE: u32 = 32;
/// Pixels that share a packet: a block of this width and height.
const BLOCK: [u32; 2] = [4, 2];
/// Pixels that share a bundle, and a small one.
const BUNDLE: [u32; 2] = [16, 16];
const SMALL_BUNDLE: [u32; 2] = [8, 8];

/// A rectangle of pixels: left, top, width, height.
pub(crate) type Rect = [u32; 4];

/// The tiles that cover a rectangle, row by row.
pub(crate) fn tiles(rect: Rect) -> Vec<Rect> {
    parts(rect, [TILE; 2]).collect()
}

/// The pixels of a tile, bundle by bundle and in it block by block, so that eight neighbours in the list are neighbours in
/// the picture, and 64, and 256 too.
pub(crate) fn pixels(tile: Rect, list: &mut Vec<[u32; 2]>) {
    list.clear();
    let small = parts(tile, BUNDLE).flat_map(|bundle| parts(bundle, SMALL_BUNDLE));
    for [x, y, width, height] in small.flat_map(|bundle| parts(bundle, BLOCK)) {
        (y..y + height).for_each(|y| list.extend((x..x + width).map(|x| [x, y])));
    }
}

/// The parts of at most this width and height that make up a rectangle, row by row.
fn parts([x, y, width, height]: Rect, [w, h]: [u32; 2]) -> impl Iterator<Item = Rect> {
    let (right, bottom) = (x + width, y + height);
    let row = move |y: u32| {
        (x..right).step_by(w as usize).map(move |x| [x, y, w.min(right - x), h.min(bottom - y)])
    };
    (y..bottom).step_by(h as usize).flat_map(row)
}

/// Sums of the pixels of a tile: three channels and the weight.
pub(super) type Sums = Vec<PixelSum<4>>;

/// The mean of a pixel's samples: over the sum of weights, which is their number where samples have no weights.
pub(crate) fn mean([r, g, b, weight]: [f32; 4]) -> [f32; 3] {
    // Weights of a filter with negative lobes may cancel in a pixel with few samples: such a pixel says nothing.
    if weight > 0.0 { [r / weight, g / weight, b / weight] } else { [0.0; 3] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn tiles_and_their_pixels_cover_every_pixel_once() {
        for rect in [[0, 0, 64, 64], [3, 5, 70, 33], [9, 9, 1, 1], [0, 0, 33, 2]] {
            let mut seen = HashSet::new();
            let mut list = Vec::new();
            for tile in tiles(rect) {
                pixels(tile, &mut list);
                assert!(list.iter().all(|&p| seen.insert(p)), "a pixel twice");
            }
            assert_eq!(seen.len() as u32, rect[2] * rect[3]);
            assert!(seen.iter().all(|&[x, y]| {
                (rect[0]..rect[0] + rect[2]).contains(&x) && (rect[1]..rect[1] + rect[3]).contains(&y)
            }));
        }
    }
}
