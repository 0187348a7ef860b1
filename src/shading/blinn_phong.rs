//! Local illumination of a surface by one light.

use super::pow_clamped;
use crate::math::{Lane, Vec3};

/// What to multiply the diffuse and the specular coefficient with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lobes<L> {
    /// Cosine of the light's angle: `N . L`.
    pub diffuse: L,
    /// `(N . H)^shininess`.
    pub specular: L,
}

/// The diffuse and specular factors of Blinn's model: `max(0, N . L)` and `max(0, N . H)^shininess`, with `H` half-way
/// between the light and the viewer. Both are zero where the light is behind the surface.
///
/// `wo` points back along the ray being shaded, be it from the camera or from another surface: for a secondary ray the
/// viewer is where that ray came from. `exponent`, `bits` and `FRACTION` are those of [`pow_clamped`].
///
/// **Needs:** `shading_normal`, `to_light` and `wo` of length one, the normal on the side of `wo`.
///
/// **Source:** Blinn, Models of Light Reflection for Computer Synthesized Pictures, 1977; without a factor that conserves
/// energy, as is usual with this model.
#[inline(always)]
pub fn blinn_phong<L: Lane, const FRACTION: bool>(
    shading_normal: Vec3<L>,
    to_light: Vec3<L>,
    wo: Vec3<L>,
    exponent: L::Bits,
    bits: u32,
) -> Lobes<L> {
    let cos = shading_normal.dot(to_light);
    let lit = cos.gt(L::zero());
    let half = to_light + wo;
    // Light straight from behind the viewed point has no half vector: 0/0, which the power takes as 0.
    let cos_half = shading_normal.dot(half) / half.length();
    let specular = pow_clamped::<L, FRACTION>(cos_half, exponent, bits);
    Lobes { diffuse: L::select(lit, cos, L::zero()), specular: L::select(lit, specular, L::zero()) }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use wide::{f32x8, u32x8};

    use super::*;
    use crate::sampling::twin::{assert_lanes, packet};
    use crate::shading::{Shininess, reflect};

    const UP: Vec3<f64> = Vec3 { x: 0.0, y: 0.0, z: 1.0 };

    fn tilted(angle_rad: f64) -> Vec3<f64> {
        Vec3::new(angle_rad.sin(), 0.0, angle_rad.cos())
    }

    fn lobes(normal: Vec3<f64>, to_light: Vec3<f64>, wo: Vec3<f64>, exponent: f32) -> Lobes<f64> {
        let shininess = Shininess::new(exponent);
        blinn_phong::<f64, true>(normal, to_light, wo, shininess.word(), shininess.bits())
    }

    #[test]
    fn factors_are_the_powers_of_cosines() {
        for (light_rad, view_rad) in [(0.0, 0.0), (0.3, 0.9), (-1.2, 0.4), (1.5, 1.5)] {
            let l = lobes(UP, tilted(light_rad), tilted(view_rad), 100.0);
            let half_rad: f64 = 0.5 * (light_rad + view_rad);
            assert!((l.diffuse - light_rad.cos()).abs() < 1e-15);
            assert!((l.specular - half_rad.cos().powi(100)).abs() < 1e-13);
        }
    }

    #[test]
    fn light_from_behind_counts_nothing() {
        for light_rad in [std::f64::consts::FRAC_PI_2 + 1e-6, 2.0, 3.1] {
            assert_eq!(lobes(UP, tilted(light_rad), tilted(0.1), 0.0), Lobes { diffuse: 0.0, specular: 0.0 });
        }
        assert_eq!(lobes(UP, -UP, UP, 5.0), Lobes { diffuse: 0.0, specular: 0.0 }, "no half vector");
    }

    /// The report took the direction to the camera for secondary rays too: the highlight must follow the ray shaded.
    #[test]
    fn the_highlight_of_a_reflected_ray_is_seen_along_it() {
        let camera_ray = tilted(2.5);
        let secondary = reflect(camera_ray, UP);
        let second_normal = Vec3::new(-1.0, 0.0, 0.0);
        let to_light = reflect(secondary, second_normal);
        let seen = lobes(second_normal, to_light, -secondary, 100.0);
        let slip = lobes(second_normal, to_light, -camera_ray, 100.0);
        assert!((seen.specular - 1.0).abs() < 1e-12 && slip.specular < 0.01, "{seen:?} {slip:?}");
    }

    fn unit_vector(v: [f32; 3]) -> Vec3<f32> {
        Vec3::new(v[0], v[1], v[2]).normalize()
    }

    fn any_vectors() -> impl Strategy<Value = [Vec3<f32>; 8]> {
        prop::array::uniform8(prop::array::uniform3(-1.0f32..1.0).prop_map(unit_vector))
    }

    proptest! {
        #[test]
        fn lanes_equal_the_scalar(
            n in any_vectors(), l in any_vectors(), o in any_vectors(),
            exponents in prop::array::uniform8(0.0f32..300.0),
        ) {
            let own = exponents.map(Shininess::new);
            let wide = |v: [Vec3<f32>; 8]| {
                Vec3::<f32x8>::new(packet(|i| v[i].x), packet(|i| v[i].y), packet(|i| v[i].z))
            };
            let bits = own.iter().map(|s| s.bits()).max().unwrap();
            let words = u32x8::new(own.map(Shininess::word));
            let packet = blinn_phong::<f32x8, true>(wide(n), wide(l), wide(o), words, bits);
            let scalar = |i: usize| blinn_phong::<f32, true>(n[i], l[i], o[i], own[i].word(), own[i].bits());
            assert_lanes(packet.diffuse, |i| scalar(i).diffuse);
            assert_lanes(packet.specular, |i| scalar(i).specular);
        }
    }
}
