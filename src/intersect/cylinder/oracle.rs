//! The plain version: turn the axis upright, then ask side and caps one after the other.

use crate::intersect::RayLanes;
use crate::math::Vec3;

/// A surface of a cylinder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The curved side.
    Side,
    /// The cap at `from`.
    FromCap,
    /// The cap at `to`.
    ToCap,
}

/// A cylinder with its axis from `from` to `to`.
#[derive(Clone, Copy, Debug)]
pub struct Cylinder {
    /// Centre of the first cap.
    pub from: Vec3<f64>,
    /// Centre of the second cap.
    pub to: Vec3<f64>,
    /// Radius.
    pub radius: f64,
    /// Closed by caps.
    pub capped: bool,
}

/// Everywhere that the line of the ray meets the surface, in order of `t`.
///
/// **Accuracy:** `f64`. Side points are kept by height and cap points by radius, each asked alone, so a line within some
/// roundoffs of the rim may be given two meetings there, or none: the kernel must not copy that.
pub fn meetings(ray: &RayLanes<f64>, cylinder: &Cylinder) -> Vec<(f64, Part)> {
    let (origin, direction, height) = upright(ray, cylinder);
    let mut found = side(origin, direction, cylinder.radius)
        .into_iter()
        .filter(|t| (0.0..=height).contains(&(origin.z + t * direction.z)))
        .map(|t| (t, Part::Side))
        .collect::<Vec<_>>();
    if cylinder.capped && direction.z != 0.0 {
        for (level, part) in [(0.0, Part::FromCap), (height, Part::ToCap)] {
            let t = (level - origin.z) / direction.z;
            let (x, y) = (origin.x + t * direction.x, origin.y + t * direction.y);
            if x * x + y * y <= cylinder.radius * cylinder.radius {
                found.push((t, part));
            }
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found
}

/// Origin and direction in the frame whose `z` runs from `from` (at 0) to `to` (at the height given last).
fn upright(ray: &RayLanes<f64>, c: &Cylinder) -> (Vec3<f64>, Vec3<f64>, f64) {
    let height = (c.to - c.from).length();
    let up = (c.to - c.from) * (1.0 / height);
    let least = [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0)]
        .into_iter()
        .min_by(|a, b| a.dot(up).abs().total_cmp(&b.dot(up).abs()))
        .unwrap_or(up);
    let right = up.cross(least).normalize();
    let front = up.cross(right);
    let turn = |p: Vec3<f64>| Vec3::new(p.dot(right), p.dot(front), p.dot(up));
    (turn(ray.origin - c.from), turn(ray.direction), height)
}

/// Where the line meets the infinite upright cylinder around the origin: none, or enter and leave.
fn side(o: Vec3<f64>, d: Vec3<f64>, radius: f64) -> Vec<f64> {
    let speed = (d.x * d.x + d.y * d.y).sqrt();
    // Signed distance at which the line, seen from above, passes the axis.
    let offset = (o.x * d.y - o.y * d.x) / speed;
    if speed == 0.0 || offset.abs() > radius {
        return Vec::new();
    }
    let to_closest = -(o.x * d.x + o.y * d.y) / speed;
    let half_chord = ((radius - offset) * (radius + offset)).sqrt();
    vec![(to_closest - half_chord) / speed, (to_closest + half_chord) / speed]
}
