//! Lights as compiled.

use crate::accel::stream::Apex;
use crate::math::{Lane, Vec3};
use crate::shading::{DirectionalLight, Illumination, PointLight, SpotLight};

/// A light without size: it casts hard shadows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// From a point, evenly.
    Point(PointLight),
    /// From infinitely far.
    Directional(DirectionalLight),
    /// From a point into a cone.
    Spot(SpotLight),
}

impl Light {
    /// Kind as printed.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Point(_) => "point",
            Self::Directional(_) => "directional",
            Self::Spot(_) => "spot",
        }
    }

    /// What the light does at points.
    #[inline(always)]
    pub fn illuminate<L: Lane>(&self, point: Vec3<L>) -> Illumination<L> {
        match self {
            Self::Point(light) => light.illuminate(point),
            Self::Directional(light) => light.illuminate(),
            Self::Spot(light) => light.illuminate(point),
        }
    }

    /// What rays along `to_light` have in common: the point that they meet in, or their direction.
    pub fn apex(&self) -> Apex {
        match self {
            Self::Point(light) => Apex::Target(light.position),
            Self::Directional(_) => Apex::Parallel,
            Self::Spot(light) => Apex::Target(light.position()),
        }
    }

    /// Where the light lies on a ray along `to_light`.
    pub fn t_max(&self) -> f64 {
        if matches!(self, Self::Directional(_)) { f64::INFINITY } else { 1.0 }
    }
}
