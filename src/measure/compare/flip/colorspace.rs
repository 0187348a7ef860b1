//! From sRGB to spaces in which differences mean something.

use crate::math::three;

/// Lightness, and two colour axes.
pub(super) type Lab = [f64; 3];

/// sRGB primaries to CIE XYZ.
///
/// **Source:** IEC 61966-2-1.
const XYZ_FROM_RGB: [[f64; 3]; 3] = [
    [10_135_552.0 / 24_577_794.0, 8_788_810.0 / 24_577_794.0, 4_435_075.0 / 24_577_794.0],
    [2_613_072.0 / 12_288_897.0, 8_788_810.0 / 12_288_897.0, 887_015.0 / 12_288_897.0],
    [1_425_312.0 / 73_733_382.0, 8_788_810.0 / 73_733_382.0, 70_074_185.0 / 73_733_382.0],
];

/// The light of an sRGB value.
pub(super) fn linear(x: f64) -> f64 {
    if x <= 0.04045 { x / 12.92 } else { libm::pow((x + 0.055) / 1.055, 2.4) }
}

/// Over that of white.
fn xyz(rgb: [f64; 3]) -> [f64; 3] {
    three(|r| {
        let row = XYZ_FROM_RGB[r];
        (0..3).map(|k| row[k] * rgb[k]).sum::<f64>() / row.iter().sum::<f64>()
    })
}

/// Light, red against green, blue against yellow, all linear: the space in which contrast sensitivity is known.
pub(super) fn opponent(rgb: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = xyz(rgb);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// The way back.
pub(super) fn unopponent([light, red_green, blue_yellow]: [f64; 3]) -> [f64; 3] {
    let y = (light + 16.0) / 116.0;
    rgb([y + red_green / 500.0, y, y - blue_yellow / 200.0])
}

/// Cramer's rule on the matrix of [`xyz`].
fn rgb(xyz: [f64; 3]) -> [f64; 3] {
    let target = three(|r| xyz[r] * XYZ_FROM_RGB[r].iter().sum::<f64>());
    let determinant = |m: &[[f64; 3]; 3]| {
        let minor = |i: usize, j: usize| m[1][i] * m[2][j] - m[1][j] * m[2][i];
        m[0][0] * minor(1, 2) + m[0][1] * minor(2, 0) + m[0][2] * minor(0, 1)
    };
    let whole = determinant(&XYZ_FROM_RGB);
    three(|k| {
        let mut replaced = XYZ_FROM_RGB;
        (0..3).for_each(|r| replaced[r][k] = target[r]);
        determinant(&replaced) / whole
    })
}

/// CIE L*a*b*.
pub(super) fn lab(rgb: [f64; 3]) -> Lab {
    const KNEE: f64 = 6.0 / 29.0;
    let [x, y, z] = xyz(rgb).map(|t| match t {
        t if t > KNEE * KNEE * KNEE => libm::cbrt(t),
        t => t / (3.0 * KNEE * KNEE) + 4.0 / 29.0,
    });
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Colours fade in the dark.
pub(super) fn hunt([light, a, b]: Lab) -> Lab {
    [light, 0.01 * light * a, 0.01 * light * b]
}

/// A distance that suits large differences: that of lightness plus that of colour.
pub(super) fn hyab(p: Lab, q: Lab) -> f64 {
    (p[0] - q[0]).abs() + (p[1] - q[1]).hypot(p[2] - q[2])
}
