//! Affine maps in `f64`, with their inverse, for the scene compiler.

use glam::{DAffine3, DMat3, DVec3};

use super::{Aabb, pairs, ring_cross, ring_dot};

/// An affine map and its inverse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    forward: DAffine3,
    inverse: DAffine3,
}

/// Why a transform cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TransformError {
    /// Flattens space: there is no way back.
    #[error("the transform is singular: it flattens space, so it has no inverse")]
    Singular,
    /// A NaN or infinite entry.
    #[error("the transform holds a number that is not finite")]
    NotFinite,
}

impl Transform {
    /// The map that changes nothing.
    pub const IDENTITY: Self = Self { forward: DAffine3::IDENTITY, inverse: DAffine3::IDENTITY };

    /// A map from the three rows of its matrix, translation in the fourth column.
    ///
    /// **Errors:** [`TransformError`] if an entry is not finite or the map is singular.
    pub fn from_rows(rows: [[f64; 4]; 3]) -> Result<Self, TransformError> {
        let column = |k: usize| DVec3::new(rows[0][k], rows[1][k], rows[2][k]);
        let matrix = DMat3::from_cols(column(0), column(1), column(2));
        Self::new(DAffine3 { matrix3: matrix, translation: column(3) })
    }

    fn new(forward: DAffine3) -> Result<Self, TransformError> {
        if !forward.is_finite() {
            return Err(TransformError::NotFinite);
        }
        let inverse = inverse_of(&forward);
        let usable = forward.matrix3.determinant() != 0.0 && inverse.is_finite();
        if usable { Ok(Self { forward, inverse }) } else { Err(TransformError::Singular) }
    }

    /// This map first, then `next`.
    pub fn then(&self, next: &Self) -> Self {
        let forward = next.forward * self.forward;
        // That of the product as it was rounded; where a map is so small or large that it has none, the product of both.
        Self::new(forward).unwrap_or(Self { forward, inverse: self.inverse * next.inverse })
    }

    /// The way back.
    pub fn inverted(&self) -> Self {
        Self { forward: self.inverse, inverse: self.forward }
    }

    /// The image of a point.
    pub fn point(&self, p: [f64; 3]) -> [f64; 3] {
        self.forward.transform_point3(p.into()).into()
    }

    /// The image of a direction.
    pub fn direction(&self, d: [f64; 3]) -> [f64; 3] {
        self.forward.transform_vector3(d.into()).into()
    }

    /// A surface normal carried along, of length one: by the transposed inverse, so that it stays perpendicular under
    /// non-uniform scale and keeps its side under mirroring.
    pub fn normal(&self, n: [f64; 3]) -> [f64; 3] {
        (self.inverse.matrix3.transpose() * DVec3::from(n)).normalize_or_zero().into()
    }

    /// Signed volume ratio; negative for a mirroring map.
    pub fn determinant(&self) -> f64 {
        self.forward.matrix3.determinant()
    }

    /// The factor of a map that scales all directions alike, within rounding; `None` for any other map.
    pub fn uniform_scale(&self) -> Option<f64> {
        let m = self.forward.matrix3;
        let gram = m.transpose() * m;
        let s2 = (gram.x_axis.x + gram.y_axis.y + gram.z_axis.z) / 3.0;
        let off = (gram - DMat3::from_diagonal(DVec3::splat(s2))).to_cols_array();
        let alike = off.iter().all(|e| e.abs() <= 1e-12 * s2);
        alike.then(|| s2.sqrt())
    }

    /// The three rows of the matrix, translation in the fourth column.
    pub fn rows(&self) -> [[f64; 4]; 3] {
        let (m, t) = (self.forward.matrix3, self.forward.translation);
        std::array::from_fn(|r| [m.x_axis[r], m.y_axis[r], m.z_axis[r], t[r]])
    }

    /// The three rows of the inverse.
    pub fn inverse_rows(&self) -> [[f64; 4]; 3] {
        self.inverted().rows()
    }

    /// A box around the image of a box.
    pub fn bounds(&self, b: &Aabb) -> Aabb {
        if b.is_empty() {
            return *b;
        }
        Aabb::around(b.corners().map(|c| self.point(c.map(f64::from))))
    }
}

/// The inverse, by Cramer's rule in pairs: every entry is within three roundoffs of itself. In `f64` alone the translation,
/// a sum that may cancel, would be off by more than the bounds on points in instances allow for.
fn inverse_of(forward: &DAffine3) -> DAffine3 {
    let m = &forward.matrix3;
    let [a, b, c, t] =
        [m.x_axis, m.y_axis, m.z_axis, forward.translation].map(|column| pairs(column.to_array()));
    let rows = [ring_cross(&b, &c), ring_cross(&c, &a), ring_cross(&a, &b)];
    let determinant = ring_dot(&a, &rows[0])[0];
    // Zeros of either sign become the positive one.
    let translation = rows.map(|row| 0.0 - ring_dot(&row, &t)[0] / determinant);
    let [x, y, z] = rows.map(|row| DVec3::from(row.map(|entry| entry[0] / determinant + 0.0)));
    DAffine3 { matrix3: DMat3::from_cols(x, y, z).transpose(), translation: translation.into() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::intersect::testing::dice::Dice;
    use crate::math::determinant;

    fn scale([x, y, z]: [f64; 3]) -> Result<Transform, TransformError> {
        Transform::from_rows([[x, 0.0, 0.0, 0.0], [0.0, y, 0.0, 0.0], [0.0, 0.0, z, 0.0]])
    }

    #[test]
    fn normals_stay_perpendicular_under_non_uniform_scale() {
        let t = scale([3.0, 1.0, 0.5]).unwrap();
        let (tangent, normal) = (t.direction([1.0, 1.0, 0.0]), t.normal([1.0, -1.0, 0.0]));
        let dot: f64 = (0..3).map(|k| tangent[k] * normal[k]).sum();
        assert!(dot.abs() < 1e-15);
    }

    /// Slip: the translation of the way back, computed in `f64`, lost the digits that rays which leave a pressed instance need
    /// to not hit it again.
    #[test]
    fn the_way_back_of_a_pressed_map_is_known_to_some_roundoffs() {
        let mut dice = Dice(91);
        for _ in 0..2_000 {
            let (along, press) = (dice.heading(), dice.magnitude(-4.0, 0.0));
            let columns: [[f64; 3]; 3] = std::array::from_fn(|_| {
                let (aside, by) = (dice.heading(), dice.unit());
                std::array::from_fn(|k| along[k] * by + aside[k] * press)
            });
            let t = dice.point().map(|x| 1e4 * x);
            let rows = std::array::from_fn(|r| [columns[0][r], columns[1][r], columns[2][r], t[r]]);
            let map = Transform::from_rows(rows).unwrap();
            let (whole, back) = (columns.map(pairs), map.inverse_rows());
            for (i, row) in back.iter().enumerate() {
                let mut replaced = whole;
                replaced[i] = pairs(t);
                let det = |m: &[[[f64; 2]; 3]; 3]| determinant(&m[0], &m[1], &m[2]);
                let want = -det(&replaced) / det(&whole);
                let off = (row[3] - want).abs() / (want.abs() * f64::EPSILON);
                assert!(off <= 4.0, "the way back is {off} ulps off: {} for {want}, of {rows:?}", row[3]);
            }
        }
    }

    #[test]
    fn flattening_and_nan_are_refused() {
        assert_eq!(scale([1.0, 0.0, 1.0]), Err(TransformError::Singular));
        assert_eq!(scale([1.0, f64::NAN, 1.0]), Err(TransformError::NotFinite));
    }

    #[test]
    fn maps_compose_first_to_last_and_have_a_way_back() {
        let shift =
            Transform::from_rows([[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]).unwrap();
        let quarter =
            Transform::from_rows([[0.0, -1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]])
                .unwrap();
        let both = shift.then(&quarter);
        assert_eq!(both.point([0.0; 3]), [0.0, 1.0, 0.0]);
        assert_eq!(both.inverted().point([0.0, 1.0, 0.0]), [0.0; 3]);
    }

    #[test]
    fn only_similar_maps_have_a_uniform_scale() {
        assert_eq!(scale([2.0, 2.0, -2.0]).unwrap().uniform_scale(), Some(2.0));
        assert_eq!(scale([2.0, 2.0, 2.1]).unwrap().uniform_scale(), None);
    }
}
