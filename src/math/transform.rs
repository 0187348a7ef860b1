//! Affine maps in `f64`, with their inverse, for the scene compiler.

use glam::{DAffine3, DMat3, DVec3};

use super::Aabb;

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
        let inverse = forward.inverse();
        let usable = forward.matrix3.determinant() != 0.0 && inverse.is_finite();
        if usable { Ok(Self { forward, inverse }) } else { Err(TransformError::Singular) }
    }

    /// This map first, then `next`.
    pub fn then(&self, next: &Self) -> Self {
        Self { forward: next.forward * self.forward, inverse: self.inverse * next.inverse }
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

#[cfg(test)]
mod tests {
    use super::*;

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
