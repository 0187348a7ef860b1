//! The plain version: closest approach and Pythagoras.

use crate::intersect::RayLanes;
use crate::math::Vec3;

/// Where the line of the ray enters and leaves a sphere, if it meets it; a tangent line does both at once.
///
/// **Accuracy:** `f64` in coordinates shifted to the centre: a line within some roundoffs (of the distance between
/// origin and centre) of tangency may count as either.
pub fn enter_and_leave(ray: &RayLanes<f64>, center: Vec3<f64>, radius: f64) -> Option<(f64, f64)> {
    let from_center = ray.origin - center;
    let speed = ray.direction.length();
    let heading = ray.direction * (1.0 / speed);
    let to_closest = -from_center.dot(heading);
    let closest = from_center + heading * to_closest;
    let half_chord_squared = radius * radius - closest.length_squared();
    if half_chord_squared.is_nan() || half_chord_squared < 0.0 {
        return None;
    }
    let half_chord = half_chord_squared.sqrt();
    Some(((to_closest - half_chord) / speed, (to_closest + half_chord) / speed))
}
