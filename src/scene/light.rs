//! Lights as compiled.

/// A light that casts hard shadows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// From a point, evenly, falling off with the square of the distance.
    Point {
        /// Where it stands.
        position: [f64; 3],
        /// Colour times intensity: irradiance at distance 1.
        power: [f64; 3],
    },
    /// From infinitely far.
    Directional {
        /// Towards the light, of length one.
        to_light: [f64; 3],
        /// Irradiance on a surface that faces it.
        power: [f64; 3],
    },
    /// From a point into a cone.
    Spot {
        /// Where it stands.
        position: [f64; 3],
        /// Where it points, of length one.
        axis: [f64; 3],
        /// Cosine of the angle from which on it is dark.
        cos_outer: f64,
        /// Cosine of the angle up to which it is as bright as a point light.
        cos_inner: f64,
        /// Colour times intensity: irradiance at distance 1 inside the cone.
        power: [f64; 3],
    },
}

impl Light {
    /// Kind as printed.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Point { .. } => "point",
            Self::Directional { .. } => "directional",
            Self::Spot { .. } => "spot",
        }
    }
}
