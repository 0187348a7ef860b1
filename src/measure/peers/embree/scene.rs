//! A subject's primitives in Embree.

use std::ffi::c_int;
use std::ops::Range;

use super::ffi::{Buffer, Embree, Scene, SceneBuilder};
use super::{NAME, layout};
use crate::geometry::{Geometry, Group, row3};
use crate::intersect::{PrimId, PrimKind};
use crate::measure::bench::{BuildReport, NO_HIT, Subject, timed};

/// How a scene is built.
pub(super) struct Quality {
    pub(super) name: &'static str,
    pub(super) quality: c_int,
    pub(super) flags: c_int,
}

/// What a geometry of a scene holds: a kind of primitive, and the row of the first.
type Part = (PrimKind, usize);

/// What hits in a scene mean.
#[derive(Clone, Default)]
pub(super) struct Numbers {
    /// Geometries of the world; instances come after.
    world: Vec<Part>,
    /// Geometries of what each instance shows.
    instances: Vec<Vec<Part>>,
}

impl Numbers {
    /// The id of a primitive, or [`NO_HIT`].
    #[inline(always)]
    pub(super) fn id(&self, instance: u32, geometry: u32, prim: u32) -> u32 {
        let parts = match instance {
            layout::NO_GEOMETRY => &self.world,
            number => &self.instances[number as usize - self.world.len()],
        };
        let part = parts.get(geometry as usize);
        part.map_or(NO_HIT, |&(kind, first)| PrimId::new(kind, first + prim as usize).0)
    }
}

/// Builds a scene.
pub(super) fn build(
    embree: &Embree,
    subject: &Subject,
    quality: &Quality,
    threads: usize,
) -> Result<(Scene, Numbers, BuildReport), String> {
    let (g, device) = (&subject.geometry, embree.device(threads)?);
    let (mut seconds, mut bytes) = (0.0, 0);
    let mut commit = |builder: SceneBuilder<'_>| -> Result<Scene, String> {
        let (committed, taken_s) = timed(threads, || builder.commit());
        let (scene, taken) = committed?;
        seconds += taken_s;
        bytes += taken;
        Ok(scene)
    };
    let mut scenes = Vec::new();
    let mut parts = Vec::new();
    for group in g.groups.iter().skip(1) {
        let mut builder = device.scene(quality.flags, quality.quality);
        parts.push(add_group(&mut builder, g, group)?);
        scenes.push(commit(builder)?);
    }
    let mut builder = device.scene(quality.flags, quality.quality);
    let mut numbers = Numbers::default();
    if let Some(world) = g.groups.first() {
        numbers.world = add_group(&mut builder, g, world)?;
    }
    for instance in &g.instances {
        let to_world = instance.to_world.rows().map(|row| row.map(|x| x as f32));
        builder.add_instance(&scenes[instance.group - 1], &to_world)?;
        numbers.instances.push(parts[instance.group - 1].clone());
    }
    let scene = commit(builder)?;
    let report = BuildReport::new(NAME, quality.name, subject.primitive_count(), seconds, Some(bytes as f64));
    Ok((scene, numbers, report))
}

fn add_group(builder: &mut SceneBuilder<'_>, g: &Geometry, group: &Group) -> Result<Vec<Part>, String> {
    let mut parts = Vec::new();
    let Group { triangles, spheres, cylinders } = group.clone();
    if !triangles.is_empty() {
        parts.push((PrimKind::Triangle, triangles.start));
        add_triangles(builder, g, triangles)?;
    }
    if !spheres.is_empty() {
        parts.push((PrimKind::Sphere, spheres.start));
        add_spheres(builder, g, spheres)?;
    }
    if !cylinders.is_empty() {
        parts.push((PrimKind::Cylinder, cylinders.start));
        add_cylinders(builder, g, cylinders)?;
    }
    Ok(parts)
}

fn vertices<const N: usize>(format: c_int, rows: &[[f32; N]]) -> Buffer<'_, f32, N> {
    Buffer { kind: layout::VERTEX_BUFFER, format, rows }
}

fn indices<const N: usize>(format: c_int, rows: &[[u32; N]]) -> Buffer<'_, u32, N> {
    Buffer { kind: layout::INDEX_BUFFER, format, rows }
}

fn add_triangles(builder: &mut SceneBuilder<'_>, g: &Geometry, rows: Range<usize>) -> Result<(), String> {
    let t = &g.triangles;
    let positions: Vec<[f32; 3]> = (0..t.position[0].len()).map(|i| row3(&t.position, i)).collect();
    let corners: Vec<[u32; 3]> = rows.map(|i| t.vertex.each_ref().map(|column| column[i])).collect();
    let faces = indices(layout::UINT3, &corners);
    builder.add(layout::TRIANGLE, &vertices(layout::FLOAT3, &positions), Some(&faces))
}

fn add_spheres(builder: &mut SceneBuilder<'_>, g: &Geometry, rows: Range<usize>) -> Result<(), String> {
    let s = &g.spheres;
    let rows: Vec<[f32; 4]> = rows.map(|i| with_radius(row3(&s.center, i), s.radius[i])).collect();
    builder.add::<4, 1>(layout::SPHERE_POINT, &vertices(layout::FLOAT4, &rows), None)
}

/// Embree's are closed by disks; open ones count as closed there.
fn add_cylinders(builder: &mut SceneBuilder<'_>, g: &Geometry, rows: Range<usize>) -> Result<(), String> {
    let c = &g.cylinders;
    let ends = |i: usize| [&c.from, &c.to].map(|end| with_radius(row3(end, i), c.radius[i]));
    let starts = (0..rows.len() as u32).map(|i| [2 * i]);
    let rows: Vec<[f32; 4]> = rows.flat_map(ends).collect();
    // A segment goes from the vertex of its index to the next.
    let starts: Vec<[u32; 1]> = starts.collect();
    let segments = indices(layout::UINT, &starts);
    builder.add(layout::CONE_LINEAR_CURVE, &vertices(layout::FLOAT4, &rows), Some(&segments))
}

fn with_radius([x, y, z]: [f32; 3], radius: f32) -> [f32; 4] {
    [x, y, z, radius]
}
