//! Paths followed by one ray each, refracted wherever they can be: what `verify` judges, through the stages that render.

use super::arena::{Arena, Room};
use super::extend::extend;
use super::medium::{Media, NO_BODY, OUTSIDE, row_of};
use super::queue::{Column3, PathLanes, PathQueue};
use super::scatter::scatter;
use super::surface_queue::SurfaceQueue;
use super::wave::{Frame, RayCounts, WaveSamples, Worker};
use crate::accel::stream::RayStream;
use crate::film::SampleSums;
use crate::intersect::Tier;
use crate::math::{Lane, Real, Vec3, WIDTH};
use crate::scene::Scene;

/// What a path came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Step {
    /// Nothing more is met, or nothing comes of it.
    Out,
    /// A body of glass, by the row of a sphere or of what else its material, seen from inside or not; all of the light is
    /// reflected, or the path goes through.
    Body { row: usize, from_inside: bool, total: bool },
    /// A surface that is passed as if it were not there.
    Passed,
}

/// A path between two steps.
#[derive(Clone, Copy)]
struct Walker<R> {
    number: usize,
    origin: [R; 3],
    direction: [R; 3],
    medium: Media,
}

/// Follows paths, given by origins and unit directions, for so many steps; `goes_on` hears of each step by the path's number.
///
/// **Needs:** a scene with dielectrics in which no throughput is too small.
pub(crate) fn walk<T: Tier>(
    scene: &Scene,
    paths: &[[Vec3<T::Real>; 2]],
    steps: usize,
    mut goes_on: impl FnMut(usize, Step) -> bool,
) {
    let frame = Frame::new(scene);
    let stream = RayStream::new(&scene.accel);
    let (radiance, rays) = (SampleSums::default(), RayCounts::default());
    let mut worker = Worker::<T> { frame: &frame, stream, radiance, rays };
    let start = |(number, [origin, direction]): (usize, &[Vec3<T::Real>; 2])| Walker {
        number,
        origin: origin.get(0),
        direction: direction.get(0),
        medium: OUTSIDE,
    };
    let mut walkers: Vec<_> = paths.iter().enumerate().map(start).collect();
    let mut arena = Arena::default();
    for _ in 0..steps {
        walkers = step(&mut worker, &walkers, &arena.open(), &mut goes_on);
    }
}

/// One step of all paths; gives those that go on.
fn step<T: Tier>(
    worker: &mut Worker<T>,
    walkers: &[Walker<T::Real>],
    room: &Room,
    goes_on: &mut impl FnMut(usize, Step) -> bool,
) -> Vec<Walker<T::Real>> {
    let (scene, needs) = (worker.frame.scene, worker.frame.path_needs());
    let mut queue = PathQueue::new(room, walkers.len() + WIDTH, needs);
    for (slot, walker) in walkers.iter().enumerate() {
        queue.push(&lanes_of::<T>(walker, slot), 1);
    }
    let hits = extend(worker, &queue, (0, queue.len), None, room);
    for &row in hits.misses.iter() {
        goes_on(walkers[row as usize].number, Step::Out);
    }
    let surfaces = SurfaceQueue::evaluate::<T::Wide>(scene, &queue, 0, &hits, room);
    let mut next = PathQueue::new(room, 2 * surfaces.len + WIDTH, needs);
    let wave = WaveSamples { pixels: &[[0; 2]], first_sample: 0, samples: walkers.len() as u32 };
    scatter(worker, wave, 0, &queue, &surfaces, &mut next, room);
    let following = |row: usize| follow(walkers, &surfaces, row, &next, goes_on);
    (0..surfaces.len).filter_map(following).collect()
}

/// The path that goes on from a surface: the refracted ray comes after the reflected one, and is not there where all is
/// reflected.
fn follow<R: Real>(
    walkers: &[Walker<R>],
    surfaces: &SurfaceQueue<R>,
    row: usize,
    next: &PathQueue<R>,
    goes_on: &mut impl FnMut(usize, Step) -> bool,
) -> Option<Walker<R>> {
    let slot = surfaces.slot(row);
    let number = walkers[slot as usize].number;
    let mut rays = (0..next.len).filter(|&ray| next.slot[ray] == slot);
    let (first, second) = (rays.next(), rays.next());
    let met = match (surfaces.body[row], first) {
        (_, None) => Step::Out,
        (NO_BODY, _) => Step::Passed,
        (body, _) => Step::Body {
            row: row_of(body) as usize,
            from_inside: surfaces.from_inside[row] != 0,
            total: second.is_none(),
        },
    };
    let allowed = goes_on(number, met);
    second.or(first).filter(|_| allowed).map(|ray| walker_of(next, ray, number))
}

fn lanes_of<T: Tier>(walker: &Walker<T::Real>, slot: usize) -> PathLanes<T::Wide> {
    PathLanes {
        origin: Vec3::splat(walker.origin),
        direction: Vec3::splat(walker.direction),
        throughput: Vec3::splat([T::Real::one(); 3]),
        slot: [slot as u32; WIDTH],
        medium: [walker.medium; WIDTH],
        branch: [0; WIDTH],
    }
}

fn walker_of<R: Real>(queue: &PathQueue<R>, row: usize, number: usize) -> Walker<R> {
    let of = |column: &Column3<R>| column.rows_from(row).map(|axis| axis[0]);
    let (origin, direction) = (of(&queue.origin), of(&queue.direction));
    Walker { number, origin, direction, medium: queue.medium[row] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::intersect::{Exact, Watertight};

    /// Which spheres a ray along x meets, and from inside or not.
    fn met<T: Tier>(second_center: f64) -> Vec<(usize, bool)> {
        let text = format!(
            "[camera]\nposition = [0, 0, -9]\nlook_at = [0, 0, 0]\n[render]\nmin_throughput = 0\n\
             [[material]]\nname = 'glass'\nkind = 'dielectric'\n\
             [[sphere]]\ncenter = [{second_center:?}, 0, 0]\nradius = 1\nmaterial = 'glass'\n\
             [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'glass'\n"
        );
        let scene = Scene::compile(&crate::describe::parse(&text, "test").unwrap()).unwrap();
        let path =
            [[-5.0, 0.0, 0.0], [1.0, 0.0, 0.0]].map(|v: [f64; 3]| Vec3::splat(v.map(T::Real::from_f64)));
        let mut steps = Vec::new();
        walk::<T>(&scene, &[path], 8, |_, step| {
            if let Step::Body { row, from_inside, .. } = step {
                steps.push((row, from_inside));
            }
            true
        });
        steps
    }

    /// A sheet seen from inside the glass, nearly along it, with normals that lean towards the ray: refracted about them it
    /// would come back to the side that it is said to have left.
    #[test]
    fn a_sheet_whose_normals_bend_light_back_is_passed_once() {
        let text = "[camera]\nposition = [0, 0, 9]\nlook_at = [0, 0, 0]\n[render]\nmin_throughput = 0\n\
             [[material]]\nname = 'glass'\nkind = 'dielectric'\n\
             [[mesh]]\nmaterial = 'glass'\nfaces = [[0, 1, 2]]\n\
             vertices = [[-9, -9, 0], [0, 9, 0], [9, -9, 0]]\n";
        let mut scene = Scene::compile(&crate::describe::parse(text, "test").unwrap()).unwrap();
        let lean = [0.75f32.sqrt(), 0.0, -0.5];
        std::sync::Arc::make_mut(&mut scene.geometry).triangles.normal = lean.map(|x| vec![x; 3]);
        scene.requirements.shading_normals = true;
        let mut steps = Vec::new();
        let path = [[-5.0, 0.0, 0.5], [0.99f64.sqrt() as f32, 0.0, -0.1]].map(Vec3::splat);
        walk::<Watertight>(&scene, &[path], 3, |_, step| {
            steps.push(step);
            true
        });
        assert_eq!(steps, [Step::Body { row: 0, from_inside: true, total: false }, Step::Out]);
    }

    const ONE_AFTER_THE_OTHER: [(usize, bool); 4] = [(1, false), (1, true), (0, false), (0, true)];

    #[test]
    fn spheres_that_touch_are_met_one_after_the_other() {
        assert_eq!(met::<Watertight>(2.0), ONE_AFTER_THE_OTHER);
        assert_eq!(met::<Exact>(2.0), ONE_AFTER_THE_OTHER);
    }

    /// What rounding alone may have put into each other; in `exact` that is an overlap like any other.
    #[test]
    fn spheres_that_overlap_by_a_roundoff_are_met_one_after_the_other() {
        let center = f64::from(2.0f32.next_down());
        assert_eq!(met::<Watertight>(center), ONE_AFTER_THE_OTHER);
        assert_eq!(met::<Exact>(center), [(1, false), (0, false), (1, true), (0, true)]);
        assert_eq!(met::<Watertight>(1.5), [(1, false), (0, false), (1, true), (0, true)]);
    }
}
