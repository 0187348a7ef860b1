//! Secondary rays: mirrored, refracted, scattered; one function a kind of material.

use super::arena::Room;
use super::medium::{Media, NO_BODY, OUTSIDE, enter, found_inside, innermost, leave, material_of_body};
use super::offset::offset_along;
use super::queue::{PathLanes, PathQueue, Rows, gather as column_rows, list_lanes};
use super::surface_queue::SurfaceQueue;
use super::wave::{WaveSamples, Worker};
use crate::geometry::gather3;
use crate::intersect::Tier;
use crate::math::{BitLane, Lane, Mask, Vec3, WIDTH, eight};
use crate::sampling::{ScatterDraw, bounce, child_branch, cosine_hemisphere, to_frame};
use crate::scene::Scatter;
use crate::shading::{fresnel_dielectric, reflect, refract};

/// Eight surfaces of one kind of material.
struct Lanes<L: Lane> {
    point: Vec3<L>,
    error: L,
    geometric_normal: Vec3<L>,
    shading_normal: Vec3<L>,
    direction: Vec3<L>,
    /// Throughput times what the material passes on.
    weight: Vec3<L>,
    bodies: [u32; WIDTH],
    slot: [u32; WIDTH],
    /// What the paths are inside of, in scenes with dielectrics.
    media: [Media; WIDTH],
    /// Which splits led here, in scenes with diffuse bounces.
    branch: [u32; WIDTH],
    from_inside: L::Mask,
    lanes: u32,
}

/// Queues all secondary rays of the surfaces: those that are refracted after all others, since packets of both kinds would
/// have little in common.
pub(super) fn scatter<T: Tier>(
    worker: &mut Worker<T>,
    wave: WaveSamples,
    depth: u32,
    paths: &PathQueue<T::Real>,
    surfaces: &SurfaceQueue<T::Real>,
    next: &mut PathQueue<T::Real>,
    room: &Room,
) {
    let refracting = surfaces.by_scatter[Scatter::Dielectric as usize].len();
    let mut through = PathQueue::new(room, refracting + WIDTH, worker.frame.secondary_needs());
    for kind in Scatter::ALL {
        let list = &surfaces.by_scatter[kind as usize];
        for at in (0..list.len()).step_by(WIDTH) {
            let (rows, lanes) = list_lanes(list, at);
            let s = gather::<T>(worker, surfaces, paths, &rows, lanes);
            match kind {
                Scatter::Absorb => {}
                Scatter::Metal => mirror(worker, &s, next),
                Scatter::Dielectric => dielectric(worker, &s, (next, &mut through)),
                Scatter::Diffuse => diffuse(worker, &s, wave, depth, next),
            }
        }
    }
    next.append(&through);
}

fn gather<T: Tier>(
    worker: &Worker<T>,
    surfaces: &SurfaceQueue<T::Real>,
    paths: &PathQueue<T::Real>,
    rows: &Rows,
    lanes: u32,
) -> Lanes<T::Wide> {
    let scene = worker.frame.scene;
    let materials = rows.of(surfaces.material);
    let tint = gather3::<T::Wide>(&scene.materials.tint, &materials);
    let weight = surfaces.throughput.gather::<T::Wide>(rows).scale(tint);
    let inside = T::Wide::from_bits(wide::u32x8::new(rows.of(surfaces.from_inside)));
    let from = Rows::new(rows.of(surfaces.path));
    let bright = weight.max_component().ge(T::Wide::constant(scene.settings.min_throughput));
    Lanes {
        point: surfaces.point.gather(rows),
        error: column_rows(surfaces.error, rows),
        geometric_normal: surfaces.geometric_normal.gather(rows),
        shading_normal: surfaces.shading_normal().gather(rows),
        direction: surfaces.direction.gather(rows),
        weight,
        bodies: if surfaces.body.is_empty() { [NO_BODY; WIDTH] } else { rows.of(surfaces.body) },
        slot: rows.of(surfaces.slot),
        media: if paths.medium.is_empty() { [OUTSIDE; WIDTH] } else { from.of(paths.medium) },
        branch: if paths.branch.is_empty() { [0; WIDTH] } else { from.of(paths.branch) },
        from_inside: inside.gt(T::Wide::zero()),
        lanes: lanes & bright.bits(),
    }
}

impl<L: Lane> Lanes<L> {
    /// The mirrored direction; about the geometric normal where the shading normal would send it below the surface.
    #[inline(always)]
    fn mirrored(&self) -> Vec3<L> {
        let smooth = reflect(self.direction, self.shading_normal);
        let above = smooth.dot(self.geometric_normal).gt(L::zero());
        if above.bits() & self.lanes == self.lanes {
            return smooth;
        }
        Vec3::select(above, smooth, reflect(self.direction, self.geometric_normal))
    }

    /// Paths that leave on the side they came from, or on the other.
    #[inline(always)]
    fn leaving(&self, direction: Vec3<L>, weight: Vec3<L>, side: Side) -> PathLanes<L> {
        let normal = if side == Side::Same { self.geometric_normal } else { -self.geometric_normal };
        let which = if side == Side::Same { 0 } else { 1 };
        PathLanes {
            origin: offset_along(self.point, self.error, normal),
            direction,
            throughput: weight,
            slot: self.slot,
            medium: self.media,
            branch: eight(|i| child_branch(self.branch[i], which)),
        }
    }
}

/// Which side of the surface a secondary ray is on, seen from the ray that came.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Same,
    Other,
}

fn mirror<T: Tier>(worker: &mut Worker<T>, s: &Lanes<T::Wide>, next: &mut PathQueue<T::Real>) {
    next.push(&s.leaving(s.mirrored(), s.weight, Side::Same), s.lanes);
    worker.rays.reflected += u64::from(s.lanes.count_ones());
}

/// One reflected and one refracted ray, weighted by Fresnel's formulas; only the first where all is reflected.
fn dielectric<T: Tier>(
    worker: &mut Worker<T>,
    s: &Lanes<T::Wide>,
    (back_queue, through_queue): (&mut PathQueue<T::Real>, &mut PathQueue<T::Real>),
) {
    let scene = worker.frame.scene;
    let least = T::Wide::constant(scene.settings.min_throughput);
    let (near, beyond) = media_around(s);
    let mut through = PathLanes { medium: beyond, ..s.leaving(s.direction, s.weight, Side::Other) };
    let eta = refraction_index::<T>(worker, &through.medium) / refraction_index::<T>(worker, &near);
    let reflectance = fresnel_dielectric(s.direction.dot(s.shading_normal), eta);

    let reflected = s.weight * reflectance;
    let lanes = s.lanes & reflected.max_component().ge(least).bits();
    let back = PathLanes { medium: near, ..s.leaving(s.mirrored(), reflected, Side::Same) };
    back_queue.push(&back, lanes);
    worker.rays.reflected += u64::from(lanes.count_ones());

    let (direction, total) = refract(s.direction, s.shading_normal, eta);
    through.throughput = s.weight * (T::Wide::one() - reflectance);
    // A shading normal may bend the ray back to the side it came from; then it goes straight on.
    let beyond = direction.dot(s.geometric_normal).lt(T::Wide::zero());
    through.direction = Vec3::select(beyond, direction, s.direction);
    let lanes = s.lanes & !total.bits() & through.throughput.max_component().ge(least).bits();
    through_queue.push(&through, lanes);
    worker.rays.refracted += u64::from(lanes.count_ones());
}

/// The dielectrics around the reflected and the refracted rays: one more on the way in, one less on the way out.
#[inline(always)]
fn media_around<L: Lane>(s: &Lanes<L>) -> ([Media; WIDTH], [Media; WIDTH]) {
    let inside = s.from_inside.bits();
    let around = |i: usize| match (s.media[i], s.bodies[i]) {
        (state, body) if inside >> i & 1 != 0 => (found_inside(state, body), leave(state, body)),
        (state, body) => (state, enter(state, body)),
    };
    // Neighbours mostly come through the same: then one of them tells of all.
    let are_alike = s.media == [s.media[0]; WIDTH] && s.bodies == [s.bodies[0]; WIDTH];
    if are_alike && (inside == 0 || inside == L::Mask::splat(true).bits()) {
        let (near, beyond) = around(0);
        return ([near; WIDTH], [beyond; WIDTH]);
    }
    let each = eight(around);
    (eight(|i| each[i].0), eight(|i| each[i].1))
}

/// Index of refraction of the innermost dielectric; 1 outside of all.
#[inline(always)]
fn refraction_index<T: Tier>(worker: &Worker<T>, states: &[Media; WIDTH]) -> T::Wide {
    let scene = worker.frame.scene;
    let index = |i: usize| {
        let index = match innermost(states[i]) {
            NO_BODY => 1.0,
            body => scene.materials.ior[material_of_body(&scene.geometry, body) as usize],
        };
        <T::Real as crate::math::Real>::from_f32(index)
    };
    let innermost = eight(|i| innermost(states[i]));
    if innermost == [innermost[0]; WIDTH] { T::Wide::splat(index(0)) } else { T::Wide::from_fn(index) }
}

/// One ray into the hemisphere, by the cosine: the density cancels the cosine and pi of the diffuse lobe.
fn diffuse<T: Tier>(
    worker: &mut Worker<T>,
    s: &Lanes<T::Wide>,
    wave: WaveSamples,
    depth: u32,
    next: &mut PathQueue<T::Real>,
) {
    let samples = eight(|i| wave.of_slot(s.slot[i]));
    let (u, v) = worker.frame.sampler.pair::<T::Wide>(
        BitLane::from_fn(|i| samples[i].0[0]),
        BitLane::from_fn(|i| samples[i].0[1]),
        BitLane::from_fn(|i| samples[i].1),
        bounce(ScatterDraw::Direction, depth, wide::u32x8::new(s.branch)),
    );
    let direction = to_frame(cosine_hemisphere(u, v), s.shading_normal);
    // Below the surface (interpolated normals only) nothing is seen.
    let lanes = s.lanes & direction.dot(s.geometric_normal).gt(T::Wide::zero()).bits();
    next.push(&s.leaving(direction, s.weight, Side::Same), lanes);
    worker.rays.diffuse += u64::from(lanes.count_ones());
}
