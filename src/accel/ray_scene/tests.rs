//! What a user of the query API relies on.

use super::*;
use crate::accel::brute;
use crate::intersect::RayLanes;
use crate::intersect::testing::dice::Dice;

const TIERS: [TierName; 3] = [TierName::Fast, TierName::Watertight, TierName::Exact];
const HINTS: [Hint; 3] = [Hint::Auto, Hint::Coherent, Hint::Incoherent];
const SQUARE: [[f32; 3]; 4] = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];

/// Two squares at z = 0 and z = 2, a sphere around (0, 0, 5), a cylinder across z = 10.
fn row() -> RayScene {
    let behind = SQUARE.map(|[x, y, _]| [x, y, 2.0]);
    let builder = RaySceneBuilder::new().mesh(&SQUARE, &[[0, 1, 2], [0, 2, 3]]).unwrap();
    let builder = builder.mesh(&[], &[]).unwrap().mesh(&behind, &[[0, 1, 2], [0, 2, 3]]).unwrap();
    let builder = builder.sphere([0.0, 0.0, 5.0], 1.0).unwrap();
    builder.cylinder([-1.0, 0.0, 10.0], [1.0, 0.0, 10.0], 0.5, true).unwrap().build()
}

fn closest(scene: &RayScene, rays: &[Ray], tier: TierName, hint: Hint) -> Vec<Option<Hit>> {
    // Filled with what no answer can be: every place must be written.
    let poison = Hit { t: f32::NAN, u: 9.0, v: 9.0, prim: PrimId(u32::MAX), instance: 9 };
    let mut hits = vec![Some(poison); rays.len()];
    scene.closest(rays, &mut hits, tier, hint);
    hits
}

fn occluded(scene: &RayScene, rays: &[Ray], tier: TierName, hint: Hint) -> Vec<bool> {
    // Filled with either answer: every place must be written.
    let [a, b] = [true, false].map(|poison| {
        let mut occluded = vec![poison; rays.len()];
        scene.occluded(rays, &mut occluded, tier, hint);
        occluded
    });
    assert_eq!(a, b);
    a
}

fn forward(x: f32, y: f32, t_min: f32) -> Ray {
    Ray { t_min, ..Ray::new([x, y, -1.0], [0.0, 0.0, 1.0]) }
}

#[test]
fn hits_lead_back_to_what_was_added() {
    let scene = row();
    let first = Primitive::Triangle { mesh: 0, triangle: 0 };
    let cases = [
        (forward(0.5, -0.5, 0.0), 1.0, first),
        (forward(-0.5, 0.5, 0.0), 1.0, Primitive::Triangle { mesh: 0, triangle: 1 }),
        (forward(-0.5, 0.5, 1.5), 3.0, Primitive::Triangle { mesh: 2, triangle: 1 }),
        (forward(0.0, 0.0, 3.5), 5.0, Primitive::Sphere(0)),
        (forward(0.0, 0.0, 8.0), 10.5, Primitive::Cylinder(0)),
    ];
    for tier in TIERS {
        let hits = closest(&scene, &cases.map(|case| case.0), tier, Hint::Auto);
        for (hit, (_, t, primitive)) in hits.into_iter().zip(cases) {
            let hit = hit.unwrap();
            assert_eq!((hit.t, scene.primitive(hit.prim)), (t, primitive));
            assert_eq!(scene.prim_id(primitive), Some(hit.prim));
        }
    }
    assert_eq!(scene.prim_id(Primitive::Triangle { mesh: 0, triangle: 2 }), None);
    assert_eq!(scene.prim_id(Primitive::Triangle { mesh: 1, triangle: 0 }), None);
    assert_eq!(scene.prim_id(Primitive::Sphere(1)), None);
    assert_eq!(PrimKind::ALL.map(|kind| scene.count(kind)), [4, 1, 1, 0]);
    let [low, high] = scene.bounds().unwrap();
    assert_eq!((low, [high[0], high[1]]), ([-1.0, -1.0, 0.0], [1.0, 1.0]));
    assert!((10.5..10.5001).contains(&high[2]));
}

#[test]
fn hits_at_the_bounds_do_not_count() {
    let scene = row();
    let between = |t_min: f32, t_max: f32| Ray { t_max, ..forward(0.5, -0.5, t_min) };
    let rays = [
        between(0.0, 1.0),
        between(1.0, 3.0),
        between(0.0, 1.0f32.next_up()),
        between(1.0f32.next_down(), 3.0),
        between(2.0, 2.0),
        between(3.0, 2.0),
        between(f32::NEG_INFINITY, f32::INFINITY),
    ];
    let expected = [false, false, true, true, false, false, true];
    for (tier, hint) in TIERS.into_iter().flat_map(|tier| HINTS.map(|hint| (tier, hint))) {
        let hits = closest(&scene, &rays, tier, hint);
        assert_eq!(hits.iter().map(Option::is_some).collect::<Vec<_>>(), expected, "{tier:?} {hint:?}");
        assert_eq!(occluded(&scene, &rays, tier, hint), expected, "{tier:?} {hint:?}");
    }
}

/// A slice cut anywhere, in any number of threads, gives what one ray alone gives.
#[test]
fn answers_do_not_depend_on_the_slice() {
    let scene = row();
    let mut dice = Dice(3);
    let mut ray = || {
        let target = dice.point().map(|x| x as f32 * 1.2);
        let origin = dice.point().map(|x| x as f32 * 4.0);
        Ray::new(origin, std::array::from_fn(|k| target[k] + [0.0, 0.0, 4.0][k] - origin[k]))
    };
    let rays: Vec<Ray> = (0..3 * RAYS_PER_TASK + 5).map(|_| ray()).collect();
    for tier in TIERS {
        let alone: Vec<_> =
            rays.iter().map(|&ray| closest(&scene, &[ray], tier, Hint::Incoherent)[0]).collect();
        assert!((100..rays.len()).contains(&alone.iter().flatten().count()));
        for (hint, length) in HINTS.into_iter().flat_map(|h| [0, 1, 7, 8, 9, rays.len()].map(|n| (h, n))) {
            assert_eq!(closest(&scene, &rays[..length], tier, hint), alone[..length]);
            let hit: Vec<bool> = alone[..length].iter().map(Option::is_some).collect();
            assert_eq!(occluded(&scene, &rays[..length], tier, hint), hit);
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        assert_eq!(pool.install(|| closest(&scene, &rays, tier, Hint::Auto)), alone);
    }
}

#[test]
fn rays_that_are_no_rays_miss_and_leave_their_neighbours_alone() {
    let scene = row();
    let good = forward(0.5, -0.5, 0.0);
    let mut bad = vec![Ray { direction: [0.0, -0.0, 0.0], ..good }];
    for x in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for axis in 0..3 {
            let with = |mut v: [f32; 3]| {
                v[axis] = x;
                v
            };
            bad.push(Ray { origin: with(good.origin), ..good });
            bad.push(Ray { direction: with(good.direction), ..good });
        }
    }
    bad.push(Ray { t_min: f32::NAN, ..good });
    bad.push(Ray { t_max: f32::NAN, ..good });
    let mixed: Vec<Ray> = bad.iter().flat_map(|&bad| [bad, good]).collect();
    for (tier, hint) in TIERS.into_iter().flat_map(|tier| HINTS.map(|hint| (tier, hint))) {
        assert!(closest(&scene, &bad, tier, hint).iter().all(Option::is_none));
        for (i, hit) in closest(&scene, &mixed, tier, hint).iter().enumerate() {
            assert_eq!(hit.is_some(), i % 2 == 1, "{tier:?} {hint:?}");
        }
        assert!(occluded(&scene, &mixed, tier, hint).iter().enumerate().all(|(i, &hit)| hit == (i % 2 == 1)));
    }
}

#[test]
fn rays_that_are_all_parallel_or_nearly_all_answer_as_each_alone() {
    let (scene, mut dice) = (row(), Dice(11));
    let start = |dice: &mut Dice| {
        let [x, y, z] = dice.point().map(|x| x as f32);
        Ray::new([1.5 * x, 1.5 * y, z - 4.0], [0.1, -0.05, 1.0])
    };
    let mut rays: Vec<Ray> = (0..200).map(|_| start(&mut dice)).collect();
    for spoiled in [false, true] {
        if spoiled {
            rays[70].direction = [0.3, 0.1, 0.5];
        }
        for tier in TIERS {
            let together = closest(&scene, &rays, tier, Hint::Auto);
            let alone: Vec<_> = rays.iter().flat_map(|&r| closest(&scene, &[r], tier, Hint::Auto)).collect();
            assert_eq!(together, alone);
            assert!(together.iter().flatten().count() > 50);
        }
    }
}

#[test]
fn an_empty_scene_is_missed() {
    let scene = RaySceneBuilder::new().build();
    let mut hits = [None; 9];
    scene.closest(&[forward(0.0, 0.0, 0.0); 9], &mut hits, TierName::Watertight, Hint::Auto);
    assert_eq!((hits, scene.bounds()), ([None; 9], None));
}

#[test]
fn triangles_without_area_are_never_hit_and_keep_their_number() {
    // Multiples of one vector by fractions with few bits: exactly on a line.
    let vertices = [1.0, 7.0, 4.0, 3.0].map(|n: f32| [0.125 * n, 0.25 * n, 0.375 * n]);
    let flat = [[0, 0, 0], [0, 1, 1], [1, 0, 1], [0, 1, 2], [3, 2, 1]];
    let scene = RaySceneBuilder::new().mesh(&vertices, &flat).unwrap().mesh(&SQUARE, &[[0, 1, 2]]).unwrap();
    let scene = scene.build();
    let mut dice = Dice(5);
    let aimed = |dice: &mut Dice| {
        let (target, origin) = (vertices[dice.below(4)], dice.point().map(|x| 3.0 * x as f32));
        Ray::new(origin, std::array::from_fn(|k| target[k] - origin[k]))
    };
    let rays: Vec<Ray> = (0..20_000).map(|_| aimed(&mut dice)).collect();
    let flat_ones = closest(&scene, &rays, TierName::Watertight, Hint::Auto).into_iter().flatten();
    assert_eq!(flat_ones.filter(|hit| hit.prim.row() < 5).count(), 0);
    let hit = closest(&scene, &[forward(0.5, -0.5, 0.0)], TierName::Watertight, Hint::Auto)[0].unwrap();
    assert_eq!(scene.primitive(hit.prim), Primitive::Triangle { mesh: 1, triangle: 0 });
}

#[test]
fn what_is_no_primitive_is_refused() {
    let new = RaySceneBuilder::new;
    let nan = [0.0, f32::NAN, 0.0];
    let mesh = |vertices: &[[f32; 3]], indices: &[[u32; 3]]| new().mesh(vertices, indices).unwrap_err();
    assert_eq!(
        mesh(&SQUARE, &[[0, 1, 2], [0, 4, 1]]),
        RaySceneError::Index { triangle: 1, index: 4, vertices: 4 }
    );
    assert!(matches!(mesh(&[[0.0; 3], nan], &[]), RaySceneError::Vertex { vertex: 1, .. }));
    assert!(matches!(new().sphere(nan, 1.0).unwrap_err(), RaySceneError::Point { .. }));
    for radius in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        assert!(matches!(new().sphere([0.0; 3], radius).unwrap_err(), RaySceneError::Radius { .. }));
        let cylinder = new().cylinder([0.0; 3], [1.0; 3], radius, true);
        assert!(matches!(cylinder.unwrap_err(), RaySceneError::Radius { .. }));
    }
    assert!(matches!(new().cylinder(nan, [0.0; 3], 1.0, true).unwrap_err(), RaySceneError::Point { .. }));
    let axis = new().cylinder([0.0, 1.0, 0.0], [-0.0, 1.0, 0.0], 1.0, false).unwrap_err();
    assert_eq!(axis.to_string(), "both ends of the cylinder are [0.0, 1.0, 0.0]: its axis has no direction");
}

#[test]
#[should_panic(expected = "3 rays need as many places for answers, not 2")]
fn slices_of_different_length_are_refused() {
    row().closest(&[forward(0.0, 0.0, 0.0); 3], &mut [None; 2], TierName::Fast, Hint::Auto);
}

#[test]
#[should_panic(expected = "no number 1")]
fn an_id_of_another_scene_is_refused() {
    row().primitive(PrimId::new(PrimKind::Sphere, 1));
}

/// Coordinates up to the ends of the number range neither panic nor lose what the plain loop finds.
#[test]
fn huge_and_tiny_primitives_equal_brute_force() {
    let big = 3e38;
    let builder =
        RaySceneBuilder::new().mesh(&[[-big, -big, 1.0], [big, -big, 1.0], [0.0, big, 1.0]], &[[0, 1, 2]]);
    let builder = builder.unwrap().sphere([0.0; 3], big).unwrap().sphere([0.0, 0.0, 2.0], 1e-44).unwrap();
    let builder = builder.cylinder([0.0; 3], [0.0, 1e-45, 0.0], big, true).unwrap();
    let mut geometry = builder.geometry.clone();
    let scene = builder.build();
    geometry.groups = vec![crate::geometry::Group { triangles: 0..1, spheres: 0..2, cylinders: 0..1 }];
    let mut dice = Dice(11);
    for _ in 0..2000 {
        let number = |dice: &mut Dice| [dice.hard(), dice.magnitude(-40.0, 38.0) as f32][dice.below(2)];
        let vector = |dice: &mut Dice| std::array::from_fn(|_| number(dice));
        let ray = Ray::new(vector(&mut dice), vector(&mut dice));
        if !is_usable(&ray) {
            continue;
        }
        let expected =
            brute::closest::<Watertight>(&geometry, &RayLanes::from(&ray)).map(|hit| (hit.t, hit.prim));
        for hint in HINTS {
            let hit = closest(&scene, &[ray], TierName::Watertight, hint)[0];
            assert_eq!(hit.map(|hit| (hit.t, hit.prim)), expected, "{ray:?}");
        }
    }
}
