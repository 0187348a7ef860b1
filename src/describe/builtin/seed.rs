//! `seed`: the first picture, and the numbers that all others are compared with.

use super::super::{Background, Camera, Handedness, Material, MaterialKind, Rgb, SceneDescription};
use super::parts::{point_lights, sphere, triangle, upright};

pub(super) fn scene() -> SceneDescription {
    // From a window, 2 x 2.667 half, on the plane z = 0, five units from the camera.
    let fov_deg = (2.0 * libm::atan(2.0 / 5.0)).to_degrees();
    let camera = Camera::perspective([0.0, 0.0, -5.0], [0.0; 3], fov_deg);
    let mut scene = SceneDescription::new(Camera { handedness: Handedness::Left, ..camera });
    scene.background = Background::plain([0.24, 0.34, 0.50]);
    scene.light = point_lights(&[
        ([-4.0, 5.0, -3.0], [1.0, 1.0, 1.0], 56.0),
        ([5.0, 4.0, -2.0], [1.0, 0.85, 0.6], 34.0),
    ]);
    scene.material = materials();
    place_objects(&mut scene);
    scene
}

fn place_objects(scene: &mut SceneDescription) {
    let floor = [[-12.0, -1.5, -6.0], [-12.0, -1.5, 9.0], [12.0, -1.5, 9.0], [12.0, -1.5, -6.0]];
    let wall = [[-12.0, -1.5, 9.0], [-12.0, 4.2, 9.0], [12.0, 4.2, 9.0], [12.0, -1.5, 9.0]];
    for (material, [a, b, c, d]) in [("floor", floor), ("wall", wall)] {
        scene.triangle.push(triangle(material, [a, b, c]));
        scene.triangle.push(triangle(material, [a, c, d]));
    }
    scene.sphere = vec![
        sphere("red", [-2.3, -0.70, 2.5], 0.8),
        sphere("steel", [0.2, -0.30, 4.0], 1.2),
        sphere("glass", [-0.7, -0.80, 0.6], 0.7),
        sphere("blue", [2.1, -0.95, 0.9], 0.55),
        sphere("gold", [-3.4, 0.30, 5.5], 1.0),
    ];
    scene.cylinder =
        vec![upright("green", [2.9, -0.50, 4.2], 0.6, 1.0), upright("gold", [0.75, -1.15, 0.5], 0.35, 0.35)];
}

fn materials() -> Vec<Material> {
    use MaterialKind::{Dielectric, Diffuse, Metal};
    vec![
        Written { ka: [0.2; 3], kd: [0.70, 0.68, 0.64], ..matt("floor") }.of(Diffuse),
        Written { ka: [0.2; 3], kd: [0.45, 0.60, 0.55], ..matt("wall") }.of(Diffuse),
        Written { ka: [0.2, 0.1, 0.1], kd: [0.80, 0.16, 0.14], ks: 0.35, ..matt("red") }.of(Diffuse),
        Written { ka: [0.1, 0.1, 0.2], kd: [0.15, 0.25, 0.80], ks: 0.35, ..matt("blue") }.of(Diffuse),
        Written { ka: [0.1, 0.2, 0.1], kd: [0.20, 0.65, 0.25], ks: 0.20, ..matt("green") }.of(Diffuse),
        Written { ka: [0.05; 3], kd: [0.10, 0.10, 0.11], ks: 0.60, ..mirror("steel", [0.90, 0.90, 0.95]) }
            .of(Metal),
        Written {
            ka: [0.08, 0.06, 0.02],
            kd: [0.2, 0.14, 0.04],
            ks: 0.5,
            ..mirror("gold", [0.95, 0.75, 0.35])
        }
        .of(Metal),
        Written {
            ka: [0.0; 3],
            kd: [0.0; 3],
            ks: 0.5,
            tint: Some([1.0; 3]),
            attenuation: 1.0,
            name: "glass",
        }
        .of(Dielectric),
    ]
}

/// One material line of the report's scene; `tint` is `kd` where it says nothing.
struct Written {
    name: &'static str,
    ka: [f64; 3],
    kd: [f64; 3],
    ks: f64,
    tint: Option<[f64; 3]>,
    attenuation: f64,
}

fn matt(name: &'static str) -> Written {
    Written { name, ka: [0.0; 3], kd: [0.0; 3], ks: 0.0, tint: None, attenuation: 0.5 }
}

fn mirror(name: &'static str, tint: [f64; 3]) -> Written {
    Written { tint: Some(tint), attenuation: 0.9, ..matt(name) }
}

impl Written {
    fn of(self, kind: MaterialKind) -> Material {
        Material {
            ka: Some(Rgb(self.ka)),
            kd: Some(Rgb(self.kd)),
            ks: Some(Rgb::grey(self.ks)),
            tint: self.tint.map(Rgb),
            attenuation: self.attenuation,
            ..Material::new(self.name, kind)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn window_of_the_report_is_two_high_at_distance_five() {
        let half = scene().camera.fov_deg.to_radians() / 2.0;
        assert!((5.0 * half.tan() - 2.0).abs() < 1e-12);
    }

    #[test]
    fn tint_of_diffuse_materials_is_their_kd() {
        let scene = scene();
        for material in scene.material.iter().filter(|m| m.kind == MaterialKind::Diffuse) {
            assert_eq!(material.tint(), material.kd(), "{}", material.name);
        }
        assert_eq!(scene.background.ambient(), [0.24, 0.34, 0.50]);
        assert_eq!((scene.render.size, scene.render.spp, scene.render.max_depth), ([640, 480], 16, 6));
    }
}
