//! Camera rays for the samples of a wave.

use bumpalo::Bump;

use super::medium::OUTSIDE;
use super::queue::{PathQueue, padded};
use super::wave::{Frame, WaveSamples};
use crate::intersect::Tier;
use crate::math::{BitLane, Lane, Vec3, WIDTH, eight};
use crate::sampling::{FILTER, LENS};

/// A queue with one path for each slot, in slot order, and the weights of the samples where the filter gives any.
pub(super) fn generate<'a, T: Tier>(
    frame: &Frame,
    wave: WaveSamples,
    arena: &'a Bump,
) -> (PathQueue<'a, T::Real>, &'a mut [T::Real]) {
    let n = wave.len();
    let mut queue = PathQueue::new(arena, n, frame.path_needs());
    let weights = super::queue::column(arena, if frame.scene.requirements.sample_weights { n } else { 0 });
    for at in (0..padded(n)).step_by(WIDTH) {
        let (rays, weight) = camera_rays::<T>(frame, wave, at);
        queue.origin.store(at, rays.origin);
        queue.direction.store(at, rays.direction);
        rays.t_min.store(&mut queue.t_min[at..]);
        queue.throughput.store(at, Vec3::<T::Wide>::splat_f32([1.0; 3]));
        if !weights.is_empty() {
            weight.store(&mut weights[at..]);
        }
    }
    for (slot, entry) in queue.slot.iter_mut().enumerate() {
        *entry = slot as u32;
    }
    queue.medium.fill(OUTSIDE);
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
    type Bits = wide::u32x8;
    let slots = wave.eight_slots(at);
    let (x, y) = (Bits::new(eight(|i| slots[i].0[0])), Bits::new(eight(|i| slots[i].0[1])));
    let sample = Bits::new(eight(|i| slots[i].1));
    let draw = |dimension| frame.sampler.pair::<T::Wide>(x, y, sample, BitLane::splat(dimension));
    let (u, v) = draw(FILTER);
    let (dx, dy, weight) = frame.filter.sample(u, v);
    let [width, height] = frame.scene.settings.size.map(f64::from);
    let half = T::Wide::constant(0.5);
    let place = |pixel: Bits, offset: T::Wide, size: f64| {
        let step = T::Wide::constant(2.0 / size);
        (T::Wide::from_bits(pixel) + half + offset) * step - T::Wide::one()
    };
    let film = (place(x, dx, width), -place(y, dy, height));
    (frame.scene.camera.rays(film, || draw(LENS)), weight)
}
