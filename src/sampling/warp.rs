//! The unit square to the disk, to the hemisphere, and to the frame of a surface.

use std::f64::consts::{FRAC_1_PI, FRAC_PI_4};

use crate::math::{Lane, Vec3};

/// Sine and cosine of an angle in `[-pi/4, pi/4]`.
///
/// Polynomials in the square of the angle, of `+` and `*` alone, so that all lanes and platforms agree.
///
/// **Accuracy:** within 1.3e-7 (`f32`), 3e-9 (`f64`). **Source:** coefficients of Moshier's Cephes library, `sinf.c`.
#[inline(always)]
fn sin_cos_octant<L: Lane>(angle: L) -> (L, L) {
    let z = angle * angle;
    let c = |value: f64| L::constant(value);
    let sin = ((c(-1.951_529_589_1e-4) * z + c(8.332_160_873_6e-3)) * z - c(1.666_665_461_1e-1)) * z * angle
        + angle;
    let cos =
        (c(2.443_315_711_809_948e-5) * z - c(1.388_731_625_493_765e-3)) * z + c(4.166_664_568_298_827e-2);
    (sin, cos * z * z - c(0.5) * z + L::one())
}

/// A point of the unit disk, uniform if `(u, v)` is uniform in the unit square; neighbours stay neighbours.
///
/// **Source:** Shirley and Chiu, A Low Distortion Map Between Disk and Square, 1997; the branches are selects.
#[inline(always)]
pub fn concentric_disk<L: Lane>(u: L, v: L) -> (L, L) {
    let (a, b) = (u + u - L::one(), v + v - L::one());
    let steep = b.abs().gt(a.abs());
    let (radius, other) = (L::select(steep, b, a), L::select(steep, a, b));
    // At the very centre any angle will do; dividing by one gives angle zero.
    let divisor = L::select(radius.eq(L::zero()), L::one(), radius);
    let (sin, cos) = sin_cos_octant(L::constant(FRAC_PI_4) * (other / divisor));
    (radius * L::select(steep, sin, cos), radius * L::select(steep, cos, sin))
}

/// A direction around +z with density `cos / pi`: length one, `z >= 0`.
///
/// **Source:** Malley's method: a uniform point of the disk, lifted to the sphere.
#[inline(always)]
pub fn cosine_hemisphere<L: Lane>(u: L, v: L) -> Vec3<L> {
    let (x, y) = concentric_disk(u, v);
    Vec3::new(x, y, (L::one() - x * x - y * y).max(L::zero()).sqrt())
}

/// Density of [`cosine_hemisphere`] per solid angle at a direction of the given cosine; zero below the surface.
#[inline(always)]
pub fn cosine_hemisphere_pdf<L: Lane>(cos: L) -> L {
    cos.max(L::zero()) * L::constant(FRAC_1_PI)
}

/// Tangent and bitangent: with the unit `normal` last, a right-handed orthonormal frame.
///
/// **Accuracy:** lengths and angles within 1e-6 (`f32`), also for normals close to -z.
///
/// **Source:** Duff et al., Building an Orthonormal Basis, Revisited, JCGT 6(1), 2017.
#[inline(always)]
pub fn frame<L: Lane>(normal: Vec3<L>) -> (Vec3<L>, Vec3<L>) {
    let sign = L::one().with_sign_of(normal.z);
    let a = -(L::one() / (sign + normal.z));
    let b = normal.x * normal.y * a;
    let tangent = Vec3::new(L::one() + sign * normal.x * normal.x * a, sign * b, -(sign * normal.x));
    (tangent, Vec3::new(b, sign + normal.y * normal.y * a, -normal.y))
}

/// A direction given around +z, turned to lie around the unit `normal`.
#[inline(always)]
pub fn to_frame<L: Lane>(local: Vec3<L>, normal: Vec3<L>) -> Vec3<L> {
    let (tangent, bitangent) = frame(normal);
    tangent * local.x + bitangent * local.y + normal * local.z
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use wide::f32x8;

    use super::*;
    use crate::sampling::twin::{assert_lanes, packet};
    use crate::sampling::{Sampler, SamplerKind, unit};

    #[test]
    fn sine_and_cosine_are_as_accurate_as_stated() {
        for k in -20_000..=20_000 {
            let angle = FRAC_PI_4 * f64::from(k) / 20_000.0;
            let (s, c) = sin_cos_octant(angle as f32);
            let exact = libm::sincos(f64::from(angle as f32));
            assert!((f64::from(s) - exact.0).abs() < 1.3e-7, "sin {angle}");
            assert!((f64::from(c) - exact.1).abs() < 1.3e-7, "cos {angle}");
            let (s, c) = sin_cos_octant(angle);
            let exact = libm::sincos(angle);
            assert!((s - exact.0).abs() < 3e-9 && (c - exact.1).abs() < 3e-9, "{angle} in f64");
        }
    }

    #[test]
    fn the_square_maps_to_the_disk_ring_by_ring() {
        assert_eq!(concentric_disk(0.5f32, 0.5), (0.0, 0.0));
        for (u, v) in [(0.0, 0.0), (1.0, 0.25), (0.5, 0.0), (0.0, 0.9), (1.0, 1.0)] {
            let (x, y) = concentric_disk::<f64>(u, v);
            assert!((x.hypot(y) - 1.0).abs() < 1e-8, "({u}, {v})");
        }
    }

    /// Equal areas of the disk (8 sectors x 8 rings) get equal shares of 2^16 Sobol points.
    #[test]
    fn disk_points_are_uniform_in_area_and_azimuth() {
        let (sampler, n) = (Sampler::new(SamplerKind::Sobol, 1 << 16, 0), 1u32 << 16);
        let mut counts = [0u32; 64];
        for s in 0..n {
            let (u, v) = sampler.pair::<f32>(1, 2, s, 3);
            let (x, y) = concentric_disk(u, v);
            let turn = f64::from(y).atan2(f64::from(x)) / std::f64::consts::TAU + 0.5;
            let area = f64::from(x * x + y * y);
            counts[(turn * 8.0).min(7.0) as usize * 8 + (area * 8.0).min(7.0) as usize] += 1;
        }
        for (cell, count) in counts.into_iter().enumerate() {
            assert!(count.abs_diff(n / 64) < 60, "cell {cell}: {count} of {}", n / 64);
        }
    }

    #[test]
    fn the_cosine_lobe_has_mean_cosine_two_thirds() {
        let (sampler, n) = (Sampler::new(SamplerKind::Sobol, 1 << 14, 0), 1u32 << 14);
        let (mut sum, mut inverse) = (Vec3::<f64>::zero(), 0.0);
        for s in 0..n {
            let (u, v) = sampler.pair::<f32>(0, 0, s, 0);
            let d = cosine_hemisphere(u, v);
            assert!((d.length() - 1.0).abs() < 1e-6 && d.z >= 0.0);
            sum += d.widen();
            inverse += f64::from(d.z / cosine_hemisphere_pdf(d.z).max(f32::MIN_POSITIVE));
        }
        let mean = sum * (1.0 / f64::from(n));
        assert!((mean.z - 2.0 / 3.0).abs() < 1e-4 && mean.x.abs() < 1e-3 && mean.y.abs() < 1e-3, "{mean:?}");
        assert!((inverse / f64::from(n) - std::f64::consts::PI).abs() < 1e-3, "white furnace");
    }

    fn normal(words: [u32; 3]) -> Vec3<f32> {
        let [x, y, z] = words.map(|w| unit::<f32>(w) * 2.0 - 1.0);
        Vec3::new(x, y, z + 1e-4f32.with_sign_of(z)).normalize()
    }

    fn assert_orthonormal(n: Vec3<f32>) {
        let (t, b) = frame(n);
        for (a, c) in [(t, b), (b, n), (n, t)] {
            assert!(a.dot(c).abs() < 1e-6 && (a.length() - 1.0).abs() < 1e-6, "{n:?}");
        }
        assert!((t.cross(b) - n).length() < 2e-6, "{n:?} is not right-handed");
    }

    #[test]
    fn frames_hold_at_the_poles() {
        for z in [1.0, -1.0] {
            for x in [0.0, 1e-7, -1e-4, 1e-3] {
                assert_orthonormal(Vec3::new(x, -x, z).normalize());
            }
        }
        assert_orthonormal(Vec3::new(0.6, 0.8, -0.0));
    }

    proptest! {
        #[test]
        fn frames_are_orthonormal_and_lanes_equal_the_scalar(words in any::<[[u32; 3]; 8]>()) {
            let normals = words.map(normal);
            normals.into_iter().for_each(assert_orthonormal);
            let u = |i: usize| unit::<f32>(words[i][0]);
            let v = |i: usize| unit::<f32>(words[i][1]);
            let wide: Vec3<f32x8> =
                Vec3::new(packet(|i| normals[i].x), packet(|i| normals[i].y), packet(|i| normals[i].z));
            let turned = to_frame(cosine_hemisphere(packet(u), packet(v)), wide);
            let scalar = |i: usize| to_frame(cosine_hemisphere(u(i), v(i)), normals[i]);
            assert_lanes(turned.x, |i| scalar(i).x);
            assert_lanes(turned.y, |i| scalar(i).y);
            assert_lanes(turned.z, |i| scalar(i).z);
            assert_lanes(cosine_hemisphere_pdf(turned.z), |i| cosine_hemisphere_pdf(scalar(i).z));
        }
    }
}
