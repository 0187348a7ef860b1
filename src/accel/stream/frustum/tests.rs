mod rounds;

use super::plane::Plane;
use super::{Apex, Frustum, focus};
use crate::accel::instance::TreeRoot;
use crate::accel::stream::{BUNDLE, GROUP};
use crate::intersect::testing::dice::Dice;
use crate::intersect::{Exact, Ray, RayLanes, Tier, TriangleTest, Watertight};
use crate::math::{Aabb, Lane, Mask, Vec3, WIDTH, three};
use wide::f32x8;

/// Least and greatest coordinates.
type Extent = [[f32; 3]; 2];

fn offset(at: [f64; 3], by: f64, dice: &mut Dice) -> [f64; 3] {
    let p = dice.point();
    three(|k| at[k] + by * p[k])
}

/// As many rays as a small or a large bundle has from an apex past a point, and the apex; as a mirror would throw them back,
/// they start on the way.
fn beam(dice: &mut Dice) -> (Vec<Ray>, Apex) {
    let (apex, middle) = (dice.point().map(|x| 3.0 * x), dice.point());
    let (kind, spread) = (dice.below(4), dice.between(0.01, 0.3));
    let way: [f32; 3] = three(|k| (middle[k] - apex[k]) as f32);
    let narrow = |p: [f64; 3]| p.map(|x| x as f32);
    let ray = |dice: &mut Dice| {
        let end = narrow(offset(middle, spread, dice));
        let (from, to) = match kind {
            1 => (end, narrow(apex)),
            3 => (end, three(|k| end[k] + way[k])),
            _ => (narrow(apex), end),
        };
        let mut ray = Ray::new(from, if kind == 3 { way } else { three(|k| to[k] - from[k]) });
        ray.t_max = [f32::INFINITY, 1.0, dice.between(0.5, 3.0) as f32, dice.between(0.5, 3.0) as f32][kind];
        if kind == 2 {
            let way = dice.between(0.3, 0.5);
            let from = offset(apex, 1e-4, dice);
            ray.origin = narrow(three(|k| from[k] + way * f64::from(ray.direction[k])));
        }
        ray
    };
    let packets = if dice.below(4) == 0 { BUNDLE } else { GROUP };
    let rays = (0..packets * WIDTH).map(|_| ray(dice)).collect();
    let apex = narrow(apex);
    (rays, [Apex::Origin(apex), Apex::Target(apex), Apex::Behind(apex), Apex::Parallel][kind])
}

/// A box of any size on the way of a ray, or beside it.
fn on_the_way(rays: &[Ray], dice: &mut Dice) -> Extent {
    let ray = &rays[dice.below(rays.len())];
    let t = dice.between(-0.5, 2.0);
    let at = three(|k| f64::from(ray.origin[k]) + t * f64::from(ray.direction[k]));
    let at = offset(at, [0.0, 0.01, 0.3][dice.below(3)], dice);
    let size = [0.0, 1e-4, 0.02, 0.5][dice.below(4)];
    let (p, q) = (offset(at, size, dice), offset(at, size, dice));
    [three(|k| p[k].min(q[k]) as f32), three(|k| p[k].max(q[k]) as f32)]
}

/// Whether a ray meets a box, by its slabs in `f64`.
fn meets(ray: &Ray, [lo, hi]: &Extent) -> bool {
    let (mut first, mut last) = (f64::from(ray.t_min), f64::from(ray.t_max));
    for k in 0..3 {
        let at = |plane: f32| (f64::from(plane) - f64::from(ray.origin[k])) / f64::from(ray.direction[k]);
        let (a, b) = (at(lo[k]), at(hi[k]));
        (first, last) = (first.max(a.min(b)), last.min(a.max(b)));
    }
    first <= last
}

fn packets(rays: &[Ray]) -> Vec<RayLanes<f32x8>> {
    let one: Vec<RayLanes<f32>> = rays.iter().map(RayLanes::from).collect();
    one.chunks(WIDTH).map(|packet| RayLanes::gather(|i| &packet[i])).collect()
}

/// The frustum of a beam, by its apex or by the one that is found for it.
fn around(rays: &[Ray], apex: Apex, finds: bool, scale: f32) -> Option<Frustum> {
    let world = TreeRoot::new(0, &Aabb { min: [-4.0 * scale; 3], max: [4.0 * scale; 3] });
    let (packets, mut frustum) = (packets(rays), Frustum::default());
    let apex = if finds { Apex::Behind(focus::<Watertight>(&packets, world)?) } else { apex };
    frustum.surround::<Watertight>(&packets, apex, world)?;
    packets.iter().enumerate().for_each(|(j, packet)| frustum.look(j, packet.t_max));
    frustum.update_reach();
    Some(frustum)
}

/// What a frustum says of eight boxes: that rays may meet them, which packets may meet each, and which of them each group
/// may meet.
fn answers(frustum: &Frustum, extents: &[Extent; WIDTH]) -> (u32, [u32; WIDTH], Vec<u32>) {
    let column = |side: usize, k: usize| f32x8::from_fn(|i| extents[i][side][k]);
    let boxes = frustum.view().boxes(|k| column(0, k), |k| column(1, k));
    let sight = frustum.sight(&boxes);
    let seen = frustum.sees(&sight) & frustum.meets(&frustum.all, &boxes, f32x8::splat(frustum.reach));
    let groups = (0..frustum.groups()).map(|group| frustum.meets_group(group, &sight));
    (seen, std::array::from_fn(|i| frustum.packets(&sight, i)), groups.collect())
}

#[test]
fn what_a_ray_meets_is_not_culled_and_most_of_the_rest_is() {
    let (mut beams, mut parallel, mut met, mut kept, mut missed) = (0, 0, 0, 0, 0);
    for seed in 0..3_000 {
        let dice = &mut Dice(seed);
        let (rays, apex) = beam(dice);
        let Some(frustum) = around(&rays, apex, matches!(apex, Apex::Behind(_)) && seed % 2 == 0, 1.0) else {
            continue;
        };
        beams += 1;
        parallel += usize::from(apex == Apex::Parallel);
        let extents: [Extent; WIDTH] = std::array::from_fn(|_| on_the_way(&rays, dice));
        let (seen, packets, groups) = answers(&frustum, &extents);
        for (i, extent) in extents.iter().enumerate() {
            let meets: Vec<usize> = (0..rays.len()).filter(|&r| meets(&rays[r], extent)).collect();
            for &r in &meets {
                assert!(seen >> i & 1 != 0, "{:?} {extent:?} {apex:?}", rays[r]);
                assert!(packets[i] >> (r / WIDTH) & 1 != 0, "{:?} {extent:?} {apex:?}", rays[r]);
                let group = r / WIDTH / GROUP;
                assert!(groups[group] >> i & 1 != 0, "{:?} {extent:?} {apex:?}", rays[r]);
            }
            match meets.is_empty() {
                true => (missed, kept) = (missed + 1, kept + (seen >> i & 1)),
                false => met += meets.len(),
            }
        }
    }
    assert!(parallel > 500, "{parallel} parallel beams");
    assert!(beams > 1_000 && met > 10_000, "{beams} beams, {met} met");
    assert!(missed > 1_000 && kept < missed / 2, "{kept} of {missed} boxes are kept that no ray meets");
}

/// Three corners about a point on the way of a ray or about the apex, and whether they are as far apart as those of most
/// triangles for which edges are asked. Rays pass closely by corners and edges, planes by the apex.
fn triangle(rays: &[Ray], apex: Apex, dice: &mut Dice) -> ([[f32; 3]; 3], bool) {
    let ray = rays[dice.below(rays.len())];
    let on_ray = |t: f64| three(|k| f64::from(ray.origin[k]) + t * f64::from(ray.direction[k]));
    let at = match (dice.below(4), apex) {
        (0, Apex::Origin(p) | Apex::Target(p) | Apex::Behind(p)) => p.map(f64::from),
        (1, _) => on_ray(dice.between(-0.01, 0.01)),
        _ => on_ray(dice.between(-0.5, 2.0)),
    };
    let (size, shape) = ([1e-6, 1e-3, 0.05, 2.0][dice.below(4)], dice.below(5));
    let [a, b] = [size, [size, 2.0][dice.below(2)]].map(|size| offset(at, size, dice));
    let opposite = |part: f64| three(|k| at[k] + part * (at[k] - 0.5 * (a[k] + b[k])));
    let beyond = |part: f64| three(|k| at[k] + part * (at[k] - a[k]));
    let mut corners = match shape {
        0 => [a, b, opposite(dice.between(0.2, 2.0))],
        1 => [a, b, offset(a, 1e-5 * size, dice)],
        2 => [a, b, beyond(dice.between(0.0, 2.0))],
        _ => [a, b, offset(at, size, dice)],
    };
    if shape == 3 {
        let axis = dice.below(3);
        corners.iter_mut().for_each(|p| p[axis] = at[axis]);
    }
    (corners.map(|p| p.map(|x| x as f32)), size >= 0.05 && shape == 4)
}

/// A triangle in whose plane a ray starts within rounding, as it does on what it left.
fn under_a_start(rays: &[Ray], dice: &mut Dice) -> [[f32; 3]; 3] {
    let at = rays[dice.below(rays.len())].origin.map(f64::from);
    let size = [0.01, 0.1, 1.0][dice.below(3)];
    let (a, b) = (offset(at, size, dice), offset(at, size, dice));
    [a, b, three(|k| 3.0 * at[k] - a[k] - b[k])].map(|p| p.map(|x| x as f32))
}

/// All of a beam that many times as large.
fn scaled(rays: &mut [Ray], apex: Apex, by: f32) -> Apex {
    for ray in rays {
        ray.origin = ray.origin.map(|x| x * by);
        ray.direction = ray.direction.map(|x| x * by);
    }
    let point = |p: [f32; 3]| p.map(|x| x * by);
    match apex {
        Apex::Origin(p) => Apex::Origin(point(p)),
        Apex::Target(p) => Apex::Target(point(p)),
        Apex::Behind(p) => Apex::Behind(point(p)),
        Apex::Parallel => Apex::Parallel,
    }
}

/// Where the test of a tier has a ray hit a triangle before its end.
fn hits<T: Tier>(ray: &Ray, corners: [[f32; 3]; 3]) -> Option<T::Real> {
    let ray = RayLanes::<T::Real> {
        origin: Vec3::splat_f32(ray.origin),
        direction: Vec3::splat_f32(ray.direction),
        t_min: T::Real::constant(f64::from(ray.t_min)),
        t_max: T::Real::constant(f64::from(ray.t_max)),
    };
    let hit = T::Triangle::test(&ray, &T::Triangle::prepare(&ray), corners.map(Vec3::splat_f32), ray.t_max);
    (hit.mask.any() && hit.t.gt(ray.t_min).any() && hit.t.lt(ray.t_max).any()).then_some(hit.t)
}

#[test]
fn edges_tell_of_no_hit_that_it_is_none_and_of_most_misses() {
    let (mut met, mut beside, mut behind) = (0, [0; 2], [0; 2]);
    for seed in 0..20_000 {
        let dice = &mut Dice(seed);
        let (mut rays, apex) = beam(dice);
        let triangles: [_; WIDTH] = std::array::from_fn(|_| triangle(&rays, apex, dice));
        let scale = [1.0, 1e-12, 1e9, 1e-18, 1e15][dice.below(5)];
        let apex = scaled(&mut rays, apex, scale);
        let Some(frustum) = around(&rays, apex, false, scale) else { continue };
        let is_plain = triangles.map(|(_, is_plain)| is_plain);
        let triangles = triangles.map(|(corners, _)| corners.map(|p| p.map(|x| x * scale)));
        let corners = three(|v| frustum.view().point(|k| f32x8::from_fn(|i| triangles[i][v][k])));
        let [a, b, c] = corners;
        let sight = frustum.sight(&[a.min(b).min(c), a.max(b).max(c)]);
        let edges = frustum.edges((seed % 3 != 0).then_some(&sight), corners);
        let all = frustum.triangles(&edges);
        for (i, corners) in triangles.into_iter().enumerate() {
            for (r, ray) in rays.iter().enumerate() {
                // Without its packet near the triangle no ray is asked.
                let near = frustum.packets(&sight, i) >> (r / WIDTH) & 1 != 0;
                let may_hit = edges.may_hit(i, frustum.eight(r / WIDTH)) >> (r % WIDTH) & 1 != 0;
                let told = (near && may_hit, all >> i & 1 != 0);
                if hits::<Watertight>(ray, corners).is_some() || hits::<Exact>(ray, corners).is_some() {
                    met += 1;
                    assert_eq!(told, (true, true), "{ray:?} {corners:?} {apex:?}, seed {seed}");
                }
                if !is_plain[i] || scale < 1.0 {
                    continue;
                }
                let backward = Ray { direction: ray.direction.map(|x| -x), t_max: f32::INFINITY, ..*ray };
                let forward = Ray { t_max: f32::INFINITY, ..*ray };
                let count = match [forward, backward].map(|ray| hits::<Exact>(&ray, corners).is_some()).into()
                {
                    (false, false) => &mut beside,
                    (false, true) if matches!(apex, Apex::Origin(_)) => &mut behind,
                    _ => continue,
                };
                *count = [count[0] + 1, count[1] + usize::from(told == (true, true))];
            }
        }
    }
    println!("{met} hits; beside and behind, and of them not told: {beside:?} {behind:?}");
    assert!(
        met > 50_000 && beside[1] * 20 < beside[0] && behind[1] * 20 < behind[0],
        "{beside:?} {behind:?}"
    );
}

#[test]
fn a_meeting_that_edges_tell_is_one_and_within_their_bounds() {
    let (mut met, mut told, mut narrow) = (0, 0, 0);
    for seed in 0..20_000 {
        let dice = &mut Dice(seed);
        let (mut rays, apex) = beam(dice);
        let triangles: [_; WIDTH] = std::array::from_fn(|_| triangle(&rays, apex, dice).0);
        let scale = [1.0, 1e-6, 1e9, 1e-18][dice.below(4)];
        let apex = scaled(&mut rays, apex, scale);
        let Some(frustum) = around(&rays, apex, false, scale).filter(|frustum| frustum.tells_meetings) else {
            continue;
        };
        let triangles = triangles.map(|corners| corners.map(|p| p.map(|x| x * scale)));
        let corners = three(|v| frustum.view().point(|k| f32x8::from_fn(|i| triangles[i][v][k])));
        let [a, b, c] = corners;
        let sight = frustum.sight(&[a.min(b).min(c), a.max(b).max(c)]);
        let edges = frustum.edges((seed % 3 != 0).then_some(&sight), corners);
        for (i, corners) in triangles.into_iter().enumerate() {
            for (r, ray) in rays.iter().enumerate() {
                if frustum.packets(&sight, i) >> (r / WIDTH) & 1 == 0 {
                    continue;
                }
                let seen = edges.meeting(i, frustum.eight(r / WIDTH));
                let (near, far) = (seen.near.get(r % WIDTH), seen.far.get(r % WIDTH));
                let endless = Ray { t_min: f32::NEG_INFINITY, t_max: f32::INFINITY, ..*ray };
                let t = hits::<Watertight>(&endless, corners);
                met += usize::from(t.is_some());
                if seen.inside.bits() >> (r % WIDTH) & 1 != 0 {
                    told += 1;
                    assert!(
                        t.is_some_and(|t| near <= t && t <= far),
                        "{t:?} in {near} to {far}: {ray:?} {corners:?} {apex:?}, seed {seed}"
                    );
                    narrow += usize::from(far - near < 1e-4 * far.abs());
                } else {
                    assert!(near == f32::NEG_INFINITY && far == f32::INFINITY);
                }
            }
        }
    }
    println!("{met} hits, {told} told, {narrow} narrowly");
    assert!(told * 2 > met && narrow > 10_000, "{narrow} of {told} of {met}");
}

/// Calls with each ray of a beam and each triangle that it certainly passes inside of, triangles on which rays start among them;
/// and with what its plane says of the packet, and the ray's lane.
fn inside_of_planes(
    seed: u64,
    is_asked: impl Fn(Apex) -> bool,
    mut call: impl FnMut(&Ray, [[f32; 3]; 3], Plane, &RayLanes<f32x8>, usize),
) {
    let dice = &mut Dice(seed);
    let (mut rays, apex) = beam(dice);
    if !is_asked(apex) {
        return;
    }
    let triangles: [_; WIDTH] = std::array::from_fn(|_| match dice.below(2) {
        0 => triangle(&rays, apex, dice).0,
        _ => under_a_start(&rays, dice),
    });
    let scale = [1.0, 1e-6, 1e9][dice.below(3)];
    let apex = scaled(&mut rays, apex, scale);
    let Some(frustum) = around(&rays, apex, false, scale) else { return };
    let triangles = triangles.map(|corners| corners.map(|p| p.map(|x| x * scale)));
    let corners = three(|v| frustum.view().point(|k| f32x8::from_fn(|i| triangles[i][v][k])));
    let edges = frustum.edges(None, corners);
    for (i, corners) in triangles.into_iter().enumerate() {
        for (j, packet) in packets(&rays).iter().enumerate() {
            let (may, must) = edges.may_and_must_pass(i, frustum.eight(j));
            assert_eq!(may & must, must);
            for lane in (0..WIDTH).filter(|lane| must >> lane & 1 != 0) {
                call(&rays[j * WIDTH + lane], corners, frustum.plane(corners), packet, lane);
            }
        }
    }
}

#[test]
fn what_planes_tell_of_shadow_rays_is_what_the_triangle_test_says() {
    let (mut met, mut missed, mut left) = (0, 0, 0);
    for seed in 0..40_000 {
        inside_of_planes(seed, Apex::is_target, |ray, corners, plane, packet, lane| {
            let [hit, miss] = plane.sides(packet, packet.t_max).map(|lanes| lanes.bits() >> lane & 1 != 0);
            let is_hit = hits::<Watertight>(ray, corners).is_some();
            let is_wrong = if is_hit { miss } else { hit };
            assert!(!is_wrong, "hit: {is_hit}, {ray:?} {corners:?}, seed {seed}");
            (met, missed) = (met + usize::from(hit), missed + usize::from(miss));
            left += usize::from(!hit && !miss);
        });
    }
    println!("{met} hits, {missed} misses, {left} left");
    assert!(met > 50_000 && missed > 50_000 && left < met + missed, "{met} {missed} {left}");
}

#[test]
fn a_meeting_that_planes_tell_is_one_and_within_their_bounds() {
    let (mut told, mut left) = (0, 0);
    for seed in 0..40_000 {
        inside_of_planes(seed, Apex::is_behind, |ray, corners, plane, packet, lane| {
            let seen = plane.meeting(Mask::splat(true), packet);
            let (near, far) = (seen.near.get(lane), seen.far.get(lane));
            let endless = Ray { t_min: f32::NEG_INFINITY, t_max: f32::INFINITY, ..*ray };
            let t = hits::<Watertight>(&endless, corners);
            let is_within = t.is_some_and(|t| near <= t && t <= far);
            assert!(is_within, "{t:?} in {near} to {far}: {ray:?} {corners:?}, seed {seed}");
            told += usize::from(far - near < 1e-5 * far.abs());
            left += usize::from(far == f32::INFINITY);
        });
    }
    println!("{told} told, {left} left");
    assert!(told > 50_000 && left < told, "{told} {left}");
}

/// Slopes of the shortest directions would overflow, and those of the longest lose digits: such rays lost hits.
#[test]
fn directions_too_short_or_long_for_slopes_make_no_pyramid() {
    let around = |length: f32, asked: bool| {
        let dice = &mut Dice(5);
        let mut beams = std::iter::repeat_with(|| beam(dice));
        let found = beams.find(|(_, apex)| matches!(apex, Apex::Origin(_)));
        let (mut rays, apex) = found.expect("one of many");
        for ray in rays.iter_mut().skip(1).step_by(5) {
            ray.direction = ray.direction.map(|x| x * length);
            ray.t_max = if asked { f32::INFINITY } else { f32::NEG_INFINITY };
        }
        around(&rays, apex, false, 1.0)
    };
    for length in [1e-20, 1.0, 1e20] {
        assert!(around(length, true).is_some(), "{length}");
    }
    for length in [1e-42, 1e-40, 1e38] {
        assert!(around(length, true).is_none(), "{length}");
        assert!(around(length, false).is_some(), "{length}, not asked");
    }
}

#[test]
fn the_image_behind_a_mirror_is_found() {
    let dice = &mut Dice(7);
    let (camera, mirror) = ([0.3, 0.2, 2.0], -1.0);
    let ray = |dice: &mut Dice| {
        let at = [dice.between(-0.2, 0.2), dice.between(-0.2, 0.2), mirror];
        let d: [f64; 3] = three(|k| at[k] - camera[k]);
        Ray::new(at.map(|x| x as f32), [d[0] as f32, d[1] as f32, -d[2] as f32])
    };
    let rays: Vec<Ray> = (0..GROUP * WIDTH).map(|_| ray(dice)).collect();
    let world = TreeRoot::new(0, &Aabb { min: [-4.0; 3], max: [4.0; 3] });
    let image = focus::<Watertight>(&packets(&rays), world);
    let expected = Vec3::new(0.3, 0.2, 2.0 * mirror as f32 - 2.0);
    let off = image.map(|p| (Vec3::new(p[0], p[1], p[2]) - expected).abs().max_component());
    assert!(off.is_some_and(|off| off < 1e-4), "{image:?}");
}
