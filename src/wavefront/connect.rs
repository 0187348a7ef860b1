//! Direct light: for each light a queue of shadow rays, traced full packets at a time.

use super::arena::Room;
use super::offset::offset_along;
use super::queue::{Column3, compress_eight, words};
use super::surface_queue::SurfaceQueue;
use super::wave::Worker;
use crate::accel::Hint;
use crate::accel::stream::{Bound, RayColumns};
use crate::film::contributes;
use crate::geometry::{entries, gather3};
use crate::intersect::Tier;
use crate::math::{BitLane, Lane, Mask, Vec3, WIDTH};
use crate::scene::Light;
use crate::shading::{Lobes, blinn_phong};

/// Shadow rays and what their light would add.
struct ShadowQueue<'a, R> {
    len: usize,
    origin: Column3<'a, R>,
    direction: Column3<'a, R>,
    radiance: Column3<'a, R>,
    slot: &'a mut [u32],
    /// A bit a ray.
    occluded: &'a mut [u8],
}

/// Adds the light of all lights that reaches the surfaces.
pub(super) fn connect<T: Tier>(worker: &mut Worker<T>, surfaces: &SurfaceQueue<T::Real>, room: &Room) {
    let scene = worker.frame.scene;
    let n = surfaces.len;
    let mut queue = ShadowQueue {
        len: 0,
        origin: Column3::new(room, n + WIDTH),
        direction: Column3::new(room, n + WIDTH),
        radiance: Column3::new(room, n + WIDTH),
        slot: room.column(n + WIDTH),
        occluded: room.column(n / WIDTH + 1),
    };
    for light in &scene.lights {
        queue.len = 0;
        match scene.requirements.fractional_shininess {
            true => shade::<T, true>(worker, surfaces, light, &mut queue),
            false => shade::<T, false>(worker, surfaces, light, &mut queue),
        }
        if scene.settings.shadows {
            trace(worker, light, &mut queue);
        } else {
            queue.occluded.fill(0);
        }
        add_light(worker, &queue);
    }
}

/// Queues a shadow ray for each surface that the light would add something to.
fn shade<T: Tier, const FRACTION: bool>(
    worker: &Worker<T>,
    surfaces: &SurfaceQueue<T::Real>,
    light: &Light,
    queue: &mut ShadowQueue<T::Real>,
) {
    for at in (0..surfaces.len).step_by(WIDTH) {
        let geometric_normal = surfaces.geometric_normal.load::<T::Wide>(at);
        let error = T::Wide::load(&surfaces.error[at..]);
        let origin = offset_along(surfaces.point.load(at), error, geometric_normal);
        let lit = light.illuminate(origin);
        let above = lit.to_light.dot(geometric_normal).gt(T::Wide::zero());
        if above.bits() & surfaces.lanes(at) == 0 {
            continue;
        }
        let reflected = reflected::<T, FRACTION>(worker, surfaces, at, lit.to_light.normalize());
        let radiance = reflected.scale(lit.irradiance).scale(surfaces.throughput.load(at));
        let wanted = (above & contributes(radiance)).bits() & surfaces.lanes(at);
        if wanted == 0 {
            continue;
        }
        let k = queue.len;
        queue.origin.compress(k, origin, wanted);
        queue.direction.compress(k, lit.to_light, wanted);
        queue.radiance.compress(k, radiance, wanted);
        compress_eight(queue.slot, k, surfaces.slots(at), wanted);
        queue.len += wanted.count_ones() as usize;
    }
}

/// What share of the irradiance the surfaces send back along the paths, by colour.
#[inline(always)]
fn reflected<T: Tier, const FRACTION: bool>(
    worker: &Worker<T>,
    surfaces: &SurfaceQueue<T::Real>,
    at: usize,
    to_light: Vec3<T::Wide>,
) -> Vec3<T::Wide> {
    let scene = worker.frame.scene;
    let (normal, wo) = (surfaces.shading_normal().load(at), -surfaces.direction.load(at));
    let diffuse = surfaces.diffuse::<T::Wide>(scene, at);
    let materials = surfaces.materials(at);
    let zero = T::Wide::zero();
    let shine = gather3::<T::Wide>(&scene.materials.specular, materials);
    let shines = scene.requirements.highlights && shine.abs().max_component().gt(zero).any();
    if !shines {
        return diffuse * normal.dot(to_light).max(zero);
    }
    let shininess = entries(&scene.materials.shininess, materials);
    let bits = scene.requirements.shininess_bits;
    let Lobes { diffuse: cos, specular } =
        blinn_phong::<T::Wide, FRACTION>(normal, to_light, wo, BitLane::from_fn(|i| shininess[i]), bits);
    diffuse * cos + shine * specular
}

/// Traces shadow rays up to the light.
fn trace<T: Tier>(worker: &mut Worker<T>, light: &Light, queue: &mut ShadowQueue<T::Real>) {
    worker.rays.shadow += queue.len as u64;
    let rays = RayColumns {
        len: queue.len,
        origin: queue.origin.rows_from(0),
        direction: queue.direction.rows_from(0),
        t_min: Bound::All(T::Real::constant(0.0)),
        t_max: Bound::All(T::Real::constant(light.t_max())),
    };
    worker.stream.any(&rays, Some(light.apex()), Hint::Auto, queue.occluded);
}

/// Adds the light of those that nothing stops.
fn add_light<T: Tier>(worker: &mut Worker<T>, queue: &ShadowQueue<T::Real>) {
    for at in (0..queue.len).step_by(WIDTH) {
        let count = (queue.len - at).min(WIDTH);
        let lanes = !u32::from(queue.occluded[at / WIDTH]) & ((1u64 << count) - 1) as u32;
        worker.radiance.add(words(queue.slot, at), queue.radiance.load::<T::Wide>(at), lanes);
    }
}
