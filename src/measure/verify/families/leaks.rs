//! Rays by the thousand million out of closed meshes: too many for an oracle, and none is needed, for all must hit.

use super::closed::Placed;
use super::{Family, Make};
use crate::accel::stream::{Apex, HitColumns, RayStream};
use crate::accel::{Accel, Hint};
use crate::intersect::testing::dice::Dice;
use crate::intersect::testing::meshes::{Mesh, cube, icosphere};
use crate::intersect::{Exact, Fast, Ray, Tier, Watertight};
use crate::math::{Lane, Real, WIDTH};
use crate::measure::verify::bounds::Promise;
use crate::measure::verify::octray::{Columns, usable_lanes};
use crate::measure::verify::tally::{Fault, Tally};
use crate::measure::verify::trial::Claim;

pub(super) const FAMILIES: &[Family] = &[Family {
    name: "leaks",
    about: "from inside closed meshes of up to 1280 triangles at vertices, edges and faces, without an oracle: quick enough for 1e9",
    promise: Promise::Leaks,
    make: Make::Walks(MESHES * RAYS, [leaks::<Fast>, leaks::<Watertight>, leaks::<Exact>]),
}];

/// Meshes of a walk: some lose more than others.
const MESHES: usize = 4;
/// Rays at a mesh.
const RAYS: usize = 1 << 13;
/// Rays in a stream at once.
const STREAM: usize = 1 << 10;

fn leaks<T: Tier>(dice: &mut Dice, tally: &mut Tally) {
    let meshes: [Mesh; MESHES] = [cube(), icosphere(1), icosphere(2), icosphere(3)];
    meshes.iter().for_each(|mesh| leave::<T>(dice, tally, mesh));
}

fn leave<T: Tier>(dice: &mut Dice, tally: &mut Tally, mesh: &Mesh) {
    let mesh = Placed::at_random(dice, mesh);
    let common = (dice.below(2) == 0).then(|| mesh.point_inside(dice));
    let rays: Vec<Ray> = (0..RAYS).map(|_| mesh.ray_from_inside(dice, common)).collect();
    let trial = mesh.trial(Claim::Inside, rays);
    let geometry = trial.geometry();
    let accel = Accel::build(&geometry);
    let mut stream = RayStream::<T>::new(&accel);
    let apex = trial.common_origin().map(Apex::Origin);
    let any = dice.below(2) == 0;
    for rays in trial.rays.chunks(STREAM) {
        let missed = if any { unstopped(&mut stream, rays, apex) } else { lost(&mut stream, rays, apex) };
        tally.rays += rays.len();
        tally.hits += rays.len() - missed.len();
        for i in missed {
            tally.add(Fault::Leak, || format!("{:?} gets out of {} triangles", rays[i], trial.shapes.len()));
        }
    }
}

fn columns<T: Tier>(rays: &[Ray]) -> Columns<T::Real> {
    Columns::of(&rays.chunks(WIDTH).map(usable_lanes::<T>).collect::<Vec<_>>())
}

/// Rays without a nearest hit.
fn lost<T: Tier>(stream: &mut RayStream<T>, rays: &[Ray], apex: Option<Apex>) -> Vec<usize> {
    let real = || vec![T::Real::zero(); rays.len()];
    let (mut t, mut u, mut v, mut prim) = (real(), real(), real(), vec![0; rays.len()]);
    let mut hits = HitColumns { t: &mut t, u: &mut u, v: &mut v, prim: &mut prim, instance: &mut [] };
    stream.closest(&columns::<T>(rays).rays(rays.len()), apex, Hint::Auto, &mut hits);
    (0..rays.len()).filter(|&i| t[i].to_f64() == f64::INFINITY).collect()
}

/// Rays that nothing stops.
fn unstopped<T: Tier>(stream: &mut RayStream<T>, rays: &[Ray], apex: Option<Apex>) -> Vec<usize> {
    let mut occluded = vec![0u8; rays.len().div_ceil(WIDTH)];
    stream.any(&columns::<T>(rays).rays(rays.len()), apex, Hint::Auto, &mut occluded);
    (0..rays.len()).filter(|i| occluded[i / WIDTH] >> (i % WIDTH) & 1 == 0).collect()
}
