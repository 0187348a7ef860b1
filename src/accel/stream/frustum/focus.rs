//! Where rays that start apart would come from.
//!
//! Rays of a camera that a flat mirror throws back go on as if from the camera's image behind it. Plainly: seen along the
//! axis on which the rays go farthest, a ray is at `x = c + a z`; the depth at which the `c + a z` of all rays, and their
//! like in `y`, differ least is that of the point they come from, by least squares.

use wide::f32x8;

use super::slopes::{least, slopes};
use super::view::View;
use super::{asked, narrow};
use crate::accel::instance::TreeRoot;
use crate::intersect::{RayLanes, Tier};
use crate::math::{Lane, Mask, Vec3};

/// How far behind the first ray rays may come from, in largest coordinates of the tree: beams nearly parallel.
const FARTHEST: f32 = 2.0;

/// The point near which rays of packets would have passed had they started earlier; `None` where they go too far apart.
/// An estimate: how far rays pass by it has to be found out.
pub(in super::super) fn focus<T: Tier>(packets: &[RayLanes<T::Wide>], tree: TreeRoot) -> Option<[f32; 3]> {
    let first = packets.iter().find(|rays| asked::<T>(rays) != 0)?;
    let lead = asked::<T>(first).trailing_zeros() as usize;
    let start = narrow::<T>(first.origin).get(lead);
    let view = View::along(narrow::<T>(first.direction).get(lead), start);
    let mut beam = Beam::default();
    for rays in packets {
        let asked = asked::<T>(rays);
        let (a, b, ..) = slopes(view.direction(narrow::<T>(rays.direction)), asked)?;
        let from = view.direction(narrow::<T>(rays.origin) - Vec3::splat(start));
        beam.add(Mask::from_bits(asked), [a, b], from);
    }
    let [x, y, z] = beam.meets(FARTHEST * tree.scale);
    let mut point = start;
    let [along_x, along_y, along_z] = view.axes;
    point[along_x] += x;
    point[along_y] += y;
    point[along_z] += if view.backward { -z } else { z };
    Some(point)
}

/// Sums over rays of slopes `a` and of where they are at `z = 0`, `c`, on two axes.
#[derive(Default)]
struct Beam {
    count: f32x8,
    a: [f32x8; 2],
    c: [f32x8; 2],
    aa: f32x8,
    ac: f32x8,
    nearest: f32x8,
}

impl Beam {
    #[inline(always)]
    fn add(&mut self, asked: <f32x8 as Lane>::Mask, slopes: [f32x8; 2], from: Vec3<f32x8>) {
        let counts = |v: f32x8| Lane::select(asked, v, f32x8::ZERO);
        self.count += counts(f32x8::ONE);
        for (k, at) in [from.x, from.y].into_iter().enumerate() {
            let (a, c) = (counts(slopes[k]), counts(at - slopes[k] * from.z));
            self.a[k] += a;
            self.c[k] += c;
            self.aa += a * a;
            self.ac += a * c;
        }
        self.nearest = Lane::min(self.nearest, counts(from.z));
    }

    /// Where the rays come closest to each other, no farther behind than `farthest` and before any of them starts.
    fn meets(&self, farthest: f32) -> [f32; 3] {
        let sum = |v: f32x8| v.reduce_add();
        let per_ray = 1.0 / sum(self.count);
        let mean = |v: [f32x8; 2]| v.map(|v| sum(v) * per_ray);
        let ([ax, ay], [cx, cy]) = (mean(self.a), mean(self.c));
        let variance = sum(self.aa) * per_ray - (ax * ax + ay * ay);
        let covariance = sum(self.ac) * per_ray - (ax * cx + ay * cy);
        let z = if variance > 0.0 { -covariance / variance } else { -farthest };
        let z = z.max(-farthest).min(least(self.nearest));
        [cx + ax * z, cy + ay * z, z]
    }
}
