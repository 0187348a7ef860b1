//! A hilly mesh of any number of triangles, made from integer hashes: the same on every machine.

use super::Mesh;
use super::normals::make_smooth;
use rayon::prelude::*;

const OCTAVES: u32 = 10;
/// Height of the highest possible hill.
const HEIGHT: f64 = 0.45;

/// A terrain of about `triangles` triangles over the square -1..1 in x and z; heights from 0 to 0.45 in y.
///
/// **Accuracy**: two triangles a cell of a grid, so within a percent of the number above 20,000.
/// **Needs**: fewer than 2^32 vertices, that is at most about 8 x 10^9 triangles; 0 is taken as 2.
#[must_use]
pub fn terrain(triangles: u64, seed: u64, smooth: bool) -> Mesh {
    let cells = (triangles.max(2) / 2) as f64;
    let columns = cells.sqrt().round().max(1.0) as u32;
    let rows = (cells / f64::from(columns)).round().max(1.0) as u32;
    let mut mesh = Mesh {
        positions: positions(columns, rows, seed),
        triangles: triangulate(columns, rows),
        ..Mesh::default()
    };
    mesh.report.triangles_read = mesh.triangles.len();
    if smooth {
        make_smooth(&mut mesh);
    }
    mesh
}

fn positions(columns: u32, rows: u32, seed: u64) -> Vec<[f32; 3]> {
    let width = columns as usize + 1;
    let mut positions = vec![[0.0; 3]; width * (rows as usize + 1)];
    positions.par_chunks_mut(width).enumerate().for_each(|(row, line)| {
        let z = 2.0 * row as f64 / f64::from(rows) - 1.0;
        for (column, position) in line.iter_mut().enumerate() {
            let x = 2.0 * column as f64 / f64::from(columns) - 1.0;
            *position = [x as f32, height(x, z, seed) as f32, z as f32];
        }
    });
    positions
}

/// Counter-clockwise from above; the diagonals alternate, so that no direction stands out.
fn triangulate(columns: u32, rows: u32) -> Vec<[u32; 3]> {
    let width = columns as usize;
    let mut triangles = vec![[0; 3]; 2 * width * rows as usize];
    triangles.par_chunks_mut(2 * width).enumerate().for_each(|(row, line)| {
        for (column, pair) in line.chunks_exact_mut(2).enumerate() {
            let a = (row * (width + 1) + column) as u32;
            let (b, c, d) = (a + 1, a + columns + 1, a + columns + 2);
            let even = (row + column) % 2 == 0;
            let [first, second] = if even { [[a, c, d], [a, d, b]] } else { [[a, c, b], [b, c, d]] };
            (pair[0], pair[1]) = (first, second);
        }
    });
    triangles
}

/// Octaves of noise, each turned, twice as fine and a little less than half as high as the one before.
fn height(x: f64, z: f64, seed: u64) -> f64 {
    let (mut x, mut z) = (1.7 * x + 7.0, 1.7 * z + 3.0);
    let (mut sum, mut weight, mut total) = (0.0, 1.0, 0.0);
    for octave in 0..OCTAVES {
        let ridge = 1.0 - (2.0 * noise(x, z, seed, octave) - 1.0).abs();
        sum += weight * ridge * ridge;
        total += weight;
        weight *= 0.46;
        // 3-4-5 triangle: a turn by 36.87 degrees without any rounding to speak of.
        (x, z) = (2.0 * (0.8 * x - 0.6 * z) + 11.0, 2.0 * (0.6 * x + 0.8 * z) + 5.0);
    }
    HEIGHT * sum / total
}

/// Value noise: a hash at each corner of the lattice, blended with a curve without kinks.
///
/// **Source**: quintic fade of Perlin, "Improving Noise", 2002.
fn noise(x: f64, z: f64, seed: u64, octave: u32) -> f64 {
    let (cell_x, cell_z) = (x.floor(), z.floor());
    let fade = |t: f64| t * t * t * (t * (6.0 * t - 15.0) + 10.0);
    let (u, v) = (fade(x - cell_x), fade(z - cell_z));
    let at = |dx: i64, dz: i64| lattice(cell_x as i64 + dx, cell_z as i64 + dz, seed, octave);
    let blend = |a: f64, b: f64, t: f64| a + t * (b - a);
    blend(blend(at(0, 0), at(1, 0), u), blend(at(0, 1), at(1, 1), u), v)
}

/// A number from 0 to below 1 for a lattice point.
///
/// **Source**: the finalizer of SplitMix64 (Steele, Lea, Flood 2014).
fn lattice(x: i64, z: i64, seed: u64, octave: u32) -> f64 {
    let mut h = (x as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15)
        ^ (z as u64).wrapping_mul(0xD1B5_4A32_D192_ED03)
        ^ seed.wrapping_add(u64::from(octave)).wrapping_mul(0x2545_F491_4F6C_DD1D);
    h = (h ^ (h >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    h = (h ^ (h >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((h ^ (h >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn number_of_triangles_is_about_what_was_asked() {
        assert_eq!(terrain(0, 0, false).triangles.len(), 2);
        for asked in [2u64, 7, 100, 20_000, 123_457] {
            let made = terrain(asked, 0, false).triangles.len() as f64;
            let off = (made - asked as f64).abs();
            assert!(
                off <= 2.0 + 0.01 * asked as f64 || asked < 20_000 && off <= 0.2 * asked as f64,
                "{made}"
            );
        }
    }

    #[test]
    fn all_triangles_face_upwards_and_stay_in_their_box() {
        let mesh = terrain(5_000, 3, true);
        for t in &mesh.triangles {
            let normal = super::super::normals::cross_product(t.map(|v| mesh.positions[v as usize]));
            assert!(normal[1] > 0.0);
        }
        let [low, high] = mesh.bounds().unwrap();
        assert_eq!([low[0], low[2], high[0], high[2]], [-1.0, -1.0, 1.0, 1.0]);
        assert!(low[1] >= 0.0 && high[1] <= HEIGHT as f32 && high[1] - low[1] > 0.1);
        assert_eq!(mesh.normals.len(), mesh.positions.len());
    }

    #[test]
    fn the_same_numbers_give_the_same_bits_and_seeds_differ() {
        assert_eq!(terrain(1_000, 0, false), terrain(1_000, 0, false));
        assert_ne!(terrain(1_000, 0, false), terrain(1_000, 1, false));
        // Any change of this value is a change of every picture of `terrain`.
        assert_eq!(height(0.25, -0.5, 0).to_bits(), HEIGHT_AT_QUARTER_BITS);
    }

    const HEIGHT_AT_QUARTER_BITS: u64 = 4_592_036_113_440_526_111;
}
