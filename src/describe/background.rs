//! What a ray sees that hits nothing, and the ambient light.

use super::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The background: one colour, or a vertical gradient; black when the table is missing.
///
/// The gradient runs from `bottom` to `top` with `t = (1 + direction . up) / 2`, where `up` is the camera's `up`
/// and both vectors have length 1.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Background {
    /// The same colour everywhere.
    #[serde(default)]
    pub color: Option<Rgb>,
    /// Colour straight below (`-up`); needs `top`, excludes `color`.
    #[serde(default)]
    pub bottom: Option<Rgb>,
    /// Colour straight above (`up`); needs `bottom`, excludes `color`.
    #[serde(default)]
    pub top: Option<Rgb>,
    /// What a material's `ka` multiplies. Default: `color`, or the mean of `bottom` and `top`.
    #[serde(default)]
    pub ambient: Option<Rgb>,
}

impl Background {
    /// The background of one colour.
    #[must_use]
    pub fn plain(color: [f64; 3]) -> Background {
        Background { color: Some(Rgb(color)), ..Background::default() }
    }

    /// The vertical gradient between two colours.
    #[must_use]
    pub fn gradient(bottom: [f64; 3], top: [f64; 3]) -> Background {
        Background { bottom: Some(Rgb(bottom)), top: Some(Rgb(top)), ..Background::default() }
    }

    /// Colours straight below and straight above; equal for a background of one colour.
    #[must_use]
    pub fn bottom_and_top(&self) -> [[f64; 3]; 2] {
        let plain = self.color.unwrap_or(Rgb::BLACK);
        [self.bottom.unwrap_or(plain).0, self.top.unwrap_or(plain).0]
    }

    /// Whether the colour changes with height.
    #[must_use]
    pub fn is_gradient(&self) -> bool {
        let [bottom, top] = self.bottom_and_top();
        bottom != top
    }

    /// The ambient colour, with its default resolved.
    #[must_use]
    pub fn ambient(&self) -> [f64; 3] {
        let [bottom, top] = self.bottom_and_top();
        let mean = || std::array::from_fn(|c| 0.5 * (bottom[c] + top[c]));
        self.ambient.map_or_else(mean, |ambient| ambient.0)
    }
}
