//! Things with a formula: sphere, cylinder, triangle, quad, plane.
//!
//! `material` names a `[[material]]`; without it the object is a plain grey diffuse one.

use super::{Transform, exact};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A sphere; with a non-uniform `transform` an ellipsoid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    /// Its centre.
    #[serde(deserialize_with = "exact::read")]
    pub center: [f64; 3],
    /// Its radius, above 0.
    pub radius: f64,
    /// Name of its material.
    #[serde(default)]
    pub material: Option<String>,
    /// Moves it after it was placed by the keys above.
    #[serde(default, skip_serializing_if = "Transform::is_empty")]
    pub transform: Transform,
}

/// A cylinder: `from`, `to` and `radius` for any axis, or `center`, `half_height` and `radius` for one along y.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cylinder {
    /// Centre of one end.
    #[serde(default, deserialize_with = "exact::read")]
    pub from: Option<[f64; 3]>,
    /// Centre of the other end.
    #[serde(default, deserialize_with = "exact::read")]
    pub to: Option<[f64; 3]>,
    /// Centre of a cylinder along y.
    #[serde(default, deserialize_with = "exact::read")]
    pub center: Option<[f64; 3]>,
    /// Half the height of a cylinder along y, above 0.
    #[serde(default)]
    pub half_height: Option<f64>,
    /// Its radius, above 0.
    pub radius: f64,
    /// Whether the ends are closed. Default true.
    #[serde(default = "yes", skip_serializing_if = "is_true")]
    pub caps: bool,
    /// Name of its material.
    #[serde(default)]
    pub material: Option<String>,
    /// Moves it after it was placed by the keys above.
    #[serde(default, skip_serializing_if = "Transform::is_empty")]
    pub transform: Transform,
}

/// One triangle. One without area is left out, and counted, when the scene is compiled.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Triangle {
    /// Its corners; counter-clockwise seen from the front.
    #[serde(deserialize_with = "exact::read")]
    pub vertices: [[f64; 3]; 3],
    /// Name of its material.
    #[serde(default)]
    pub material: Option<String>,
    /// Moves it after it was placed by the keys above.
    #[serde(default, skip_serializing_if = "Transform::is_empty")]
    pub transform: Transform,
}

/// A parallelogram: `origin`, `origin + edge_u`, `origin + edge_u + edge_v`, `origin + edge_v`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Quad {
    /// One corner.
    #[serde(deserialize_with = "exact::read")]
    pub origin: [f64; 3],
    /// From that corner to the next.
    #[serde(deserialize_with = "exact::read")]
    pub edge_u: [f64; 3],
    /// From that corner to the last.
    #[serde(deserialize_with = "exact::read")]
    pub edge_v: [f64; 3],
    /// Name of its material.
    #[serde(default)]
    pub material: Option<String>,
    /// Moves it after it was placed by the keys above.
    #[serde(default, skip_serializing_if = "Transform::is_empty")]
    pub transform: Transform,
}

/// A plane without end. Not inside groups.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Plane {
    /// Any point on it.
    #[serde(deserialize_with = "exact::read")]
    pub point: [f64; 3],
    /// The direction it faces; any length.
    #[serde(deserialize_with = "exact::read")]
    pub normal: [f64; 3],
    /// Name of its material.
    #[serde(default)]
    pub material: Option<String>,
}

impl Cylinder {
    /// Centres of both ends, whichever way they were written. Incomplete forms, which a check refuses, give zeros.
    #[must_use]
    pub fn ends(&self) -> [[f64; 3]; 2] {
        if let (Some(from), Some(to)) = (self.from, self.to) {
            return [from, to];
        }
        let [x, y, z] = self.center.unwrap_or_default();
        let half = self.half_height.unwrap_or_default();
        [[x, y - half, z], [x, y + half, z]]
    }
}

impl Quad {
    /// Its corners in order; the triangles are `0 1 2` and `0 2 3`.
    #[must_use]
    pub fn corners(&self) -> [[f64; 3]; 4] {
        let add = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|i| a[i] + b[i]);
        let next = add(self.origin, self.edge_u);
        [self.origin, next, add(next, self.edge_v), add(self.origin, self.edge_v)]
    }
}

pub(super) fn yes() -> bool {
    true
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
pub(super) fn is_true(value: &bool) -> bool {
    *value
}
