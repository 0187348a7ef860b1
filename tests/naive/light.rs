//! Direct light: ambient, Blinn-Phong, hard shadows.

use octray::describe::{Material, Rgb};

use super::World;
use super::vector::{V, add, dot, mul, normalize, scale, sub};

/// What arrives from one light at a point.
struct Arriving {
    /// Towards the light, of length one.
    to_light: V,
    distance: f64,
    irradiance: V,
}

impl World<'_> {
    pub(super) fn direct(&self, point: V, normal: V, direction: V, material: &Material) -> V {
        let glow = add(mul(material.ka(), self.scene.background.ambient()), material.emission());
        let lit = self.arriving(point).into_iter().map(|a| self.lit(point, normal, direction, material, &a));
        lit.fold(glow, add)
    }

    fn lit(&self, point: V, normal: V, direction: V, material: &Material, a: &Arriving) -> V {
        let cos = dot(normal, a.to_light);
        if cos <= 0.0 || self.is_blocked(point, a) {
            return V::default();
        }
        let half = normalize(sub(a.to_light, direction));
        let highlight = dot(half, normal).max(0.0).powf(material.shininess);
        mul(add(scale(material.kd(), cos), scale(material.ks(), highlight)), a.irradiance)
    }

    fn is_blocked(&self, point: V, a: &Arriving) -> bool {
        self.shapes.iter().any(|s| s.intersect(point, a.to_light).is_some_and(|hit| hit.t < a.distance))
    }

    fn arriving(&self, point: V) -> Vec<Arriving> {
        let lights = &self.scene.light;
        let from = |position: V, color: Rgb, intensity: f64| {
            let way = sub(position, point);
            let distance = dot(way, way).sqrt();
            let irradiance = scale(color.0, intensity / (distance * distance));
            Arriving { to_light: scale(way, 1.0 / distance), distance, irradiance }
        };
        let mut all: Vec<_> = lights.point.iter().map(|l| from(l.position, l.color, l.intensity)).collect();
        all.extend(lights.directional.iter().map(|l| Arriving {
            to_light: scale(normalize(l.direction), -1.0),
            distance: f64::INFINITY,
            irradiance: scale(l.color.0, l.intensity),
        }));
        all.extend(lights.spot.iter().map(|l| {
            let plain = from(l.position, l.color, l.intensity);
            let axis = normalize(sub(l.look_at, l.position));
            let share = inside_cone(-dot(axis, plain.to_light), l.cone_deg, l.penumbra_deg);
            Arriving { irradiance: scale(plain.irradiance, share), ..plain }
        }));
        all
    }
}

/// 1 inside the penumbra, 0 outside the cone, the smooth cubic of the cosine between.
fn inside_cone(cos: f64, cone_deg: f64, penumbra_deg: f64) -> f64 {
    let (outer, inner) = (cone_deg.to_radians().cos(), (cone_deg - penumbra_deg).to_radians().cos());
    if cos >= inner {
        1.0
    } else if cos <= outer {
        0.0
    } else {
        let t = (cos - outer) / (inner - outer);
        t * t * (3.0 - 2.0 * t)
    }
}
