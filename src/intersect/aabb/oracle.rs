//! The plain version: clip the line against three slabs, parallel lines first.

use crate::intersect::RayLanes;
use crate::math::Vec3;

/// First and last `t` of the line inside the box, faces included.
///
/// **Accuracy:** one subtraction and one division in `f64` a plane.
pub fn clip(ray: &RayLanes<f64>, lo: Vec3<f64>, hi: Vec3<f64>) -> Option<(f64, f64)> {
    let (o, d) = (ray.origin, ray.direction);
    let (mut first, mut last) = (f64::NEG_INFINITY, f64::INFINITY);
    for (o, d, lo, hi) in [(o.x, d.x, lo.x, hi.x), (o.y, d.y, lo.y, hi.y), (o.z, d.z, lo.z, hi.z)] {
        if d == 0.0 {
            if o < lo || o > hi {
                return None;
            }
            continue;
        }
        let (a, b) = ((lo - o) / d, (hi - o) / d);
        first = first.max(a.min(b));
        last = last.min(a.max(b));
    }
    (first <= last).then_some((first, last))
}
