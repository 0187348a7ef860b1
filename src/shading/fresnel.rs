//! How much of the light a smooth dielectric reflects.

use crate::math::Lane;

/// The reflected share of unpolarised light, in `[0, 1]`; the rest is refracted.
///
/// `cos_i`: cosine between the incoming ray and the normal, of either sign. `eta`: index of refraction of the far side
/// over that of the near side, so 1.5 into glass from air and 1/1.5 on the way out. Total internal reflection gives 1.
///
/// **Needs:** `|cos_i| <= 1` (confined), `eta > 0`.
///
/// **Accuracy:** within 1e-6 of the closed form (`f32`), away from the critical angle, where the slope is infinite.
///
/// **Source:** Fresnel's equations, as in Born and Wolf, Principles of Optics, 1.5.2, for non-absorbing media; the cosine
/// on the far side from Snell's law.
#[inline(always)]
pub fn fresnel_dielectric<L: Lane>(cos_i: L, eta: L) -> L {
    let cos_i = cos_i.abs().min(L::one());
    let (cos_t, total) = snell(cos_i, eta);
    let parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    let share = (parallel * parallel + perpendicular * perpendicular) * L::constant(0.5);
    L::select(total, L::one(), share)
}

/// The cosine on the far side, and where there is none because all light is reflected (the critical angle and equal media
/// at cosine zero included, where the share is 1 or 0/0).
///
/// `eta^2 - 1 + cos^2` over `eta^2` rather than `1 - sin^2 / eta^2`: in equal media the ray goes on unbent to the bit, also at
/// grazing incidence, where the sine has lost the cosine.
#[inline(always)]
pub(super) fn snell<L: Lane>(cos_i: L, eta: L) -> (L, L::Mask) {
    let squared = (eta - L::one()) * (eta + L::one()) + cos_i * cos_i;
    (squared.max(L::zero()).sqrt() / eta, squared.le(L::zero()))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use wide::f32x8;

    use super::*;
    use crate::sampling::twin::assert_lanes;

    /// Another formula: by angles (Fresnel's sine and tangent laws).
    fn by_angles(incident_rad: f64, eta: f64) -> f64 {
        let refracted_rad = (incident_rad.sin() / eta).asin();
        let (minus, plus) = (incident_rad - refracted_rad, incident_rad + refracted_rad);
        0.5 * ((minus.sin() / plus.sin()).powi(2) + (minus.tan() / plus.tan()).powi(2))
    }

    #[test]
    fn normal_incidence_is_the_closed_form() {
        for n in [1.0f64, 1.000_293, 1.333, 1.5, 2.417, 1.0 / 1.5] {
            let expected = ((n - 1.0) / (n + 1.0)).powi(2);
            assert!((fresnel_dielectric(1.0, n) - expected).abs() < 1e-15, "{n}");
            assert!((f64::from(fresnel_dielectric(1.0, n as f32)) - expected).abs() < 1e-7, "{n} in f32");
        }
    }

    #[test]
    fn at_brewsters_angle_half_of_the_perpendicular_part_is_left() {
        for n in [1.333f64, 1.5, 2.417, 1.0 / 1.5] {
            let brewster_rad = n.atan();
            let perpendicular = ((1.0 - n * n) / (1.0 + n * n)).powi(2);
            assert!((fresnel_dielectric(brewster_rad.cos(), n) - 0.5 * perpendicular).abs() < 1e-14, "{n}");
        }
    }

    #[test]
    fn beyond_the_critical_angle_all_is_reflected() {
        let (eta, critical_rad) = (1.0 / 1.5f64, (1.0 / 1.5f64).asin());
        assert!(fresnel_dielectric((critical_rad - 1e-3).cos(), eta) < 0.9);
        for beyond in [1e-9, 1e-3, 0.3] {
            assert_eq!(fresnel_dielectric((critical_rad + beyond).cos(), eta), 1.0);
        }
    }

    #[test]
    fn grazing_light_is_all_reflected_and_nothing_is_nan() {
        for eta in [0.5f32, 1.0, 1.5, 1e-3, 1e3] {
            assert_eq!(fresnel_dielectric(0.0, eta), 1.0);
            assert_eq!(fresnel_dielectric(-0.0, eta), 1.0);
            assert!((0.0..=1.0).contains(&fresnel_dielectric(1.0 + 1e-6, eta)));
        }
        for cos in [1.0, 0.3, 1e-5, 1e-15] {
            assert!(fresnel_dielectric::<f32>(cos, 1.0) < 1e-12, "equal media have no surface: {cos}");
        }
    }

    proptest! {
        #[test]
        fn agrees_with_the_laws_of_angles(incident_rad in 1e-3f64..1.57, eta in 1.01f64..3.0) {
            let share = fresnel_dielectric(incident_rad.cos(), eta);
            prop_assert!((share - by_angles(incident_rad, eta)).abs() < 1e-9);
            let (c, e) = (incident_rad.cos() as f32, eta as f32);
            let rounded = f64::from(fresnel_dielectric(c, e));
            prop_assert!((rounded - fresnel_dielectric(f64::from(c), f64::from(e))).abs() < 1e-6);
        }

        /// Light takes the same way back (Stokes), so the share is that of the refracted angle from the other side.
        #[test]
        fn the_way_back_reflects_as_much(cos_i in 0.01f64..1.0, eta in 1.01f64..3.0) {
            let cos_t = (1.0 - (1.0 - cos_i * cos_i) / (eta * eta)).sqrt();
            let (there, back) = (fresnel_dielectric(cos_i, eta), fresnel_dielectric(cos_t, 1.0 / eta));
            prop_assert!((there - back).abs() < 1e-9);
        }

        #[test]
        fn lanes_equal_the_scalar(cos in any::<[i8; 8]>(), etas in prop::array::uniform8(0.3f32..3.0)) {
            let cos = cos.map(|c| f32::from(c) / 127.0);
            let wide = fresnel_dielectric(f32x8::new(cos), f32x8::new(etas));
            assert_lanes(wide, |i| fresnel_dielectric(cos[i], etas[i]));
            for i in 0..8 {
                prop_assert!((0.0..=1.0).contains(&wide.get(i)), "energy: {}", wide.get(i));
            }
        }
    }
}
