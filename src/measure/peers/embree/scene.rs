//! A subject's primitives in Embree.

use std::ffi::c_int;
use std::time::Instant;

use super::ffi::{Buffer, Embree, Scene, SceneBuilder};
use super::{NAME, layout};
use crate::geometry::{Geometry, row3};
use crate::intersect::PrimKind;
use crate::measure::bench::{BuildReport, Subject};

/// How a scene is built.
pub(super) struct Quality {
    pub(super) name: &'static str,
    pub(super) quality: c_int,
    pub(super) flags: c_int,
}

/// Builds a scene; gives it with the kind of primitive of each of its geometries.
pub(super) fn build(
    embree: &Embree,
    subject: &Subject,
    quality: &Quality,
    threads: usize,
) -> Result<(Scene, Vec<PrimKind>, BuildReport), String> {
    if !subject.geometry.instances.is_empty() {
        return Err("instances are not handed over".into());
    }
    let device = embree.device(threads)?;
    let mut builder = device.scene(quality.flags, quality.quality);
    let kinds = add_all(&mut builder, &subject.geometry)?;
    let start = Instant::now();
    let (scene, bytes) = builder.commit()?;
    let seconds = start.elapsed().as_secs_f64();
    let count = subject.primitive_count() as f64;
    let report = BuildReport {
        engine: NAME.into(),
        mode: quality.name.into(),
        seconds,
        mprims_s: count / seconds / 1e6,
        bytes_a_prim: Some(bytes as f64 / count),
    };
    Ok((scene, kinds, report))
}

fn add_all(builder: &mut SceneBuilder<'_>, g: &Geometry) -> Result<Vec<PrimKind>, String> {
    let mut kinds = Vec::new();
    for (kind, add) in [
        (PrimKind::Triangle, add_triangles as fn(&mut SceneBuilder<'_>, &Geometry) -> Result<u32, String>),
        (PrimKind::Sphere, add_spheres),
        (PrimKind::Cylinder, add_cylinders),
    ] {
        if g.count(kind) > 0 {
            // Numbers are given in the order of adding.
            add(builder, g)?;
            kinds.push(kind);
        }
    }
    Ok(kinds)
}

fn vertices<const N: usize>(format: c_int, rows: &[[f32; N]]) -> Buffer<'_, f32, N> {
    Buffer { kind: layout::VERTEX_BUFFER, format, rows }
}

fn indices<const N: usize>(format: c_int, rows: &[[u32; N]]) -> Buffer<'_, u32, N> {
    Buffer { kind: layout::INDEX_BUFFER, format, rows }
}

fn add_triangles(builder: &mut SceneBuilder<'_>, g: &Geometry) -> Result<u32, String> {
    let t = &g.triangles;
    let positions: Vec<[f32; 3]> = (0..t.position[0].len()).map(|i| row3(&t.position, i)).collect();
    let corners: Vec<[u32; 3]> = (0..t.len()).map(|i| t.vertex.each_ref().map(|column| column[i])).collect();
    let faces = indices(layout::UINT3, &corners);
    builder.add(layout::TRIANGLE, &vertices(layout::FLOAT3, &positions), Some(&faces))
}

fn add_spheres(builder: &mut SceneBuilder<'_>, g: &Geometry) -> Result<u32, String> {
    let s = &g.spheres;
    let rows: Vec<[f32; 4]> = (0..s.len()).map(|i| with_radius(row3(&s.center, i), s.radius[i])).collect();
    builder.add::<4, 1>(layout::SPHERE_POINT, &vertices(layout::FLOAT4, &rows), None)
}

/// Embree's are closed by disks; open ones count as closed there.
fn add_cylinders(builder: &mut SceneBuilder<'_>, g: &Geometry) -> Result<u32, String> {
    let c = &g.cylinders;
    let ends = |i: usize| [&c.from, &c.to].map(|end| with_radius(row3(end, i), c.radius[i]));
    let rows: Vec<[f32; 4]> = (0..c.len()).flat_map(ends).collect();
    // A segment goes from the vertex of its index to the next.
    let starts: Vec<[u32; 1]> = (0..c.len() as u32).map(|i| [2 * i]).collect();
    let segments = indices(layout::UINT, &starts);
    builder.add(layout::CONE_LINEAR_CURVE, &vertices(layout::FLOAT4, &rows), Some(&segments))
}

fn with_radius([x, y, z]: [f32; 3], radius: f32) -> [f32; 4] {
    [x, y, z, radius]
}
