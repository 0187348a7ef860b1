//! Lights, one table a kind.

use super::{Rgb, exact};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// All lights of a scene.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Lights {
    /// Lights that shine from a point to all sides.
    pub point: Vec<PointLight>,
    /// Lights from very far away.
    pub directional: Vec<DirectionalLight>,
    /// Lights that shine from a point into a cone.
    pub spot: Vec<SpotLight>,
}

/// A point light: irradiance at distance r is `color x intensity / r^2`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointLight {
    /// Where it stands.
    #[serde(deserialize_with = "exact::read")]
    pub position: [f64; 3],
    /// Its colour. Default white.
    #[serde(default = "white")]
    pub color: Rgb,
    /// Irradiance at distance 1.
    pub intensity: f64,
}

/// A directional light: irradiance is `color x intensity` everywhere.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DirectionalLight {
    /// The way the light travels (from the sun to the ground); any length.
    #[serde(deserialize_with = "exact::read")]
    pub direction: [f64; 3],
    /// Its colour. Default white.
    #[serde(default = "white")]
    pub color: Rgb,
    /// Irradiance on a surface that faces it.
    pub intensity: f64,
}

/// A spot light: a point light whose light ends at the edge of a cone.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpotLight {
    /// Where it stands.
    #[serde(deserialize_with = "exact::read")]
    pub position: [f64; 3],
    /// A point on the axis of the cone.
    #[serde(deserialize_with = "exact::read")]
    pub look_at: [f64; 3],
    /// Half angle of the cone, where the light ends, in degrees: above 0, at most 180.
    pub cone_deg: f64,
    /// Width of the smooth edge inside the cone, in degrees, at most `cone_deg`. Default 0: a sharp edge.
    #[serde(default)]
    pub penumbra_deg: f64,
    /// Its colour. Default white.
    #[serde(default = "white")]
    pub color: Rgb,
    /// Irradiance at distance 1 on the axis.
    pub intensity: f64,
}

fn white() -> Rgb {
    Rgb::WHITE
}
