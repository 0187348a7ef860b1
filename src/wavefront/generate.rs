//! Camera rays for the samples of a wave.

use super::arena::{Room, padded};
use super::medium::OUTSIDE;
use super::queue::{PathNeeds, PathQueue};
use super::wave::{Frame, WaveSamples};
use crate::intersect::Tier;
use crate::math::{BitLane, Lane, Vec3, WIDTH, eight};
use crate::sampling::{FILTER, LENS};

type Bits = wide::u32x8;

/// A queue with one path for each slot, in slot order, and the weights of the samples where the filter gives any.
pub(super) fn generate<'a, T: Tier>(
    frame: &Frame,
    wave: WaveSamples,
    room: &Room<'a>,
) -> (PathQueue<'a, T::Real>, &'a mut [T::Real]) {
    let n = wave.len();
    let mut queue = PathQueue::new(room, n, frame.path_needs());
    let weights = room.column(if frame.scene.requirements.sample_weights { n } else { 0 });
    for at in (0..padded(n)).step_by(WIDTH) {
        let (rays, weight) = camera_rays::<T>(frame, wave, at);
        queue.origin.store(at, rays.origin);
        queue.direction.store(at, rays.direction);
        if !queue.t_min.is_empty() {
            rays.t_min.store(&mut queue.t_min[at..]);
        }
        queue.throughput.store(at, Vec3::<T::Wide>::splat_f32([1.0; 3]));
        if !weights.is_empty() {
            weight.store(&mut weights[at..]);
        }
    }
    for (slot, entry) in queue.slot.iter_mut().enumerate() {
        *entry = slot as u32;
    }
    queue.medium.fill(OUTSIDE);
    queue.branch.fill(0);
    queue.len = n;
    (queue, weights)
}

/// Eight slots from `at` on; slots beyond the wave repeat its last.
#[inline(always)]
fn camera_rays<T: Tier>(
    frame: &Frame,
    wave: WaveSamples,
    at: usize,
) -> (crate::scene::CameraRays<T::Wide>, T::Wide) {
    let [x, y, sample] = wave.eight_slots(at);
    let draw = |dimension| frame.sampler.pair::<T::Wide>(x, y, sample, BitLane::splat(dimension));
    let (u, v) = draw(FILTER);
    let (dx, dy, weight) = frame.filter.sample(u, v);
    (frame.scene.camera.rays(on_film::<T>(frame, (x, y), (dx, dy)), || draw(LENS)), weight)
}

/// Places of the film at offsets from the centres of pixels.
#[inline(always)]
fn on_film<T: Tier>(frame: &Frame, (x, y): (Bits, Bits), (dx, dy): (T::Wide, T::Wide)) -> (T::Wide, T::Wide) {
    let [width, height] = frame.scene.settings.size.map(f64::from);
    let half = T::Wide::constant(0.5);
    let place = |pixel: Bits, offset: T::Wide, size: f64| {
        let step = T::Wide::constant(2.0 / size);
        (T::Wide::from_bits(pixel) + half + offset) * step - T::Wide::one()
    };
    (place(x, dx, width), -place(y, dy, height))
}

/// A queue with one path for each pixel, through its centre and that of the lens.
pub(super) fn generate_centres<'a, T: Tier>(
    frame: &Frame,
    pixels: &[[u32; 2]],
    room: &Room<'a>,
) -> PathQueue<'a, T::Real> {
    let mut queue =
        PathQueue::new(room, pixels.len(), PathNeeds { medium: false, branch: false, ..frame.path_needs() });
    let zero = T::Wide::zero();
    for at in (0..pixels.len()).step_by(WIDTH) {
        let pixel = |i: usize| pixels[(at + i).min(pixels.len() - 1)];
        let (x, y) = (Bits::new(eight(|i| pixel(i)[0])), Bits::new(eight(|i| pixel(i)[1])));
        let film = on_film::<T>(frame, (x, y), (zero, zero));
        let rays = frame.scene.camera.rays(film, || (zero, zero));
        queue.origin.store(at, rays.origin);
        queue.direction.store(at, rays.direction);
        if !queue.t_min.is_empty() {
            rays.t_min.store(&mut queue.t_min[at..]);
        }
    }
    queue.len = pixels.len();
    queue
}
