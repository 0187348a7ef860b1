//! Paths through spheres of glass, walked by the stages that render them: each step has to be one that glass allows.

use super::aim::{across, add, rounded};
use super::paths::{PATHS, vector};
use crate::describe::{Camera, Material, MaterialKind, SceneDescription, Sphere};
use crate::intersect::Tier;
use crate::intersect::testing::dice::Dice;
use crate::math::Vec3;
use crate::measure::verify::tally::{Fault, Tally};
use crate::scene::Scene;
use crate::wavefront::{Step, walk};

/// Interfaces that a path through glass meets at most.
const INTERFACES: usize = 20;

/// Where a path went: which sphere, whether from inside, and whether all was reflected.
#[derive(Clone, Copy)]
struct Met {
    row: usize,
    inside: bool,
    total: bool,
}

/// Spheres of glass along an axis.
struct Glass {
    scene: Scene,
    center: [f64; 3],
    axis: [f64; 3],
}

impl Glass {
    /// On a grid, so that touching spheres do not overlap by rounding; up to `far` from the origin.
    fn new(dice: &mut Dice, far: f64, spheres: impl Fn(usize) -> (f64, f64)) -> Self {
        let far = [0.0, 0.1 * far, far][dice.below(3)];
        let center: [f64; 3] = dice.point().map(|x| (x * far).round());
        let mut axis = [0.0; 3];
        axis[dice.below(3)] = [1.0, -1.0][dice.below(2)];
        let ior = [1.5, 1.33, 2.4, 1.0001, 1.0 + f64::from(f32::EPSILON)][dice.below(5)];
        let sphere = |number| {
            let (along, radius) = spheres(number);
            let center = rounded(add(center, axis, along)).map(f64::from);
            Sphere { center, radius, material: Some("glass".into()), transform: Default::default() }
        };
        let sphere = (0..INTERFACES / 2).map(sphere).collect();
        let glass = Material { ior, ..Material::new("glass", MaterialKind::Dielectric) };
        let camera = Camera::perspective([0.0; 3], [0.0, 0.0, -1.0], 45.0);
        let mut description =
            SceneDescription { sphere, material: vec![glass], ..SceneDescription::new(camera) };
        description.render.min_throughput = 0.0;
        let scene = Scene::compile(&description).expect("spheres of glass");
        Self { scene, center, axis }
    }

    /// Follows paths as far as they go; each has a judge of its own, who says whether a step is allowed, and, given no step,
    /// whether there may be nothing more.
    fn follow<T: Tier, J: FnMut(Option<Met>) -> bool>(
        &self,
        dice: &mut Dice,
        tally: &mut Tally,
        (start, spread): (f64, f64),
        judge: impl Fn() -> J,
    ) {
        let origin = add(self.center, self.axis, start);
        let mut path = || {
            let target = add(self.center, across(dice, self.axis), spread * dice.unit());
            [vector::<T::Real>(origin), vector::<T::Real>(add(target, origin, -1.0)).normalize()]
        };
        let paths: Vec<[Vec3<T::Real>; 2]> = (0..PATHS).map(|_| path()).collect();
        let mut judges: Vec<J> = paths.iter().map(|_| judge()).collect();
        let mut told = 0;
        tally.rays += PATHS;
        walk::<T>(&self.scene, &paths, INTERFACES, |number, step| {
            let right = match step {
                Step::Out => judges[number](None),
                Step::Sphere { row, from_inside, total } => {
                    judges[number](Some(Met { row, inside: from_inside, total }))
                }
                Step::Passed => true,
            };
            if !right {
                told += 1;
                tally.add(Fault::SelfHit, || {
                    let spheres = &self.scene.geometry.spheres;
                    format!("{:?} among {spheres:?} comes to {step:?}", paths[number])
                });
            }
            right
        });
        tally.hits += PATHS - told;
    }
}

pub(super) fn chain<T: Tier>(dice: &mut Dice, tally: &mut Tally) {
    row::<T>(dice, tally, 1e3, 1.0 / 64.0);
}

pub(super) fn contact<T: Tier>(dice: &mut Dice, tally: &mut Tally) {
    row::<T>(dice, tally, 1e3, 0.0);
}

pub(super) fn far<T: Tier>(dice: &mut Dice, tally: &mut Tally) {
    let gap = [0.0, 1.0 / 64.0][dice.below(2)];
    row::<T>(dice, tally, 1e5, gap);
}

/// Inside a sphere comes its own surface; outside comes the surface of another, or none.
fn row<T: Tier>(dice: &mut Dice, tally: &mut Tally, far: f64, gap: f64) {
    let glass = Glass::new(dice, far, |number| ((2.0 + gap) * number as f64, 1.0));
    glass.follow::<T, _>(dice, tally, (-5.0, 0.6), || {
        let (mut within, mut left) = (None, None);
        move |met| {
            let Some(Met { row, inside, total }) = met else { return within.is_none() };
            let allowed = match within {
                Some(around) => row == around && inside,
                None => left != Some(row) && !inside,
            };
            if !total {
                (within, left) = if inside { (None, Some(row)) } else { (Some(row), None) };
            }
            allowed
        }
    });
}

/// Inside so many spheres comes the surface of the innermost, or of the next.
pub(super) fn shells<T: Tier>(dice: &mut Dice, tally: &mut Tally) {
    let glass = Glass::new(dice, 1e3, |number| (0.0, (10 - number) as f64));
    glass.follow::<T, _>(dice, tally, (-15.0, 0.8), || {
        let mut depth = 0;
        move |met| {
            let Some(Met { row, inside, total }) = met else { return depth == 0 };
            let allowed = if inside { row + 1 == depth } else { row == depth };
            if !total {
                depth = if inside { depth.saturating_sub(1) } else { depth + 1 };
            }
            allowed
        }
    });
}
