//! Ray queries without rendering: primitives in, hits out, plain arrays on both sides.

mod batch;
mod builder;
#[cfg(test)]
mod tests;

use rayon::prelude::*;

use super::stream::RayStream;
use super::{Accel, Hint};
use crate::intersect::{Exact, Fast, Hit, PrimId, PrimKind, Ray, RayLanes, Tier, TierName, Watertight};
use crate::math::{Lane, Vec3, WIDTH};
use batch::Batch;

pub use builder::{RaySceneBuilder, RaySceneError};

/// Rays that one worker takes at a time; slices up to this length are answered on the calling thread.
const RAYS_PER_TASK: usize = 1024;

/// Primitives that rays can be asked about.
///
/// Made by [`RaySceneBuilder`]. Queries take slices of any length, answer each ray on its own, and share long slices
/// among the threads of the current rayon pool. Answers depend on scene, ray and tier alone: not on the hint, the
/// neighbours in the slice or the number of threads. In [`Watertight`] and [`Exact`] they are the same on every machine.
///
/// A ray with a component that is not finite (or with a `t_min` or `t_max` that is NaN) or without a direction hits
/// nothing. Where several primitives are hit at the same `t`, the lower [`PrimId`] counts: triangles before spheres
/// before cylinders, and within a kind in the order in which they were added.
#[derive(Debug)]
pub struct RayScene {
    accel: Accel,
    /// Where each mesh starts among the triangle rows.
    mesh_start: Vec<usize>,
    /// Primitives by [`PrimKind`] number less one; there are no planes.
    counts: [usize; 3],
}

/// What a hit means in the numbers of who built the scene: each kind is counted from 0 in the order of adding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Primitive {
    /// A triangle.
    Triangle {
        /// Number of the mesh.
        mesh: usize,
        /// Place in the mesh's index buffer.
        triangle: usize,
    },
    /// A sphere.
    Sphere(usize),
    /// A cylinder.
    Cylinder(usize),
}

impl RayScene {
    /// The nearest hit of each ray, `None` where a ray hits nothing between its `t_min` and `t_max`.
    ///
    /// **Accuracy:** that of the tier; `Exact` computes in `f64` and rounds `t`, `u` and `v` at the end, so that a
    /// rounded `t` may equal a bound that the computed one kept.
    ///
    /// **Panics** if the slices differ in length.
    pub fn closest(&self, rays: &[Ray], hits: &mut [Option<Hit>], tier: TierName, hint: Hint) {
        match tier {
            TierName::Fast => self.closest_in::<Fast>(rays, hits, hint),
            TierName::Watertight => self.closest_in::<Watertight>(rays, hits, hint),
            TierName::Exact => self.closest_in::<Exact>(rays, hits, hint),
        }
    }

    /// Whether each ray hits anything between its `t_min` and `t_max`; quicker than [`RayScene::closest`].
    ///
    /// **Panics** if the slices differ in length.
    pub fn occluded(&self, rays: &[Ray], occluded: &mut [bool], tier: TierName, hint: Hint) {
        match tier {
            TierName::Fast => self.occluded_in::<Fast>(rays, occluded, hint),
            TierName::Watertight => self.occluded_in::<Watertight>(rays, occluded, hint),
            TierName::Exact => self.occluded_in::<Exact>(rays, occluded, hint),
        }
    }

    /// [`RayScene::closest`] with the tier as a type.
    pub fn closest_in<T: Tier>(&self, rays: &[Ray], hits: &mut [Option<Hit>], hint: Hint) {
        each_batch::<T, _>(&self.accel, rays, hits, |stream, batch, hits| {
            let apex = batch.apex();
            let (columns, mut found) = batch.asked_for_hits();
            stream.closest(&columns, apex, hint, &mut found);
            for (i, hit) in hits.iter_mut().enumerate() {
                *hit = batch.hit(i);
            }
        });
    }

    /// [`RayScene::occluded`] with the tier as a type.
    pub fn occluded_in<T: Tier>(&self, rays: &[Ray], occluded: &mut [bool], hint: Hint) {
        each_batch::<T, _>(&self.accel, rays, occluded, |stream, batch, occluded| {
            let apex = batch.apex();
            let (columns, bits) = batch.asked_for_any();
            stream.any(&columns, apex, hint, bits);
            for (i, occluded) in occluded.iter_mut().enumerate() {
                *occluded = batch.is_occluded(i);
            }
        });
    }

    /// What a hit of this scene means in the builder's numbers.
    ///
    /// **Panics** if the id is not of this scene.
    pub fn primitive(&self, prim: PrimId) -> Primitive {
        let (kind, row) = (prim.kind(), prim.row());
        let count = self.counts.get(kind as usize - 1).copied().unwrap_or(0);
        assert!(row < count, "this scene has {count} primitives of kind {}: no number {row}", kind.name());
        match kind {
            PrimKind::Sphere => Primitive::Sphere(row),
            PrimKind::Cylinder => Primitive::Cylinder(row),
            _ => {
                // Meshes without triangles start where the next one does: the last of them owns the row.
                let mesh = self.mesh_start.partition_point(|&start| start <= row) - 1;
                Primitive::Triangle { mesh, triangle: row - self.mesh_start[mesh] }
            }
        }
    }

    /// The id that hits of a primitive carry, `None` if there is no such primitive.
    pub fn prim_id(&self, primitive: Primitive) -> Option<PrimId> {
        let [triangles, spheres, cylinders] = self.counts;
        let (kind, row, end) = match primitive {
            Primitive::Triangle { mesh, triangle } => {
                let end = self.mesh_start.get(mesh + 1).copied().unwrap_or(triangles);
                (PrimKind::Triangle, self.mesh_start.get(mesh)?.checked_add(triangle)?, end)
            }
            Primitive::Sphere(row) => (PrimKind::Sphere, row, spheres),
            Primitive::Cylinder(row) => (PrimKind::Cylinder, row, cylinders),
        };
        (row < end).then(|| PrimId::new(kind, row))
    }

    /// Number of primitives of a kind.
    pub fn count(&self, kind: PrimKind) -> usize {
        self.counts.get(kind as usize - 1).copied().unwrap_or(0)
    }

    /// Least and greatest coordinates of everything, `None` for an empty scene.
    pub fn bounds(&self) -> Option<[[f32; 3]; 2]> {
        let bounds = self.accel.bounds();
        (!bounds.is_empty()).then_some([bounds.min, bounds.max])
    }

    /// Bytes that the scene occupies.
    pub fn size_bytes(&self) -> u64 {
        self.accel.memory().iter().map(|(_, size)| size).sum()
    }
}

/// Calls `answer` for a batch of rays and their places at a time; in parallel when there are several.
fn each_batch<T: Tier, A: Send>(
    accel: &Accel,
    rays: &[Ray],
    answers: &mut [A],
    answer: impl Fn(&mut RayStream<T>, &mut Batch<T::Real>, &mut [A]) + Sync,
) {
    let (asked, places) = (rays.len(), answers.len());
    assert!(asked == places, "{asked} rays need as many places for answers, not {places}");
    let scratch = || (RayStream::<T>::new(accel), Batch::default());
    let task = |(stream, batch): &mut (RayStream<T>, Batch<T::Real>), (rays, answers): (&[Ray], &mut [A])| {
        batch.load(rays);
        answer(stream, batch, answers);
    };
    if rays.len() <= RAYS_PER_TASK {
        return task(&mut scratch(), (rays, answers));
    }
    let tasks = rays.par_chunks(RAYS_PER_TASK).zip(answers.par_chunks_mut(RAYS_PER_TASK));
    tasks.for_each_init(scratch, task);
}

fn is_usable(ray: &Ray) -> bool {
    let finite = ray.origin.iter().chain(&ray.direction).all(|x| x.is_finite());
    finite && ray.direction != [0.0; 3] && ray.t_min < ray.t_max
}

/// Up to eight rays as lanes; `None` if none of them can hit anything.
///
/// Lanes that ask nothing take the way of one that does, so that they cannot spoil its packet, and a `t_max` that tells
/// the traversal to leave them alone.
pub(crate) fn lanes<T: Tier>(packet: &[Ray]) -> Option<RayLanes<T::Wide>> {
    let filler = *packet.iter().find(|ray| is_usable(ray))?;
    let idle = Ray { t_max: f32::NEG_INFINITY, ..filler };
    let ray: [Ray; WIDTH] = std::array::from_fn(|i| packet.get(i).copied().filter(is_usable).unwrap_or(idle));
    let column = |of: fn(&Ray) -> f32| T::Wide::load_f32(&ray.each_ref().map(of));
    let origin = Vec3 { x: column(|r| r.origin[0]), y: column(|r| r.origin[1]), z: column(|r| r.origin[2]) };
    let direction =
        Vec3 { x: column(|r| r.direction[0]), y: column(|r| r.direction[1]), z: column(|r| r.direction[2]) };
    Some(RayLanes { origin, direction, t_min: column(|r| r.t_min), t_max: column(|r| r.t_max) })
}
