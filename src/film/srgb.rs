//! The sRGB transfer function between linear light and 8 bits, exact and fast.
//!
//! Light is cut into 4096 cells of equal width. The steepest part of the curve climbs 12.92 * 255 / 4096 = 0.8 codes
//! in a cell, so a cell holds at most one boundary between two codes: the code at the cell's start and one comparison
//! with the exact boundary give the correctly rounded byte.
//!
//! **Source**: IEC 61966-2-1:1999, section 5.2.

use std::sync::LazyLock;

const CELLS: usize = 4096;

static TABLE: LazyLock<SrgbTable> = LazyLock::new(SrgbTable::new);

/// The byte of linear light `value`: 0 for anything at or below zero and for NaN, 255 for one and above.
///
/// **Accuracy**: exact; `255 * curve(value)` rounded to nearest, the same on every machine.
pub fn srgb8_from_linear(value: f32) -> u8 {
    TABLE.encode(value)
}

/// The linear light of an sRGB byte.
///
/// **Accuracy**: the nearest f32, up to the error of `libm::pow` in f64.
pub fn linear_from_srgb8(byte: u8) -> f32 {
    decode(f64::from(byte) / 255.0) as f32
}

/// The codes at the cells' starts and the boundaries between codes.
pub(super) struct SrgbTable {
    code_at_start: [u8; CELLS],
    /// `boundary[k]` is the least f32 whose byte is `k`; above 255 there is none.
    boundary: [f32; 257],
}

impl SrgbTable {
    /// The one table, made at its first use.
    pub(super) fn get() -> &'static Self {
        &TABLE
    }

    fn new() -> Self {
        let boundary = std::array::from_fn(least_light_of);
        let code_at_start = std::array::from_fn(|cell| {
            let start = cell as f32 / CELLS as f32;
            (boundary.partition_point(|&light| light <= start) - 1) as u8
        });
        Self { code_at_start, boundary }
    }

    /// The byte of linear light `value`, as [`srgb8_from_linear`].
    #[inline(always)]
    pub(super) fn encode(&self, value: f32) -> u8 {
        self.encode_in(Self::cell(value), value)
    }

    /// The bytes of many values: the cells of all of them first, which needs no table and so goes eight at a time.
    #[inline(always)]
    pub(super) fn encode_all<const N: usize>(&self, values: &[f32; N], bytes: &mut [u8; N]) {
        let mut cells = [0; N];
        for (cell, &value) in cells.iter_mut().zip(values) {
            *cell = Self::cell(value);
        }
        for (byte, (&cell, &value)) in bytes.iter_mut().zip(cells.iter().zip(values)) {
            *byte = self.encode_in(cell, value);
        }
    }

    /// Scaling by a power of two is exact; the cast turns negatives and NaN into cell 0. The last cell holds all that is
    /// brighter, too: it starts with the last code.
    #[inline(always)]
    fn cell(value: f32) -> u32 {
        ((value * CELLS as f32) as u32).min(CELLS as u32 - 1)
    }

    #[inline(always)]
    fn encode_in(&self, cell: u32, value: f32) -> u8 {
        let code = self.code_at_start[cell as usize % CELLS];
        code + u8::from(value >= self.boundary[code as usize + 1])
    }
}

/// The least f32 whose byte is `code`: the first at or above the light of `code - 1/2`.
fn least_light_of(code: usize) -> f32 {
    match code {
        0 => 0.0,
        // Nothing is as bright, infinity included.
        256 => f32::NAN,
        _ => {
            let exact = decode((code as f64 - 0.5) / 255.0);
            let nearest = exact as f32;
            if f64::from(nearest) < exact { nearest.next_up() } else { nearest }
        }
    }
}

/// The linear light of an encoded value in 0..=1.
fn decode(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dashu::rational::RBig;
    use proptest::prelude::*;

    fn rational(value: f32) -> RBig {
        RBig::try_from(value).unwrap()
    }

    /// Whether `light` is at or above the boundary below `code`, decided without rounding: 2.4 is 12/5, so
    /// `light >= y^2.4` is `light^5 >= y^12`.
    fn at_or_above(light: f32, code: u32) -> bool {
        let encoded = RBig::from_parts((2 * code - 1).into(), 510u32.into());
        if code <= 10 {
            return rational(light) * RBig::from_parts(1292.into(), 100u32.into()) >= encoded;
        }
        let y = (encoded + RBig::from_parts(55.into(), 1000u32.into()))
            / RBig::from_parts(1055.into(), 1000u32.into());
        rational(light).pow(5) >= y.pow(12)
    }

    /// The plain version in f64.
    fn oracle(value: f32) -> u8 {
        let x = f64::from(value).clamp(0.0, 1.0);
        let encoded = if x <= 0.0031308 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
        (encoded * 255.0 + 0.5).floor() as u8
    }

    #[test]
    fn boundaries_are_exact() {
        for code in 1..=255 {
            let light = least_light_of(code as usize);
            assert!(at_or_above(light, code), "boundary {code} is too low");
            assert!(!at_or_above(light.next_down(), code), "boundary {code} is too high");
        }
    }

    #[test]
    fn both_sides_of_every_boundary_get_their_code() {
        for code in 1..=255u8 {
            let light = least_light_of(code as usize);
            assert_eq!(srgb8_from_linear(light), code);
            assert_eq!(srgb8_from_linear(light.next_down()), code - 1);
        }
    }

    #[test]
    fn no_cell_holds_two_boundaries() {
        let cells: Vec<usize> = (1..256).map(|code| (least_light_of(code) * CELLS as f32) as usize).collect();
        assert!(cells.windows(2).all(|pair| pair[0] < pair[1]));
    }

    #[test]
    fn bytes_survive_the_round_trip() {
        for byte in 0..=255 {
            assert_eq!(srgb8_from_linear(linear_from_srgb8(byte)), byte);
        }
    }

    #[test]
    fn the_ends_and_the_outside_are_clamped() {
        for (light, byte) in [(0.0, 0), (-0.0, 0), (-1.0, 0), (1.0, 255), (2.0, 255), (f32::MIN_POSITIVE, 0)]
        {
            assert_eq!(srgb8_from_linear(light), byte, "{light}");
        }
        assert_eq!(srgb8_from_linear(f32::INFINITY), 255);
        assert_eq!(srgb8_from_linear(f32::NEG_INFINITY), 0);
        assert_eq!(srgb8_from_linear(f32::NAN), 0);
        assert_eq!(srgb8_from_linear(1.0f32.next_down()), 255);
    }

    proptest! {
        #[test]
        fn any_light_agrees_with_the_plain_version(value in -0.1f32..1.1) {
            prop_assert_eq!(srgb8_from_linear(value), oracle(value));
        }

        #[test]
        fn any_bits_are_encoded_without_panic(bits: u32) {
            srgb8_from_linear(f32::from_bits(bits));
        }
    }
}
