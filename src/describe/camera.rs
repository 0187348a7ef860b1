//! Where the picture is taken from.

use super::{Transform, exact};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The camera.
///
/// It looks along `look_at - position`; the top of the picture points to `up` as far as that is at right angles
/// to the view. An optional `transform` then moves the whole camera.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Camera {
    /// Where the camera stands, in world units.
    #[serde(deserialize_with = "exact::read")]
    pub position: [f64; 3],
    /// The point in the centre of the picture.
    #[serde(deserialize_with = "exact::read")]
    pub look_at: [f64; 3],
    /// The direction towards the top of the picture; any length. Default `[0, 1, 0]`.
    #[serde(default = "default_up", deserialize_with = "exact::read")]
    pub up: [f64; 3],
    /// `perspective` (default) or `orthographic`.
    #[serde(default)]
    pub kind: CameraKind,
    /// Vertical field of view in degrees, strictly between 0 and 180. Perspective only. Default 45.
    #[serde(default = "default_fov_deg")]
    pub fov_deg: f64,
    /// Full height of the picture window in world units. Orthographic only, required there.
    #[serde(default)]
    pub height: Option<f64>,
    /// Radius of the lens in world units: 0 (default) is a pinhole with everything in focus.
    #[serde(default)]
    pub aperture_radius: f64,
    /// Distance along the view axis of the plane in focus. Default: the distance to `look_at`.
    #[serde(default)]
    pub focus_distance: Option<f64>,
    /// Distance along the view axis in front of which nothing is seen. Default 0.
    #[serde(default)]
    pub near: f64,
    /// `right` (default): the right of the picture is forward x up. `left`: it is up x forward.
    #[serde(default)]
    pub handedness: Handedness,
    /// Moves the camera after it was placed by the keys above.
    #[serde(default, skip_serializing_if = "Transform::is_empty")]
    pub transform: Transform,
}

/// How camera rays spread.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CameraKind {
    /// From one point (or one lens): far things look small.
    #[default]
    Perspective,
    /// All parallel: size does not depend on distance.
    Orthographic,
}

/// Which way is right in the picture.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Handedness {
    /// Right = forward x up (x right, y up, z towards the viewer).
    #[default]
    Right,
    /// Right = up x forward (x right, y up, z away from the viewer).
    Left,
}

impl Camera {
    /// A pinhole perspective camera with everything else at its default.
    #[must_use]
    pub fn perspective(position: [f64; 3], look_at: [f64; 3], fov_deg: f64) -> Camera {
        Camera {
            position,
            look_at,
            up: default_up(),
            kind: CameraKind::Perspective,
            fov_deg,
            height: None,
            aperture_radius: 0.0,
            focus_distance: None,
            near: 0.0,
            handedness: Handedness::Right,
            transform: Transform::default(),
        }
    }

    /// Distance of the plane in focus, with its default resolved.
    #[must_use]
    pub fn focus_distance(&self) -> f64 {
        let axis: [f64; 3] = std::array::from_fn(|i| self.look_at[i] - self.position[i]);
        self.focus_distance.unwrap_or_else(|| axis.iter().map(|a| a * a).sum::<f64>().sqrt())
    }
}

fn default_up() -> [f64; 3] {
    [0.0, 1.0, 0.0]
}

fn default_fov_deg() -> f64 {
    45.0
}
