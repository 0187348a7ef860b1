//! Vertex normals: made from the triangles around, repaired where a file gives none of length.

use super::Mesh;
use std::collections::HashMap;

/// The mesh with normals made from the triangles around each vertex, weighted by area.
///
/// Vertices at the same place count as one: seams between texture patches and groups stay invisible.
pub(super) fn make_smooth(mesh: &mut Mesh) {
    mesh.normals = around(mesh).into_iter().map(|n| unit(n).unwrap_or([0.0, 1.0, 0.0])).collect();
}

/// Brings all normals to length 1 and replaces those that cannot be; counts these in the report.
pub(super) fn repair(mesh: &mut Mesh) {
    let mut normals = std::mem::take(&mut mesh.normals);
    let mut means: Option<Vec<[f64; 3]>> = None;
    for (vertex, normal) in normals.iter_mut().enumerate() {
        *normal = unit(normal.map(f64::from)).unwrap_or_else(|| {
            mesh.report.normals_replaced += 1;
            let means = means.get_or_insert_with(|| around(mesh));
            unit(means[vertex]).unwrap_or([0.0, 1.0, 0.0])
        });
    }
    mesh.normals = normals;
}

/// The sum of the cross products of all triangles around each vertex.
fn around(mesh: &Mesh) -> Vec<[f64; 3]> {
    let places = places(&mesh.positions);
    let mut sums = vec![[0.0; 3]; mesh.positions.len()];
    for triangle in &mesh.triangles {
        let cross = cross_product(triangle.map(|v| mesh.positions[v as usize]));
        for &vertex in triangle {
            let sum: &mut [f64; 3] = &mut sums[places[vertex as usize] as usize];
            *sum = std::array::from_fn(|i| sum[i] + cross[i]);
        }
    }
    places.iter().map(|&place| sums[place as usize]).collect()
}

/// For each vertex the first one at the same place.
fn places(positions: &[[f32; 3]]) -> Vec<u32> {
    let mut first = HashMap::with_capacity(positions.len());
    // Adding 0 turns -0 into 0.
    let key = |p: &[f32; 3]| p.map(|x| (x + 0.0).to_bits());
    positions.iter().enumerate().map(|(i, p)| *first.entry(key(p)).or_insert(i as u32)).collect()
}

/// Twice the area of a triangle along its normal, in double precision.
pub(super) fn cross_product(corners: [[f32; 3]; 3]) -> [f64; 3] {
    let [a, b, c] = corners.map(|p| p.map(f64::from));
    let [u, v]: [[f64; 3]; 2] = [b, c].map(|p| std::array::from_fn(|i| p[i] - a[i]));
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

fn unit(v: [f64; 3]) -> Option<[f32; 3]> {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    (length > 0.0 && length.is_finite()).then(|| v.map(|x| (x / length) as f32))
}
