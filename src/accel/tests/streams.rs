//! Streams of rays against the plain loop, whatever they are told that the rays have in common.

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

use super::QUALITIES;
use super::scenes::{World, world};
use super::{Bits, bits, lanes, plainly, rays};
use crate::accel::build::Quality;
use crate::accel::stream::{Apex, Bound, HitColumns, RayColumns, RayStream};
use crate::accel::{Accel, Hint};
use crate::geometry::{Geometry, Group};
use crate::intersect::testing::dice::Dice;
use crate::intersect::{Exact, Fast, Ray, RayLanes, Tier, Watertight};
use crate::math::{Lane, WIDTH};

/// Rays of a tier by columns, padded.
#[derive(Default)]
struct Columns<R> {
    origin: [Vec<R>; 3],
    direction: [Vec<R>; 3],
    t: [Vec<R>; 2],
    rays: Vec<RayLanes<R>>,
}

impl<R: crate::math::Real> Columns<R> {
    /// Eight at a time, as the ray scene makes lanes of them: unusable rays are turned off.
    fn of<T: Tier<Real = R>>(asked: &[Ray]) -> Self {
        let mut columns = Self::default();
        for packet in asked.chunks(WIDTH) {
            let Some(lanes) = lanes::<T>(packet) else { continue };
            for i in 0..WIDTH {
                columns.push(lanes.get(i));
            }
        }
        columns
    }

    fn push(&mut self, ray: RayLanes<R>) {
        let (o, d) = (ray.origin.get(0), ray.direction.get(0));
        for k in 0..3 {
            self.origin[k].push(o[k]);
            self.direction[k].push(d[k]);
        }
        self.t[0].push(ray.t_min);
        self.t[1].push(ray.t_max);
        self.rays.push(ray);
    }

    fn columns(&self, len: usize) -> RayColumns<'_, R> {
        RayColumns {
            len,
            origin: self.origin.each_ref().map(|c| &c[..]),
            direction: self.direction.each_ref().map(|c| &c[..]),
            t_min: Bound::Each(&self.t[0]),
            t_max: Bound::Each(&self.t[1]),
        }
    }
}

/// What a stream finds for the first `len` rays, and whether it finds anything.
fn found<T: Tier>(
    stream: &mut RayStream<T>,
    rays: &Columns<T::Real>,
    len: usize,
    (apex, hint): (Option<Apex>, Hint),
) -> (Vec<Option<Bits>>, Vec<bool>) {
    let (columns, n) = (rays.columns(len), rays.rays.len());
    let real = || vec![<T::Real as Lane>::constant(-1.0); n];
    let (mut t, mut u, mut v) = (real(), real(), real());
    let (mut prim, mut instance, mut occluded) = (vec![0; n], vec![0; n], vec![0xaa; n / WIDTH]);
    let mut hits = HitColumns { t: &mut t, u: &mut u, v: &mut v, prim: &mut prim, instance: &mut instance };
    stream.closest(&columns, apex, hint, &mut hits);
    stream.any(&columns, apex, hint, &mut occluded);
    let hit = |i: usize| (bits(t[i]), bits(u[i]), bits(v[i]), prim[i], instance[i]);
    let hits = (0..len).map(|i| (t[i] < rays.rays[i].t_max).then(|| hit(i))).collect();
    (hits, (0..len).map(|i| occluded[i / WIDTH] >> (i % WIDTH) & 1 != 0).collect())
}

/// Asks in every way; gives how many rays hit.
fn check<T: Tier>(geometry: &Geometry, accel: &Accel, asked: &[Ray], apex: Option<Apex>) -> usize {
    let rays = Columns::<T::Real>::of::<T>(asked);
    let expected: Vec<_> = rays.rays.iter().map(|ray| plainly::<T>(geometry, ray)).collect();
    let mut stream = RayStream::<T>::new(accel);
    for len in [rays.rays.len(), rays.rays.len().saturating_sub(3)] {
        for hint in [Hint::Auto, Hint::Coherent, Hint::Incoherent] {
            let (hits, any) = found(&mut stream, &rays, len, (apex, hint));
            assert_eq!(hits, expected[..len], "{:?} {hint:?} {apex:?}", T::NAME);
            assert!(any.iter().zip(&hits).all(|(any, hit)| *any == hit.is_some()), "any, {hint:?} {apex:?}");
        }
    }
    expected.iter().flatten().count()
}

/// Rays with a common origin or target, or from behind one, or parallel, near each other more often than not, and many of them through landmarks.
fn with_apex(landmarks: &[[f32; 3]], dice: &mut Dice, count: usize) -> (Vec<Ray>, Apex) {
    let near = |at: [f32; 3], by: f64, dice: &mut Dice| -> [f32; 3] {
        let offset = dice.point();
        std::array::from_fn(|k| at[k] + (by * offset[k]) as f32)
    };
    let pick = |dice: &mut Dice| match landmarks.len() {
        0 => dice.point().map(|x| x as f32),
        n => landmarks[dice.below(n)],
    };
    let apex = match dice.below(3) {
        0 => pick(dice),
        1 => dice.point().map(|x| x as f32 * 1e3),
        _ => dice.point().map(|x| x as f32 * 8.0),
    };
    let (middle, spread) = (pick(dice), [0.0, 0.05, 0.5, 3.0][dice.below(4)]);
    let (kind, stray) = (dice.below(4), [0.0, 1e-5, 1e-3][dice.below(3)]);
    let (is_target, is_behind, is_parallel) = (kind == 1, kind == 2, kind == 3);
    let way = std::array::from_fn(|k| middle[k] - apex[k]);
    let ray = |dice: &mut Dice| {
        let end = if dice.below(4) == 0 { pick(dice) } else { near(middle, spread, dice) };
        let (from, to) = if is_target { (end, apex) } else { (apex, end) };
        let towards = match is_parallel {
            true => Ray::new(end, way),
            false => Ray::new(from, std::array::from_fn(|k| to[k] - from[k])),
        };
        let towards = if is_behind {
            started(&towards, dice.between(0.4, 0.6), near(from, stray, dice))
        } else {
            towards
        };
        match dice.below(12) {
            0 => Ray { t_min: dice.between(-0.5, 0.5) as f32, ..towards },
            1 => Ray { t_max: dice.between(0.0, 1.0) as f32, ..towards },
            2 => Ray { t_max: f32::NEG_INFINITY, ..towards },
            _ if is_target => Ray { t_max: 1.0, ..towards },
            _ => towards,
        }
    };
    let rays = (0..count).map(|_| ray(dice)).collect();
    (rays, [Apex::Origin(apex), Apex::Target(apex), Apex::Behind(apex), Apex::Parallel][kind])
}

/// The ray so far on its way, had it come from elsewhere.
fn started(ray: &Ray, way: f64, from: [f32; 3]) -> Ray {
    Ray { origin: std::array::from_fn(|k| from[k] + (way * f64::from(ray.direction[k])) as f32), ..*ray }
}

fn check_world<T: Tier>(world: &World, seed: u64) -> usize {
    QUALITIES.map(|quality| check_tree::<T>(world, quality, seed)).into_iter().sum()
}

pub(super) fn check_tree<T: Tier>(world: &World, quality: Quality, seed: u64) -> usize {
    let (geometry, dice) = (world.geometry(), &mut Dice(seed));
    let accel = Accel::build_with(&geometry, quality);
    let mut hits = check::<T>(&geometry, &accel, &rays::around(&world.landmarks(), dice, 200), None);
    // A small bundle, a large one that is not full, one that is.
    for count in [64, 136, 136, 264] {
        let (rays, apex) = with_apex(&world.landmarks(), dice, count);
        hits += check::<T>(&geometry, &accel, &rays, Some(apex));
        hits += check::<T>(&geometry, &accel, &rays, None);
        hits += check::<T>(&geometry, &accel, &rays::short(&world.landmarks(), dice, 136), None);
    }
    hits
}

/// In `Fast` a tree may cull what the plain loop lets through ([`super`] says what): where both see the same primitive, they
/// see the same bits, whichever way a stream takes. Gives how many differ, and how many were asked.
fn differing_in_fast(geometry: &Geometry, asked: &[Ray], apex: Option<Apex>) -> (usize, usize) {
    let (accel, rays) = (Accel::build(geometry), Columns::of::<Fast>(asked));
    let expected: Vec<_> = rays.rays.iter().map(|ray| plainly::<Fast>(geometry, ray)).collect();
    let mut stream = RayStream::<Fast>::new(&accel);
    let (mut differing, mut count) = (0, 0);
    for hint in [Hint::Auto, Hint::Coherent, Hint::Incoherent] {
        let (hits, any) = found(&mut stream, &rays, expected.len(), (apex, hint));
        for ((hit, expected), any) in hits.iter().zip(&expected).zip(any) {
            let which = |hit: &Option<Bits>| hit.map(|hit| (hit.3, hit.4));
            let same = which(hit) == which(expected) && any == hit.is_some();
            assert!(!same || hit == expected, "{hint:?} {apex:?}: {hit:?}, one ray {expected:?}");
            differing += usize::from(!same);
        }
        count += expected.iter().flatten().count();
    }
    (differing, count)
}

#[test]
fn fast_streams_equal_brute_force_but_for_what_culling_loses() {
    let mut runner = TestRunner::deterministic();
    let (mut differing, mut hits) = (0, 0);
    for seed in 0..60 {
        let world = world(200).new_tree(&mut runner).unwrap().current();
        let (geometry, landmarks, dice) = (world.geometry(), world.landmarks(), &mut Dice(seed));
        let mut sum = |rays: &[Ray], apex| {
            let (d, n) = differing_in_fast(&geometry, rays, apex);
            (differing, hits) = (differing + d, hits + n);
        };
        sum(&rays::around(&landmarks, dice, 256), None);
        for count in [64, 192] {
            let (rays, apex) = with_apex(&landmarks, dice, count);
            sum(&rays, Some(apex));
            sum(&rays, None);
        }
    }
    assert!(hits > 30_000 && differing * 5_000 < hits, "{differing} of {hits} differ");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(160))]

    #[test]
    fn watertight_streams_equal_brute_force(world in world(200), seed: u64) {
        check_world::<Watertight>(&world, seed);
    }

    #[test]
    fn exact_streams_equal_brute_force(world in world(200), seed: u64) {
        check_world::<Exact>(&world, seed);
    }
}

/// Small triangles anywhere between -1 and 1.
fn small_triangles(count: usize, dice: &mut Dice) -> Geometry {
    let mut geometry = Geometry::default();
    let t = &mut geometry.triangles;
    for i in 0..count {
        let middle = dice.point();
        for (corner, vertices) in t.vertex.iter_mut().enumerate() {
            vertices.push(3 * i as u32 + corner as u32);
            let aside = dice.point();
            (0..3).for_each(|k| t.position[k].push((middle[k] + 0.05 * aside[k]) as f32));
        }
        t.material.push(0);
    }
    geometry.groups = vec![Group { triangles: 0..count, spheres: 0..0, cylinders: 0..0 }];
    geometry
}

/// Bundles that meet so much that they are given up, and neighbours that are not tried: their rays enter the tree elsewhere.
#[test]
fn rays_far_apart_for_what_they_meet_lose_no_hit() {
    let dice = &mut Dice(17);
    let geometry = small_triangles(3_000, dice);
    let (accel, mut hits) = (Accel::build(&geometry), 0);
    for _ in 0..24 {
        let landmarks = [dice.point().map(|x| x as f32), dice.point().map(|x| x as f32)];
        let (rays, apex) = with_apex(&landmarks, dice, 1024);
        hits += check::<Watertight>(&geometry, &accel, &rays, Some(apex));
        hits += check::<Watertight>(&geometry, &accel, &rays, None);
    }
    assert!(hits > 5_000, "{hits}");
}

/// What three mirrors throw back, in any order, with rays among it that go anywhere or are not asked.
#[test]
fn beams_in_any_order_lose_no_hit() {
    let dice = &mut Dice(18);
    let geometry = small_triangles(1_500, dice);
    let (accel, mut hits) = (Accel::build(&geometry), 0);
    for round in 0..12 {
        let point = |dice: &mut Dice| dice.point().map(|x| x as f32);
        let mirrors: [_; 3] = std::array::from_fn(|_| (point(dice).map(|x| 4.0 * x), point(dice)));
        let rays: Vec<Ray> = (0..1_000)
            .map(|_| {
                let (apex, middle) = mirrors[dice.below(3)];
                let aside = point(dice);
                let back = Ray::new(apex, std::array::from_fn(|k| middle[k] + 0.03 * aside[k] - apex[k]));
                match dice.below(12) {
                    0 => Ray::new(middle, dice.heading().map(|x| x as f32)),
                    1 => Ray { t_max: f32::NEG_INFINITY, ..back },
                    _ => started(&back, dice.between(0.4, 0.6), apex),
                }
            })
            .collect();
        hits += check::<Watertight>(&geometry, &accel, &rays, None);
        if round < 2 {
            hits += check::<Exact>(&geometry, &accel, &rays, None);
        }
    }
    assert!(hits > 2_000, "{hits}");
}
