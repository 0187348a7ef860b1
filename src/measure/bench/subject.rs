//! A scene as the bench sees it: geometry at a common size, its tree, a camera and a light.

use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

use super::timing::timed;
use crate::accel::Accel;
use crate::geometry::{Geometry, Instance, Planes};
use crate::intersect::PrimKind;
use crate::math::{Aabb, Transform, Vec3};
use crate::scene::{Camera, Light, Projection, Scene};

/// Diagonal that scenes are scaled near to: some ray tracers have absolute epsilons made for such sizes.
const DIAGONAL: f64 = 100.0;

/// Where camera rays start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum View {
    /// At the scene's own camera.
    #[default]
    Scene,
    /// Outside, such that the bounds fill the picture.
    Outside,
    /// In the middle of the bounds along their longest axis: for interiors, where few rays miss.
    Inside,
}

impl View {
    /// Names of all views.
    pub const NAMES: [&'static str; 3] = ["scene", "outside", "inside"];
    /// As written on the command line and in reports.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }
}

impl FromStr for View {
    type Err = String;
    fn from_str(name: &str) -> Result<Self, String> {
        let all = [Self::Scene, Self::Outside, Self::Inside];
        let expected = || format!("there is no view `{name}`: expected one of {}", Self::NAMES.join(", "));
        all.into_iter().find(|view| view.name() == name).ok_or_else(expected)
    }
}

/// Where shadow rays go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// To a point, where they end.
    Point([f64; 3]),
    /// Along a direction, without end.
    Direction([f64; 3]),
}

/// What is measured.
#[derive(Debug)]
pub struct Subject {
    /// Name in reports.
    pub name: String,
    /// Where rays start.
    pub view: View,
    /// All primitives but planes, scaled by a power of two to a diagonal near 100.
    ///
    /// Planes have no bounds: they stand before the tree, other ray tracers have none, and every ray would hit one.
    pub geometry: Geometry,
    /// Its tree.
    pub accel: Accel,
    /// Seconds that building it took the rayon pool that [`Subject::new`] was called in: CPU time of one thread, wall time
    /// of several.
    pub build_s: f64,
    /// The camera.
    pub camera: Camera,
    /// Where shadow rays go.
    pub light: Target,
}

impl Subject {
    /// Takes a scene apart, scales it, and builds its tree anew. `None` where nothing but planes is left.
    pub fn new(name: String, scene: Scene, view: View) -> Option<Self> {
        let bounds = scene.accel.bounds();
        if bounds.is_empty() {
            return None;
        }
        let factor = scale_of(&bounds);
        let Scene { geometry, camera, lights, .. } = scene;
        let mut geometry = Arc::unwrap_or_clone(geometry);
        geometry.planes = Planes::default();
        scale(&mut geometry, factor as f32);
        let (accel, build_s) = timed(rayon::current_num_threads(), || Accel::build(&geometry));
        let bounds = accel.bounds();
        let aspect = length(camera.right) / length(camera.up);
        let (camera, light) = match view {
            View::Scene => (scaled_camera(&camera, factor), target(&lights, factor, &bounds)),
            View::Outside => {
                (camera_outside(&bounds, aspect), Target::Point(within(&bounds, [0.8, 2.0, 1.5])))
            }
            View::Inside => (camera_inside(&bounds, aspect), Target::Point(within(&bounds, [0.5, 0.8, 0.5]))),
        };
        Some(Self { name, view, geometry, accel, build_s, camera, light })
    }

    /// Length of the diagonal of the bounds.
    pub fn diagonal(&self) -> f64 {
        diagonal(&self.accel.bounds())
    }
    /// Primitives in the columns; what instances show counts once.
    pub fn primitive_count(&self) -> usize {
        PrimKind::ALL.iter().map(|&kind| self.geometry.count(kind)).sum()
    }
    /// Bytes of the tree with its leaves.
    pub fn tree_bytes(&self) -> u64 {
        self.accel.memory().iter().map(|(_, bytes)| bytes).sum()
    }
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.view {
            View::Scene => f.write_str(&self.name),
            view => write!(f, "{}@{}", self.name, view.name()),
        }
    }
}

fn length(v: [f64; 3]) -> f64 {
    Vec3::<f64>::splat(v).length()
}

fn diagonal(bounds: &Aabb) -> f64 {
    length(bounds.size().map(f64::from))
}

/// The power of two that brings the diagonal nearest to 100: multiplying by it rounds nothing.
fn scale_of(bounds: &Aabb) -> f64 {
    let diagonal = diagonal(bounds);
    if diagonal > 0.0 { (DIAGONAL / diagonal).log2().round().exp2() } else { 1.0 }
}

fn scale(g: &mut Geometry, by: f32) {
    let (t, s, c) = (&mut g.triangles, &mut g.spheres, &mut g.cylinders);
    let columns = t.position.iter_mut().chain(&mut s.center).chain([&mut s.radius]);
    let columns = columns.chain(&mut c.from).chain(&mut c.to).chain([&mut c.radius]);
    columns.flatten().for_each(|x| *x *= by);
    g.instances.iter_mut().for_each(|instance| instance.to_world = scaled_map(instance, f64::from(by)));
}

/// The same map between two scaled spaces: only its translation grows.
fn scaled_map(instance: &Instance, by: f64) -> Transform {
    let rows = instance.to_world.rows().map(|[x, y, z, w]| [x, y, z, w * by]);
    // The linear part is as invertible as it was.
    Transform::from_rows(rows).unwrap_or(instance.to_world)
}

fn scaled_camera(camera: &Camera, by: f64) -> Camera {
    let scaled = |v: [f64; 3]| v.map(|x| x * by);
    let position = scaled(camera.position);
    match camera.projection {
        Projection::Orthographic => {
            Camera { position, right: scaled(camera.right), up: scaled(camera.up), ..*camera }
        }
        // Rays of all classes start at points: the lens is left out.
        _ => Camera { position, projection: Projection::Pinhole, ..*camera },
    }
}

/// A point by its share of the bounds along each axis.
fn within(bounds: &Aabb, share: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| {
        let (low, high) = (f64::from(bounds.min[k]), f64::from(bounds.max[k]));
        low + (high - low) * share[k]
    })
}

/// From the middle of the bounds towards the camera: from the right, a little above.
const VIEW: [f64; 3] = [0.62, 0.42, 1.0];
/// Half the picture's height at distance 1: 21 degrees upwards.
const HALF_HEIGHT: f64 = 0.384;

/// As near as all corners of the bounds are in the picture.
fn camera_outside(bounds: &Aabb, aspect: f64) -> Camera {
    let backward = Vec3::<f64>::splat(VIEW).normalize();
    let right = Vec3::new(0.0, 1.0, 0.0).cross(backward).normalize();
    let up = backward.cross(right);
    let middle = Vec3::<f64>::splat(within(bounds, [0.5; 3]));
    let distance = bounds.corners().iter().fold(0.0, |distance: f64, &corner| {
        let corner = Vec3::<f64>::splat(corner.map(f64::from)) - middle;
        let across = (corner.dot(right).abs() / aspect).max(corner.dot(up).abs());
        distance.max(corner.dot(backward) + across / HALF_HEIGHT)
    });
    Camera {
        position: (middle + backward * distance).get(0),
        forward: (-backward).get(0),
        right: (right * (HALF_HEIGHT * aspect)).get(0),
        up: (up * HALF_HEIGHT).get(0),
        projection: Projection::Pinhole,
        near: 0.0,
    }
}

fn camera_inside(bounds: &Aabb, aspect: f64) -> Camera {
    let size = bounds.size();
    let longest = (1..3).fold(0, |best, k| if size[k] > size[best] { k } else { best });
    let axis = |k: usize, length: f64| std::array::from_fn(|i| if i == k { length } else { 0.0 });
    let up = if longest == 1 { 2 } else { 1 };
    // 45 degrees up and down.
    Camera {
        position: within(bounds, [0.5; 3]),
        forward: axis(longest, 1.0),
        right: axis(3 - longest - up, aspect),
        up: axis(up, 1.0),
        projection: Projection::Pinhole,
        near: 0.0,
    }
}

/// The scene's first light that has a place, else its first, else a place above the bounds.
fn target(lights: &[Light], factor: f64, bounds: &Aabb) -> Target {
    let placed = lights.iter().find(|light| light.t_max().is_finite());
    let Some(light) = placed.or(lights.first()) else {
        return Target::Point(within(bounds, [0.8, 2.0, 1.5]));
    };
    // Seen from the origin, the way to a light that has a place is that place.
    let to_light = light.illuminate(Vec3::<f64>::zero()).to_light.get(0);
    match light {
        Light::Directional(_) => Target::Direction(to_light),
        _ => Target::Point(to_light.map(|x| x * factor)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::bench::testing::subject;

    #[test]
    fn scenes_come_to_a_common_size() {
        for name in ["seed", "cornell", "spheres", "terrain:200", "instances"] {
            let subject = subject(name, View::Scene);
            assert!((70.0..142.0).contains(&subject.diagonal()), "{name}: {}", subject.diagonal());
            assert_eq!(subject.geometry.planes.len(), 0, "{name}");
        }
    }

    /// Through the middle of the film lies the middle of the bounds, and every corner lies on the film, one at its edge.
    #[test]
    fn the_outside_camera_sees_all_corners() {
        let subject = subject("terrain:2000", View::Outside);
        let camera = &subject.camera;
        let [position, forward, right, up] =
            [camera.position, camera.forward, camera.right, camera.up].map(Vec3::<f64>::splat);
        let mut farthest = 0.0f64;
        for corner in subject.accel.bounds().corners() {
            let way = Vec3::<f64>::splat(corner.map(f64::from)) - position;
            let depth = way.dot(forward);
            let film = |axis: Vec3<f64>| way.dot(axis) / depth / axis.length_squared();
            farthest = farthest.max(film(right).abs()).max(film(up).abs());
        }
        assert!((farthest - 1.0).abs() < 1e-9, "{farthest}");
    }

    #[test]
    fn the_inside_camera_looks_along_the_longest_axis() {
        let subject = subject("terrain:2000", View::Inside);
        let size = subject.accel.bounds().size();
        let along = subject.camera.forward.iter().position(|&x| x == 1.0).unwrap();
        assert!(size.iter().all(|&s| s <= size[along]));
        assert_eq!(subject.to_string(), "terrain:2000@inside");
    }

    #[test]
    fn views_are_read_back() {
        for name in View::NAMES {
            assert_eq!(name.parse::<View>().unwrap().name(), name);
        }
        assert!("above".parse::<View>().unwrap_err().contains("inside"));
    }
}
