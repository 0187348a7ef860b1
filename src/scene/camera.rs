//! From a place on the film to a ray.

use crate::accel::stream::Apex;
use crate::math::{Lane, Vec3};

/// How the camera projects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// All rays through the camera's position.
    Pinhole,
    /// Rays through a disk, all through one point of the plane in focus.
    ThinLens {
        /// Radius of the disk in world units.
        aperture_radius: f64,
        /// Distance of the plane in focus along the view axis.
        focus_distance: f64,
    },
    /// All rays along the view axis.
    Orthographic,
}

/// A camera as compiled: its position and three axes.
///
/// **Units:** the picture spans -1 to 1 along `right` and `up`. For the perspective projections these are the half
/// extents of the picture at distance 1 along `forward`, for the orthographic one at the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where the camera stands.
    pub position: [f64; 3],
    /// View axis, of length one.
    pub forward: [f64; 3],
    /// Half the picture's width.
    pub right: [f64; 3],
    /// Half the picture's height.
    pub up: [f64; 3],
    /// How it projects.
    pub projection: Projection,
    /// Nothing is seen before this distance along the view axis.
    pub near: f64,
}

/// Camera rays as lanes; directions of length one.
#[derive(Clone, Copy, Debug)]
pub struct CameraRays<L> {
    /// Where they start.
    pub origin: Vec3<L>,
    /// Where they go.
    pub direction: Vec3<L>,
    /// Where the near plane is along them.
    pub t_min: L,
}

fn splat<L: Lane>(v: [f64; 3]) -> Vec3<L> {
    Vec3::new(L::constant(v[0]), L::constant(v[1]), L::constant(v[2]))
}

impl Camera {
    /// What all rays have in common: the point that they start from, or their direction; nothing behind a lens.
    pub fn apex(&self) -> Option<Apex> {
        match self.projection {
            Projection::Pinhole => Some(Apex::Origin(self.position.map(|x| x as f32))),
            Projection::Orthographic => Some(Apex::Parallel),
            Projection::ThinLens { .. } => None,
        }
    }

    /// Rays through places of the film, -1 to 1 from left to right and from bottom to top.
    ///
    /// `lens` are points of the unit disk, wanted by the thin lens alone.
    #[inline(always)]
    pub fn rays<L: Lane>(&self, film: (L, L), lens: impl FnOnce() -> (L, L)) -> CameraRays<L> {
        let (right, up, forward) = (splat::<L>(self.right), splat::<L>(self.up), splat::<L>(self.forward));
        let position = splat::<L>(self.position);
        let across = right * film.0 + up * film.1;
        let (origin, direction) = match self.projection {
            Projection::Pinhole => (position, forward + across),
            Projection::Orthographic => (position + across, forward),
            Projection::ThinLens { aperture_radius, focus_distance } => {
                let (x, y) = lens();
                let on_lens = (right.normalize() * x + up.normalize() * y) * L::constant(aperture_radius);
                (position + on_lens, (forward + across) * L::constant(focus_distance) - on_lens)
            }
        };
        let direction = direction.normalize();
        let t_min = L::constant(self.near) / direction.dot(forward);
        CameraRays { origin, direction, t_min }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(projection: Projection) -> Camera {
        Camera {
            position: [0.0, 0.0, -5.0],
            forward: [0.0, 0.0, 1.0],
            right: [0.8, 0.0, 0.0],
            up: [0.0, 0.6, 0.0],
            projection,
            near: 2.0,
        }
    }

    fn close(a: Vec3<f64>, b: [f64; 3]) {
        for (x, y) in [a.x, a.y, a.z].into_iter().zip(b) {
            assert!((x - y).abs() < 1e-12, "{a:?} is not {b:?}");
        }
    }

    #[test]
    fn the_corner_of_the_film_is_the_corner_of_the_window() {
        let r = camera(Projection::Pinhole).rays((1.0, 1.0), || (0.0, 0.0));
        close(r.origin + r.direction * (5.0 / r.direction.z), [4.0, 3.0, 0.0]);
    }

    #[test]
    fn the_near_plane_is_flat() {
        let r = camera(Projection::Pinhole).rays((-1.0, 0.5), || (0.0, 0.0));
        assert!((r.direction.z * r.t_min - 2.0).abs() < 1e-12);
    }

    #[test]
    fn every_point_of_the_lens_sees_the_same_point_in_focus() {
        let lens = Projection::ThinLens { aperture_radius: 0.3, focus_distance: 7.0 };
        for point in [(0.0, 0.0), (1.0, 0.0), (-0.5, 0.7)] {
            let r = camera(lens).rays((0.25, -0.5), || point);
            close(r.origin + r.direction * (7.0 / r.direction.z), [1.4, -2.1, 2.0]);
        }
    }

    #[test]
    fn orthographic_rays_are_parallel() {
        let r = camera(Projection::Orthographic).rays((1.0, -1.0), || (0.0, 0.0));
        close(r.origin, [0.8, -0.6, -5.0]);
        close(r.direction, [0.0, 0.0, 1.0]);
    }
}
