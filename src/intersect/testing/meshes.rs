//! Closed meshes around the origin.

use std::collections::HashMap;

#[cfg(test)]
use super::dice::Dice;
#[cfg(test)]
use crate::math::{Lane, Real, Vec3};

/// A closed surface: every edge belongs to two triangles.
pub(crate) struct Mesh {
    pub(crate) points: Vec<[f64; 3]>,
    pub(crate) triangles: Vec<[usize; 3]>,
}

fn mesh(points: &[[f64; 3]], triangles: &[[usize; 3]]) -> Mesh {
    Mesh { points: points.to_vec(), triangles: triangles.to_vec() }
}

pub(crate) fn tetrahedron() -> Mesh {
    let points = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    mesh(&points, &[[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
}

pub(crate) fn cube() -> Mesh {
    let corner = |i: usize| std::array::from_fn(|k| if i >> k & 1 == 0 { -1.0 } else { 1.0 });
    let faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let triangles = faces.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]);
    Mesh { points: (0..8).map(corner).collect(), triangles: triangles.collect() }
}

fn octant_icosahedron() -> Mesh {
    let g = (1.0 + 5f64.sqrt()) / 2.0;
    let points = (0..12)
        .map(|i| {
            let (s, t) = (if i & 1 == 0 { 1.0 } else { -1.0 }, if i & 2 == 0 { g } else { -g });
            [[0.0, s, t], [s, t, 0.0], [t, 0.0, s]][i >> 2]
        })
        .collect::<Vec<[f64; 3]>>();
    let near = |a: usize, b: usize| {
        let d2: f64 = (0..3).map(|k| (points[a][k] - points[b][k]).powi(2)).sum();
        (d2 - 4.0).abs() < 1e-9
    };
    let all = (0..12).flat_map(|a| (a..12).flat_map(move |b| (b..12).map(move |c| [a, b, c])));
    let triangles = all.filter(|&[a, b, c]| near(a, b) && near(b, c) && near(a, c)).collect();
    Mesh { points, triangles }
}

/// 20 * 4^levels triangles.
pub(crate) fn icosphere(levels: usize) -> Mesh {
    (0..levels).fold(octant_icosahedron(), |m, _| split(m)).on_unit_sphere()
}

fn split(mut m: Mesh) -> Mesh {
    let mut middles = HashMap::new();
    let mut triangles = Vec::new();
    for &t in &m.triangles {
        let mid: [usize; 3] = std::array::from_fn(|i| {
            let (a, b) = (t[i].min(t[(i + 1) % 3]), t[i].max(t[(i + 1) % 3]));
            *middles.entry((a, b)).or_insert_with(|| {
                m.points.push(std::array::from_fn(|k| (m.points[a][k] + m.points[b][k]) / 2.0));
                m.points.len() - 1
            })
        });
        triangles.extend((0..3).map(|i| [t[i], mid[i], mid[(i + 2) % 3]]));
        triangles.push(mid);
    }
    Mesh { points: m.points, triangles }.on_unit_sphere()
}

impl Mesh {
    fn on_unit_sphere(mut self) -> Self {
        for p in &mut self.points {
            let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
            *p = p.map(|x| x / length);
        }
        self
    }

    /// Turned at random, scaled by 1e-6 to 1e6, moved by up to `reach` times its size; and where its centre went.
    #[cfg(test)]
    pub(crate) fn placed(&self, dice: &mut Dice, reach: f64) -> (Vec<[f32; 3]>, Vec3<f64>, f64) {
        let size = dice.magnitude(-6.0, 6.0).abs();
        let center = dice.point().map(|x| x * reach * size);
        let turn = turned(dice.heading(), dice.between(0.0, 7.0));
        let place = |p: [f64; 3]| -> [f64; 3] {
            std::array::from_fn(|r| center[r] + size * (0..3).map(|k| turn[r][k] * p[k]).sum::<f64>())
        };
        let points = self.points.iter().map(|&p| place(p).map(|x| x as f32)).collect();
        (points, Vec3::splat(center), size)
    }

    /// As many triangles a packet as there are lanes, padded with NaN.
    #[cfg(test)]
    pub(crate) fn packets<L: Lane>(&self, points: &[[f32; 3]]) -> Vec<[Vec3<L>; 3]> {
        let corner = |t: Option<&[usize; 3]>, k: usize| t.map_or([f32::NAN; 3], |t| points[t[k]]);
        let pack = |ts: &[[usize; 3]]| {
            std::array::from_fn(|k| {
                let column = |axis: usize| L::from_fn(|i| L::Scalar::from_f32(corner(ts.get(i), k)[axis]));
                Vec3::new(column(0), column(1), column(2))
            })
        };
        self.triangles.chunks(L::WIDTH).map(pack).collect()
    }
}

/// The rows of a rotation about a unit axis (Rodrigues' formula).
#[cfg(test)]
fn turned([x, y, z]: [f64; 3], angle_rad: f64) -> [[f64; 3]; 3] {
    let (s, c) = angle_rad.sin_cos();
    let k = 1.0 - c;
    [
        [c + k * x * x, k * x * y - s * z, k * x * z + s * y],
        [k * x * y + s * z, c + k * y * y, k * y * z - s * x],
        [k * x * z - s * y, k * y * z + s * x, c + k * z * z],
    ]
}

#[test]
fn meshes_are_closed() {
    for (m, count) in [(tetrahedron(), 4), (cube(), 12), (icosphere(0), 20), (icosphere(3), 1280)] {
        assert_eq!(m.triangles.len(), count);
        let mut edges = HashMap::new();
        for t in &m.triangles {
            for i in 0..3 {
                let (a, b) = (t[i], t[(i + 1) % 3]);
                *edges.entry((a.min(b), a.max(b))).or_insert(0) += 1;
            }
        }
        assert!(edges.values().all(|&n| n == 2));
    }
}
