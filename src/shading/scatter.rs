//! Mirror reflection and refraction.

use super::fresnel::snell;
use crate::math::{Lane, Vec3};

/// The direction of the mirrored ray, of length one. The normal may point to either side.
///
/// **Needs:** `direction` and `normal` of length one. **Accuracy:** length within 3e-7 (`f32`) at any depth: it is
/// normalised, so errors do not grow from bounce to bounce.
#[inline(always)]
pub fn reflect<L: Lane>(direction: Vec3<L>, normal: Vec3<L>) -> Vec3<L> {
    let along = direction.dot(normal);
    (direction - normal * (along + along)).normalize()
}

/// The direction of the refracted ray, of length one, and where there is none (total internal reflection).
///
/// `eta`: index of refraction of the far side over that of the near side, as for
/// [`fresnel_dielectric`](super::fresnel_dielectric). The normal may point to either side: its sign and that of the cosine
/// are settled here, together, so that the way out cannot be bent by the cosine of the way in. Where all is reflected the
/// direction is finite, along the surface, and not to be followed.
///
/// **Needs:** `direction` and `normal` of length one, `eta > 0`.
///
/// **Source:** Snell's law in vector form, as in Heckbert's chapter of Glassner, An Introduction to Ray Tracing, 1989.
#[inline(always)]
pub fn refract<L: Lane>(direction: Vec3<L>, normal: Vec3<L>, eta: L) -> (Vec3<L>, L::Mask) {
    let along = direction.dot(normal);
    let facing = Vec3::select(along.gt(L::zero()), -normal, normal);
    let cos_i = along.abs().min(L::one());
    let (cos_t, total) = snell(cos_i, eta);
    let refracted = direction * (L::one() / eta) + facing * (cos_i / eta - cos_t);
    (refracted.normalize(), total)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use wide::f32x8;

    use super::*;
    use crate::math::Mask;
    use crate::sampling::twin::{assert_lanes, packet};

    const UP: Vec3<f64> = Vec3 { x: 0.0, y: 1.0, z: 0.0 };

    fn downwards(incident_rad: f64) -> Vec3<f64> {
        Vec3::new(incident_rad.sin(), -incident_rad.cos(), 0.0)
    }

    fn distance(a: Vec3<f64>, b: Vec3<f64>) -> f64 {
        (a - b).length()
    }

    /// The report's slip: on the way out the normal was flipped but the cosine kept, which bends the wrong way.
    #[test]
    fn snells_law_holds_both_ways_and_for_either_normal() {
        for degrees in 0..90 {
            let incident_rad = f64::from(degrees).to_radians();
            for (eta, normal) in [(1.5, UP), (1.5, -UP), (1.0 / 1.5, UP), (1.0 / 1.5, -UP)] {
                let (t, total) = refract(downwards(incident_rad), normal, eta);
                let sine = incident_rad.sin() / eta;
                assert_eq!(total, sine >= 1.0, "{degrees} degrees, eta {eta}");
                if !total {
                    assert!((t.x - sine).abs() < 1e-14 && t.y < 0.0 && t.z == 0.0, "{degrees}, {eta}: {t:?}");
                }
                assert!((t.length() - 1.0).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn a_slab_restores_the_direction() {
        for degrees in 0..90 {
            let way = downwards(f64::from(degrees).to_radians());
            let (inside, _) = refract(way, UP, 1.5);
            let (outside, total) = refract(inside, UP, 1.0 / 1.5);
            // The normal of the lower face points down, out of the slab.
            let (same, _) = refract(inside, -UP, 1.0 / 1.5);
            assert!(!total && distance(outside, way) < 1e-14 && distance(same, way) < 1e-14, "{degrees}");
        }
    }

    #[test]
    fn equal_media_do_not_bend() {
        let way = downwards(1.2);
        assert!(distance(refract(way, UP, 1.0).0, way) < 1e-15);
    }

    #[test]
    fn mirrors_turn_the_normal_part_alone() {
        let way = downwards(0.7);
        for normal in [UP, -UP] {
            assert!(distance(reflect(way, normal), Vec3::new(way.x, -way.y, way.z)) < 1e-15);
        }
    }

    fn unit_vector(v: [f32; 3]) -> Vec3<f32> {
        Vec3::new(v[0], v[1], v[2] + 2.5f32.with_sign_of(v[2])).normalize()
    }

    fn any_vectors() -> impl Strategy<Value = [[f32; 3]; 8]> {
        prop::array::uniform8(prop::array::uniform3(-3.0f32..3.0))
    }

    proptest! {
        #[test]
        fn lanes_equal_the_scalar_and_have_length_one(
            d in any_vectors(), n in any_vectors(), etas in prop::array::uniform8(0.3f32..3.0),
        ) {
            let (d, n) = (d.map(unit_vector), n.map(unit_vector));
            let wide = |v: [Vec3<f32>; 8]| {
                Vec3::<f32x8>::new(packet(|i| v[i].x), packet(|i| v[i].y), packet(|i| v[i].z))
            };
            let (t, total) = refract(wide(d), wide(n), f32x8::new(etas));
            let r = reflect(wide(d), wide(n));
            for (axis, lanes) in [t.x, t.y, t.z].into_iter().enumerate() {
                assert_lanes(lanes, |i| refract(d[i], n[i], etas[i]).0.get(0)[axis]);
            }
            for (axis, lanes) in [r.x, r.y, r.z].into_iter().enumerate() {
                assert_lanes(lanes, |i| reflect(d[i], n[i]).get(0)[axis]);
            }
            for i in 0..8 {
                let (t, scalar_total) = refract(d[i], n[i], etas[i]);
                prop_assert_eq!(total.bits() >> i & 1 != 0, scalar_total);
                prop_assert!((t.length() - 1.0).abs() < 3e-7 && (reflect(d[i], n[i]).length() - 1.0).abs() < 3e-7);
            }
        }
    }
}
