//! Paths through bodies of glass, walked by the stages that render them: each step has to be one that glass allows.

use super::aim::{across, add, rounded};
use super::paths::{PATHS, vector};
use crate::describe::{Camera, Cylinder, Material, MaterialKind, Mesh, SceneDescription, Sphere};
use crate::intersect::Tier;
use crate::intersect::testing::dice::Dice;
use crate::math::Vec3;
use crate::measure::verify::tally::{Fault, Tally};
use crate::scene::Scene;
use crate::wavefront::{Step, walk};

/// Interfaces that a path through glass meets at most.
const INTERFACES: usize = 20;

/// Where a path went: which body, whether from inside, and whether all was reflected.
#[derive(Clone, Copy)]
struct Met {
    row: usize,
    inside: bool,
    total: bool,
}

/// Bodies of glass along an axis.
struct Glass {
    scene: Scene,
    center: [f64; 3],
    axis: [f64; 3],
}

/// A body of a chain, from 1 before its place on the axis to 1 behind it, or of another radius around it.
#[derive(Clone, Copy)]
enum Body {
    Sphere(f64),
    /// A closed box of triangles, wide enough that paths leave by the face opposite.
    Slab,
    /// The same as a cylinder, met at its caps.
    Coin,
    /// A cylinder across the axis, met at its side.
    Rod,
}

/// Half the width of slabs, coins and rods.
const HALF_WIDTH: f64 = 8.0;

impl Body {
    fn add_to(self, scene: &mut SceneDescription, center: [f64; 3], axis: [f64; 3], number: usize) {
        let material = Some(format!("glass {number}"));
        scene.material[number].name = format!("glass {number}");
        let aside = [axis[2].abs(), axis[0].abs(), axis[1].abs()];
        match self {
            Self::Sphere(radius) => {
                scene.sphere.push(Sphere { center, radius, material, transform: Default::default() });
            }
            Self::Slab => scene.mesh.push(slab(center, axis, material)),
            Self::Coin => scene.cylinder.push(between(center, axis, 1.0, HALF_WIDTH, material)),
            Self::Rod => scene.cylinder.push(between(center, aside, HALF_WIDTH, 1.0, material)),
        }
    }
}

fn between(center: [f64; 3], axis: [f64; 3], half: f64, radius: f64, material: Option<String>) -> Cylinder {
    let (from, to) = (Some(add(center, axis, -half)), Some(add(center, axis, half)));
    let (center, half_height, transform) = (None, None, Default::default());
    Cylinder { from, to, center, half_height, radius, caps: true, material, transform }
}

fn slab(center: [f64; 3], axis: [f64; 3], material: Option<String>) -> Mesh {
    let half = axis.map(|a| if a == 0.0 { HALF_WIDTH } else { 1.0 });
    let corner = |number: usize| std::array::from_fn(|k| center[k] + [-half[k], half[k]][number >> k & 1]);
    // Counter-clockwise from outside; corner numbers have a bit an axis.
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    Mesh {
        name: None,
        path: None,
        vertices: Some((0..8).map(corner).collect()),
        faces: Some(faces.map(|face| face.to_vec()).to_vec()),
        procedural: None,
        material,
        transform: Default::default(),
        smooth: false,
        normals: true,
    }
}

impl Glass {
    /// On a grid, so that touching bodies do not overlap by rounding; up to `far` from the origin. `bodies` gives what
    /// stands where along the axis.
    fn new(dice: &mut Dice, far: f64, bodies: impl Fn(usize) -> (f64, Body)) -> Self {
        let far = [0.0, 0.1 * far, far][dice.below(3)];
        let center: [f64; 3] = dice.point().map(|x| (x * far).round());
        let mut axis = [0.0; 3];
        axis[dice.below(3)] = [1.0, -1.0][dice.below(2)];
        let ior = [1.5, 1.33, 2.4, 1.0001, 1.0 + f64::from(f32::EPSILON)][dice.below(5)];
        let glass = Material { ior, ..Material::new("glass", MaterialKind::Dielectric) };
        let camera = Camera::perspective([0.0; 3], [0.0, 0.0, -1.0], 45.0);
        let material = vec![glass; INTERFACES / 2];
        let mut description = SceneDescription { material, ..SceneDescription::new(camera) };
        for number in 0..INTERFACES / 2 {
            let (along, body) = bodies(number);
            let place = rounded(add(center, axis, along)).map(f64::from);
            body.add_to(&mut description, place, axis, number);
        }
        description.render.min_throughput = 0.0;
        let scene = Scene::compile(&description).expect("bodies of glass");
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
                Step::Body { row, from_inside, total } => {
                    judges[number](Some(Met { row, inside: from_inside, total }))
                }
                Step::Passed => true,
            };
            if !right {
                told += 1;
                tally.add(Fault::SelfHit, || {
                    let g = &self.scene.geometry;
                    let (spheres, cylinders, corners) = (&g.spheres, &g.cylinders, &g.triangles.position);
                    format!(
                        "{:?} among {spheres:?}, {cylinders:?}, {corners:?} comes to {step:?}",
                        paths[number]
                    )
                });
            }
            right
        });
        tally.hits += PATHS - told;
    }
}

pub(super) fn chain<T: Tier>(dice: &mut Dice, tally: &mut Tally) {
    row::<T>(dice, tally, 1e3, 1.0 / 64.0, Body::Sphere(1.0));
}

pub(super) fn solids<T: Tier>(dice: &mut Dice, tally: &mut Tally) {
    let body = [Body::Slab, Body::Coin, Body::Rod][dice.below(3)];
    row::<T>(dice, tally, 1e3, 1.0 / 64.0, body);
}

pub(super) fn contact<T: Tier>(dice: &mut Dice, tally: &mut Tally) {
    row::<T>(dice, tally, 1e3, 0.0, Body::Sphere(1.0));
}

pub(super) fn far<T: Tier>(dice: &mut Dice, tally: &mut Tally) {
    let gap = [0.0, 1.0 / 64.0][dice.below(2)];
    row::<T>(dice, tally, 1e5, gap, Body::Sphere(1.0));
}

/// Inside a body comes its own surface; outside comes the surface of another, or none.
fn row<T: Tier>(dice: &mut Dice, tally: &mut Tally, far: f64, gap: f64, body: Body) {
    let glass = Glass::new(dice, far, |number| ((2.0 + gap) * number as f64, body));
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
    let glass = Glass::new(dice, 1e3, |number| (0.0, Body::Sphere((10 - number) as f64)));
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
