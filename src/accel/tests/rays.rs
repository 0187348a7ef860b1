//! Rays that make traversals err: along axes, in planes, from surfaces, through corners.

use crate::intersect::Ray;
use crate::intersect::testing::dice::Dice;

/// Rays around the points that matter in a scene; packets of eight are now alike, now not.
pub(in crate::accel) fn around(landmarks: &[[f32; 3]], dice: &mut Dice, count: usize) -> Vec<Ray> {
    let mut rays = Vec::with_capacity(count);
    while rays.len() < count {
        let first = one(landmarks, dice);
        let alike = dice.below(2) == 0;
        for _ in 0..8 {
            rays.push(if alike { neighbour(&first, dice) } else { one(landmarks, dice) });
        }
    }
    rays
}

/// Rays from around a landmark that go anywhere, but not far.
pub(super) fn short(landmarks: &[[f32; 3]], dice: &mut Dice, count: usize) -> Vec<Ray> {
    let (middle, spread) = (landmark(landmarks, dice), [0.0, 1e-3, 0.1, 1.0][dice.below(4)]);
    let far = [1e-3, 0.05, 0.5, 4.0][dice.below(4)];
    let ray = |dice: &mut Dice| {
        let aside = dice.point();
        let origin = std::array::from_fn(|k| middle[k] + (spread * aside[k]) as f32);
        let (direction, t_max) = (dice.heading().map(|x| x as f32), (far * dice.between(0.5, 1.0)) as f32);
        let ray = Ray { t_max, ..Ray::new(origin, direction) };
        match dice.below(16) {
            0 => Ray { t_max: f32::NEG_INFINITY, ..ray },
            1 => towards(origin, landmark(landmarks, dice)),
            _ => ray,
        }
    };
    (0..count).map(|_| ray(dice)).collect()
}

fn one(landmarks: &[[f32; 3]], dice: &mut Dice) -> Ray {
    let origin = match dice.below(3) {
        0 => landmark(landmarks, dice),
        _ => anywhere(dice),
    };
    let target = match dice.below(4) {
        0 => anywhere(dice),
        1 => between(landmark(landmarks, dice), landmark(landmarks, dice), dice),
        _ => landmark(landmarks, dice),
    };
    let mut ray = towards(origin, target);
    match dice.below(6) {
        0 => along_axis(&mut ray, target, dice),
        1 => ray.direction = ray.direction.map(|d| d * dice.magnitude(-9.0, 9.0).abs() as f32),
        2 => ray.t_max = dice.between(0.0, 1.5) as f32,
        3 => ray.t_min = dice.between(-2.0, 1.0) as f32,
        _ => {}
    }
    ray
}

fn towards(origin: [f32; 3], target: [f32; 3]) -> Ray {
    Ray::new(origin, std::array::from_fn(|k| target[k] - origin[k]))
}

/// From far away past a point between landmarks.
pub(super) fn from_far_out(landmarks: &[[f32; 3]], dice: &mut Dice, away: f64, stray: f64) -> Ray {
    let past = between(landmark(landmarks, dice), landmark(landmarks, dice), dice);
    let aside = dice.point();
    let target = std::array::from_fn(|k| past[k] + (stray * aside[k]) as f32);
    towards(dice.heading().map(|x| (away * x) as f32), target)
}

fn anywhere(dice: &mut Dice) -> [f32; 3] {
    match dice.below(8) {
        0 => dice.point().map(|x| x as f32 * 1e4),
        1 => std::array::from_fn(|_| dice.hard()),
        _ => dice.point().map(|x| x as f32 * 6.0),
    }
}

fn landmark(landmarks: &[[f32; 3]], dice: &mut Dice) -> [f32; 3] {
    if landmarks.is_empty() { anywhere(dice) } else { landmarks[dice.below(landmarks.len())] }
}

fn between(a: [f32; 3], b: [f32; 3], dice: &mut Dice) -> [f32; 3] {
    let share = dice.unit() as f32;
    std::array::from_fn(|k| a[k] + share * (b[k] - a[k]))
}

/// Towards the target along one axis, or in a plane of two; zeros of either sign elsewhere.
fn along_axis(ray: &mut Ray, target: [f32; 3], dice: &mut Dice) {
    for k in 0..=dice.below(2) {
        let k = (k + dice.below(3)) % 3;
        ray.origin[k] = target[k];
        ray.direction[k] = [0.0, -0.0][dice.below(2)];
    }
}

/// The same ray, a little turned or moved; often in the same octant.
fn neighbour(ray: &Ray, dice: &mut Dice) -> Ray {
    let by = [0.0, 1e-7, 0.01, 0.2][dice.below(4)];
    let (a, b) = (dice.point(), dice.point());
    Ray {
        origin: std::array::from_fn(|k| ray.origin[k] + by * a[k] as f32),
        direction: std::array::from_fn(|k| ray.direction[k] * (1.0 + by * b[k] as f32)),
        ..*ray
    }
}
