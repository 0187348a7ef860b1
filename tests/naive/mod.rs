//! A deliberately simple recursive ray tracer in `f64`, straight from a description: no columns, no tree, no packets, and
//! formulas of its own. Where it and octray agree, both are right or share a misunderstanding of the description alone.
//!
//! One ray goes through each pixel's centre. Not here: random bounces, lenses, mesh files, textures, instances.

mod light;
mod shape;
mod vector;

use octray::describe::{Camera, CameraKind, Handedness, Material, MaterialKind, SceneDescription};

use shape::{Shape, shapes};
use vector::{V, add, cross, dot, mul, normalize, scale, sub};

/// Where a ray meets a shape.
struct Hit {
    t: f64,
    /// Of length one, out of the body.
    outward: V,
    material: Option<usize>,
}

struct World<'a> {
    scene: &'a SceneDescription,
    shapes: Vec<Shape>,
    plain: Material,
}

/// The radiance at each pixel's centre, row by row from the top.
pub(crate) fn render(scene: &SceneDescription) -> Vec<V> {
    let plain = Material::new("", MaterialKind::Diffuse);
    let world = World { scene, shapes: shapes(scene), plain };
    let [width, height] = scene.render.size;
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    pixels
        .map(|(x, y)| {
            let (origin, direction) = camera_ray(&scene.camera, [width, height], x, y);
            world.radiance(origin, direction, 0, &[])
        })
        .collect()
}

fn camera_ray(camera: &Camera, [width, height]: [u32; 2], x: u32, y: u32) -> (V, V) {
    let forward = normalize(sub(camera.look_at, camera.position));
    let right = match camera.handedness {
        Handedness::Right => normalize(cross(forward, camera.up)),
        Handedness::Left => normalize(cross(camera.up, forward)),
    };
    let up = match camera.handedness {
        Handedness::Right => cross(right, forward),
        Handedness::Left => cross(forward, right),
    };
    let pixel = |window_height: f64| window_height / f64::from(height);
    let across = |window_height: f64| {
        let dx = f64::from(x) + 0.5 - 0.5 * f64::from(width);
        let dy = 0.5 * f64::from(height) - f64::from(y) - 0.5;
        add(scale(right, dx * pixel(window_height)), scale(up, dy * pixel(window_height)))
    };
    match camera.kind {
        CameraKind::Perspective => {
            let window = 2.0 * (0.5 * camera.fov_deg).to_radians().tan();
            (camera.position, normalize(add(forward, across(window))))
        }
        CameraKind::Orthographic => (add(camera.position, across(camera.height.unwrap())), forward),
    }
}

impl World<'_> {
    fn nearest(&self, origin: V, direction: V) -> Option<Hit> {
        let hits = self.shapes.iter().filter_map(|s| s.intersect(origin, direction));
        hits.min_by(|a, b| a.t.total_cmp(&b.t))
    }

    /// `bodies` are the materials that the ray is inside of, the innermost last.
    fn radiance(&self, origin: V, direction: V, depth: u32, bodies: &[usize]) -> V {
        let Some(hit) = self.nearest(origin, direction) else { return self.background(direction) };
        let material = hit.material.map_or(&self.plain, |m| &self.scene.material[m]);
        let point = add(origin, scale(direction, hit.t));
        let inside = dot(direction, hit.outward) > 0.0;
        let normal = if inside { scale(hit.outward, -1.0) } else { hit.outward };
        let local = self.direct(point, normal, direction, material);
        if depth == self.scene.render.max_depth {
            return local;
        }
        let tint = scale(material.tint(), material.attenuation);
        let mirrored = sub(direction, scale(normal, 2.0 * dot(direction, normal)));
        match material.kind {
            MaterialKind::Diffuse => local,
            MaterialKind::Metal => add(local, mul(tint, self.radiance(point, mirrored, depth + 1, bodies))),
            MaterialKind::Dielectric => {
                let body = hit.material.unwrap();
                let mut near = bodies.to_vec();
                // A ray that comes out of a body it never entered started inside of it.
                if inside && !near.contains(&body) {
                    near.push(body);
                }
                let (share, refracted, beyond) = self.split(direction, normal, &near, body, inside);
                let mut passed = V::default();
                if share > 0.0 {
                    passed = scale(self.radiance(point, mirrored, depth + 1, &near), share);
                }
                if let Some(way) = refracted {
                    let seen = self.radiance(point, way, depth + 1, &beyond);
                    passed = add(passed, scale(seen, 1.0 - share));
                }
                add(local, mul(tint, passed))
            }
        }
    }

    /// The reflected share, the refracted direction if any, and the bodies on the far side.
    fn split(
        &self,
        direction: V,
        normal: V,
        near: &[usize],
        body: usize,
        inside: bool,
    ) -> (f64, Option<V>, Vec<usize>) {
        let mut beyond = near.to_vec();
        match near.iter().rposition(|&b| b == body) {
            Some(at) if inside => drop(beyond.remove(at)),
            _ => beyond.push(body),
        }
        let index = |bodies: &[usize]| bodies.last().map_or(1.0, |&b| self.scene.material[b].ior);
        let (from, to) = (index(near), index(&beyond));
        // Snell by the part of the direction that runs along the surface.
        let along = add(direction, scale(normal, -dot(direction, normal)));
        let sideways = scale(along, from / to);
        let sine_squared = dot(sideways, sideways);
        if sine_squared >= 1.0 {
            return (1.0, None, beyond);
        }
        let (cos_i, cos_t) = (-dot(direction, normal), (1.0 - sine_squared).sqrt());
        let s = (from * cos_i - to * cos_t) / (from * cos_i + to * cos_t);
        let p = (from * cos_t - to * cos_i) / (from * cos_t + to * cos_i);
        (0.5 * (s * s + p * p), Some(sub(sideways, scale(normal, cos_t))), beyond)
    }

    fn background(&self, direction: V) -> V {
        let [bottom, top] = self.scene.background.bottom_and_top();
        let t = 0.5 + 0.5 * dot(direction, normalize(self.scene.camera.up));
        add(scale(bottom, 1.0 - t), scale(top, t))
    }
}
