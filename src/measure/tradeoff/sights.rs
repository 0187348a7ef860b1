//! What a tier sees through the middle of each pixel: which primitive, and which lights from there.

use rayon::prelude::*;

use crate::accel::{Hint, Traversal};
use crate::intersect::{Exact, Fast, PrimId, RayLanes, Tier, TierName, Watertight};
use crate::math::{BitLane, Lane, Real, Vec3, WIDTH, eight};
use crate::scene::{Light, Scene};
use crate::wavefront::{HitLanes, evaluate, offset_along};

/// What is seen through the middle of a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Sight {
    /// The primitive's number and instance; none where there is only background.
    prim: Option<(u32, u32)>,
    /// A bit for each of the first 64 lights that reaches the place.
    lit: u64,
}

/// Sights of all pixels of a picture of a size, row by row.
pub(super) fn sights(scene: &Scene, tier: TierName, size: [u32; 2]) -> Vec<Sight> {
    match tier {
        TierName::Fast => of_tier::<Fast>(scene, size),
        TierName::Watertight => of_tier::<Watertight>(scene, size),
        TierName::Exact => of_tier::<Exact>(scene, size),
    }
}

/// The share of pixels of the large picture that the small one, shrunk by a factor, sees otherwise.
pub(super) fn share_wrong(truth: &[Sight], width: u32, found: &[Sight], shrink: u32) -> f64 {
    let (width, by) = (width as usize, shrink as usize);
    let small = |i: usize| found[(i / width / by) * (width / by) + i % width / by];
    let wrong = truth.iter().enumerate().filter(|(i, sight)| **sight != small(*i)).count();
    wrong as f64 / truth.len().max(1) as f64
}

fn of_tier<T: Tier>(scene: &Scene, [width, height]: [u32; 2]) -> Vec<Sight> {
    let row = |y: u32| {
        let mut traversal = Traversal::new(&scene.accel);
        let film_y = T::Wide::constant(1.0 - (2.0 * f64::from(y) + 1.0) / f64::from(height));
        let eight = |x: u32| {
            let place = |i: usize| (2.0 * f64::from(x + i as u32) + 1.0) / f64::from(width) - 1.0;
            look::<T>(scene, &mut traversal, (T::Wide::from_fn(|i| T::Real::constant(place(i))), film_y))
        };
        let sights = (0..width).step_by(WIDTH).flat_map(eight);
        sights.take(width as usize).collect::<Vec<_>>()
    };
    (0..height).into_par_iter().flat_map_iter(row).collect()
}

/// Eight sights through places of the film, and through the middle of the lens.
fn look<T: Tier>(scene: &Scene, traversal: &mut Traversal, film: (T::Wide, T::Wide)) -> [Sight; WIDTH] {
    let zero = T::Wide::zero();
    let camera = scene.camera.rays::<T::Wide>(film, || (zero, zero));
    let t_max = T::Wide::constant(f64::INFINITY);
    let rays = RayLanes { origin: camera.origin, direction: camera.direction, t_min: camera.t_min, t_max };
    let found = traversal.closest::<T>(&rays, Hint::Auto);
    let hit = |i: usize| found.t.get(i) < T::Real::constant(f64::INFINITY);
    let prim = |i: usize| hit(i).then(|| (found.prim.get(i), found.instance.get(i)));
    let places = eight(|i| {
        let (prim, instance) = prim(i)?;
        let (uv, t) = ((found.u.get(i), found.v.get(i)), found.t.get(i));
        Some(leave(scene, &rays.get(i), PrimId(prim), instance, t, uv))
    });
    let mut sights = eight(|i| Sight { prim: prim(i), lit: 0 });
    for (bit, light) in scene.lights.iter().take(64).enumerate() {
        let lit = reached::<T>(light, scene.settings.shadows.then_some(&mut *traversal), &places);
        sights.iter_mut().enumerate().for_each(|(i, sight)| sight.lit |= u64::from(lit >> i & 1) << bit);
    }
    sights
}

/// A place off a surface and the normal there, to the side that the ray came from.
type Place<R> = (Vec3<R>, Vec3<R>);

fn leave<R: Real>(
    scene: &Scene,
    ray: &RayLanes<R>,
    prim: PrimId,
    instance: u32,
    t: R,
    (u, v): (R, R),
) -> Place<R> {
    let (origin, direction) = (ray.origin, ray.direction);
    let (row, instance) = ([prim.row() as u32; WIDTH], [instance; WIDTH]);
    let hit = HitLanes { origin, direction, t, u, v, row, instance };
    let surface = evaluate(&scene.geometry, prim.kind(), &hit);
    let outward = surface.geometric_normal;
    let normal = if outward.dot(direction) > R::zero() { -outward } else { outward };
    (offset_along(surface.point, surface.error, normal), normal)
}

/// The lanes whose place a light reaches, as bits: all that face it, where nothing is asked for what stands between.
fn reached<T: Tier>(
    light: &Light,
    between: Option<&mut Traversal>,
    places: &[Option<Place<T::Real>>; WIDTH],
) -> u32 {
    let zero = T::Real::zero();
    let nowhere = Vec3::<T::Real>::splat([zero; 3]);
    let origin = eight(|i| places[i].map_or(nowhere, |(origin, _)| origin));
    let to_light = eight(|i| light.illuminate(origin[i]).to_light);
    let faces = |i: usize| places[i].is_some_and(|(_, normal)| to_light[i].dot(normal) > zero);
    let asked: u32 = (0..WIDTH).map(|i| u32::from(faces(i)) << i).sum();
    let Some(between) = between else { return asked };
    let t_max = |i: usize| if asked >> i & 1 != 0 { light.t_max() } else { f64::NEG_INFINITY };
    let lanes = |v: &[Vec3<T::Real>; WIDTH]| Vec3 {
        x: T::Wide::from_fn(|i| v[i].x),
        y: T::Wide::from_fn(|i| v[i].y),
        z: T::Wide::from_fn(|i| v[i].z),
    };
    let rays = RayLanes {
        origin: lanes(&origin),
        // A lane that is not asked still needs a direction.
        direction: lanes(&eight(|i| if faces(i) { to_light[i] } else { Vec3::splat([T::Real::one(); 3]) })),
        t_min: T::Wide::zero(),
        t_max: T::Wide::from_fn(|i| T::Real::constant(t_max(i))),
    };
    asked & !between.any::<T>(&rays, Hint::Incoherent)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::describe::{builtin, parse};
    use crate::intersect::PrimKind;

    const SIZE: [u32; 2] = [40, 30];

    fn scene(name: &str) -> Scene {
        Scene::compile(&builtin(name).unwrap().unwrap()).unwrap()
    }

    #[test]
    fn tiers_see_nearly_the_same_and_small_pictures_less() {
        for name in ["seed", "glass", "cornell", "instances"] {
            let scene = scene(name);
            let truth = sights(&scene, TierName::Exact, SIZE);
            assert_eq!(truth.len(), 1200);
            let wrong = |tier| share_wrong(&truth, SIZE[0], &sights(&scene, tier, SIZE), 1);
            assert_eq!(wrong(TierName::Exact), 0.0);
            assert!(wrong(TierName::Watertight) < 0.01, "{name}: {}", wrong(TierName::Watertight));
            let half = share_wrong(&truth, SIZE[0], &sights(&scene, TierName::Exact, [20, 15]), 2);
            assert!(half > 0.01 && half < 0.9, "{name}: {half}");
        }
    }

    #[test]
    fn a_sphere_shades_the_plane_behind_it() {
        let text = "[camera]\nposition = [0, 0, 9]\nlook_at = [0, 0, 0]\nfov_deg = 60\n\
            [[light.directional]]\ndirection = [-1, 0, -1]\nintensity = 1\n\
            [[plane]]\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n[[sphere]]\ncenter = [0, 0, 2]\nradius = 1\n";
        let mut scene = Scene::compile(&parse(text, "test.toml").unwrap()).unwrap();
        let all = sights(&scene, TierName::Watertight, SIZE);
        let kinds = |kind: PrimKind, lit: u64| {
            let of = |s: &&Sight| s.lit == lit && s.prim.is_some_and(|(prim, _)| PrimId(prim).kind() == kind);
            all.iter().filter(of).count()
        };
        assert!(kinds(PrimKind::Sphere, 1) > 20 && kinds(PrimKind::Plane, 1) > 400);
        assert!((10..100).contains(&kinds(PrimKind::Plane, 0)), "{} in shadow", kinds(PrimKind::Plane, 0));

        // A picture without shadows is wrong where they belong.
        scene.settings.shadows = false;
        let without = sights(&scene, TierName::Watertight, SIZE);
        let shade = kinds(PrimKind::Plane, 0) as f64 / all.len() as f64;
        assert_eq!(share_wrong(&all, SIZE[0], &without, 1), shade);
    }
}
