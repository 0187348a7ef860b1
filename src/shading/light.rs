//! Lights without size.

use crate::math::{Lane, Vec3};

/// What a light does at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Illumination<L> {
    /// From the point to the light: not of length one, so that the light lies at `t = 1` of a ray along it. For a
    /// directional light of length one, and the light lies at infinity.
    pub to_light: Vec3<L>,
    /// Squared distance to the light; infinite for a directional light.
    pub distance_squared: L,
    /// Irradiance of a surface facing the light, by colour: the cosine is left to the surface.
    pub irradiance: Vec3<L>,
}

/// A light at a point, shining evenly all round.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    /// Where it is.
    pub position: [f32; 3],
    /// Radiant intensity by colour: the irradiance at distance 1.
    pub intensity: [f32; 3],
}

impl PointLight {
    /// Intensity over the square of the distance; nothing at the light itself, which has no direction.
    #[inline(always)]
    pub fn illuminate<L: Lane>(&self, point: Vec3<L>) -> Illumination<L> {
        let to_light = Vec3::splat_f32(self.position) - point;
        let distance_squared = to_light.length_squared();
        let apart = distance_squared.gt(L::zero());
        let falloff = L::select(apart, L::one() / distance_squared, L::zero());
        Illumination { to_light, distance_squared, irradiance: Vec3::splat_f32(self.intensity) * falloff }
    }
}

/// A light from infinitely far away, such as the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalLight {
    /// The way the light travels, of length one.
    pub direction: [f32; 3],
    /// Irradiance of a surface facing the light, by colour.
    pub irradiance: [f32; 3],
}

impl DirectionalLight {
    /// The same everywhere.
    #[inline(always)]
    pub fn illuminate<L: Lane>(&self) -> Illumination<L> {
        Illumination {
            to_light: -Vec3::splat_f32(self.direction),
            distance_squared: L::constant(f64::INFINITY),
            irradiance: Vec3::splat_f32(self.irradiance),
        }
    }
}

/// A light at a point, shining into a cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotLight {
    point: PointLight,
    axis: [f32; 3],
    cos_cone: f32,
    inverse_width: f32,
}

impl SpotLight {
    /// A spot around `axis` (of length one, the way the light travels): full up to `cone_rad - penumbra_rad` from the axis,
    /// nothing from `cone_rad` on, smooth between. Without penumbra the edge is sharp.
    ///
    /// **Needs:** `0 <= penumbra_rad <= cone_rad <= pi`.
    pub fn new(point: PointLight, axis: [f32; 3], cone_rad: f64, penumbra_rad: f64) -> Self {
        let cos_cone = libm::cos(cone_rad) as f32;
        let width = libm::cos(cone_rad - penumbra_rad) as f32 - cos_cone;
        // A finite stand-in for 1/0, so that the edge itself is 0 and not NaN.
        let inverse_width = (1.0 / width).min(f32::MAX);
        Self { point, axis, cos_cone, inverse_width }
    }

    /// Where it is.
    pub fn position(&self) -> [f32; 3] {
        self.point.position
    }

    /// That of a point light, times a smooth step in the cosine to the axis.
    ///
    /// **Source:** the cubic `t^2 (3 - 2t)` between the cosines, as in RenderMan's and pbrt's spotlights.
    #[inline(always)]
    pub fn illuminate<L: Lane>(&self, point: Vec3<L>) -> Illumination<L> {
        let lit = self.point.illuminate(point);
        let cos = -(lit.to_light.dot(Vec3::splat_f32(self.axis)) / lit.distance_squared.sqrt());
        let above = cos - L::constant(f64::from(self.cos_cone));
        let t = (above * L::constant(f64::from(self.inverse_width))).clamp(L::zero(), L::one());
        let share = t * t * (L::constant(3.0) - (t + t));
        Illumination { irradiance: lit.irradiance * share, ..lit }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use wide::f32x8;

    use super::*;
    use crate::sampling::twin::{assert_lanes, packet};

    const LAMP: PointLight = PointLight { position: [0.0, 4.0, 0.0], intensity: [32.0, 16.0, 0.0] };
    const DOWN: [f32; 3] = [0.0, -1.0, 0.0];

    fn red(light: &SpotLight, angle_rad: f64) -> f64 {
        let point = Vec3::new(angle_rad.sin(), 4.0 - angle_rad.cos(), 0.0);
        light.illuminate::<f64>(point).irradiance.x / 32.0
    }

    #[test]
    fn irradiance_falls_with_the_square_of_the_distance() {
        let lit = LAMP.illuminate(Vec3::<f32>::splat([0.0, 0.0, 0.0]));
        assert_eq!(lit.to_light.get(0), [0.0, 4.0, 0.0]);
        assert_eq!((lit.distance_squared, lit.irradiance.get(0)), (16.0, [2.0, 1.0, 0.0]));
        assert_eq!(LAMP.illuminate(Vec3::<f32>::splat([8.0, 4.0, 0.0])).irradiance.x, 0.5);
    }

    /// A sphere of any radius around the light catches 4 pi times the intensity.
    #[test]
    fn a_sphere_around_the_light_catches_all_its_power() {
        for radius in [0.5f64, 1.0, 30.0] {
            let lit = LAMP.illuminate(Vec3::new(0.0, 4.0, radius));
            let power = lit.irradiance.x * 4.0 * std::f64::consts::PI * radius * radius;
            assert!((power - 32.0 * 4.0 * std::f64::consts::PI).abs() < 1e-10);
        }
    }

    #[test]
    fn a_point_at_the_light_is_dark_and_not_nan() {
        let spot = SpotLight::new(LAMP, DOWN, 0.5, 0.1);
        let at = Vec3::splat_f32(LAMP.position);
        assert_eq!(LAMP.illuminate::<f32>(at).irradiance, Vec3::zero());
        assert_eq!(spot.illuminate::<f32>(at).irradiance, Vec3::zero());
    }

    #[test]
    fn directional_light_is_the_same_everywhere() {
        let sun = DirectionalLight { direction: DOWN, irradiance: [1.0, 2.0, 3.0] };
        let lit = sun.illuminate::<f32>();
        assert_eq!((lit.to_light.y, lit.distance_squared), (1.0, f32::INFINITY));
        assert_eq!(lit.irradiance.get(0), [1.0, 2.0, 3.0]);
    }

    #[test]
    fn a_spot_is_full_inside_nothing_outside_and_smooth_between() {
        let spot = SpotLight::new(LAMP, DOWN, 0.5, 0.2);
        for (angle_rad, share) in [(0.0, 1.0), (0.299, 1.0), (0.501, 0.0), (1.5, 0.0), (3.0, 0.0)] {
            assert!((red(&spot, angle_rad) - share).abs() < 1e-6, "{angle_rad}");
        }
        let middle_rad = (0.5 * (0.5f64.cos() + 0.3f64.cos())).acos();
        assert!((red(&spot, middle_rad) - 0.5).abs() < 1e-6);
    }

    #[test]
    fn without_penumbra_the_edge_is_sharp() {
        let spot = SpotLight::new(LAMP, DOWN, 0.5, 0.0);
        assert!((red(&spot, 0.4999) - 1.0).abs() < 1e-12 && red(&spot, 0.5001) == 0.0);
    }

    proptest! {
        #[test]
        fn lanes_equal_the_scalar(points in prop::array::uniform8(prop::array::uniform3(-9.0f32..9.0))) {
            let spot = SpotLight::new(LAMP, DOWN, 1.2, 0.7);
            let wide = Vec3::<f32x8>::new(
                packet(|i| points[i][0]), packet(|i| points[i][1]), packet(|i| points[i][2]),
            );
            let lit = spot.illuminate(wide);
            let scalar = |i: usize| spot.illuminate(Vec3::splat(points[i]));
            assert_lanes(lit.irradiance.x, |i| scalar(i).irradiance.x);
            assert_lanes(lit.distance_squared, |i| scalar(i).distance_squared);
            assert_lanes(lit.to_light.z, |i| scalar(i).to_light.z);
            assert_lanes(LAMP.illuminate(wide).irradiance.y, |i| LAMP.illuminate(Vec3::<f32>::splat(points[i])).irradiance.y);
        }
    }
}
