//! Cameras that a bench looks through.

use std::str::FromStr;

use super::subject::length;
use crate::math::{Aabb, Vec3};
use crate::scene::{Camera, Projection};

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

    /// The camera of a scene that is scaled by `factor` to these bounds; `own` is the scene's before that.
    pub(super) fn camera(self, own: &Camera, factor: f64, bounds: &Aabb) -> Camera {
        let aspect = length(own.right) / length(own.up);
        match self {
            Self::Scene => scaled(own, factor),
            Self::Outside => outside(bounds, aspect),
            Self::Inside => inside(bounds, aspect),
        }
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

/// A point by its share of the bounds along each axis.
pub(super) fn within(bounds: &Aabb, share: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| {
        let (low, high) = (f64::from(bounds.min[k]), f64::from(bounds.max[k]));
        low + (high - low) * share[k]
    })
}

fn scaled(camera: &Camera, by: f64) -> Camera {
    let larger = |v: [f64; 3]| v.map(|x| x * by);
    let position = larger(camera.position);
    match camera.projection {
        Projection::Orthographic => {
            Camera { position, right: larger(camera.right), up: larger(camera.up), ..*camera }
        }
        // Rays of all classes start at points: the lens is left out.
        _ => Camera { position, projection: Projection::Pinhole, ..*camera },
    }
}

/// From the middle of the bounds towards the camera: from the right, a little above.
const VIEW: [f64; 3] = [0.62, 0.42, 1.0];
/// Half the picture's height at distance 1: 21 degrees upwards.
const HALF_HEIGHT: f64 = 0.384;

/// As near as all corners of the bounds are in the picture.
fn outside(bounds: &Aabb, aspect: f64) -> Camera {
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

fn inside(bounds: &Aabb, aspect: f64) -> Camera {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::bench::testing::subject;

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
