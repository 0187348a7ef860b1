//! Rays that start where others hit: away from surfaces, and through glass. Made by the renderer's own steps in each tier.

use super::placed::placed;
use super::{Family, Make, glass};
use crate::accel::brute::{self, NearestHit};
use crate::geometry::{Geometry, Group, Instance, NO_MATERIAL};
use crate::intersect::testing::dice::Dice;
use crate::intersect::{Exact, Fast, Ray, RayLanes, Tier, Watertight};
use crate::math::{Lane, Real, Transform, Vec3, WIDTH};
use crate::measure::verify::bounds::Promise;
use crate::measure::verify::families::aim::{across, add, rounded, towards, triangle};
use crate::measure::verify::tally::{Fault, Tally};
use crate::measure::verify::trial::{Claim, Shape, Trial};
use crate::shading::{fresnel_dielectric, refract};
use crate::wavefront::{HitLanes, evaluate, offset_along};

pub(super) const FAMILIES: &[Family] = &[
    Family {
        name: "leaving",
        about: "from just computed hit points outwards, at any angle; sizes 1e-3 to 1e6, up to 1e3 sizes from the origin",
        promise: Promise::Leaving,
        make: Make::Walks(PATHS, [leaving::<Fast>, leaving::<Watertight>, leaving::<Exact>]),
    },
    Family {
        name: "leaving-instances",
        about: "the same through instances: turned, scaled, pressed to a thousandth, moved to the origin from afar",
        promise: Promise::Leaving,
        make: Make::Walks(
            PATHS,
            [leaving_instances::<Fast>, leaving_instances::<Watertight>, leaving_instances::<Exact>],
        ),
    },
    Family {
        name: "thin-shells",
        about: "from just computed hit points of one of two spheres 4e-6 apart to the other, which an offset may not jump over",
        promise: Promise::Leaving,
        make: Make::Walks(PATHS, [thin_shells::<Fast>, thin_shells::<Watertight>, thin_shells::<Exact>]),
    },
    Family {
        name: "glass-chain",
        about: "through ten glass spheres in a row up to 1e3 from the origin: 20 interfaces, also of ior near 1",
        promise: Promise::Glass,
        make: Make::Walks(PATHS, [glass::chain::<Fast>, glass::chain::<Watertight>, glass::chain::<Exact>]),
    },
    Family {
        name: "glass-solids",
        about: "the same through closed boxes of triangles, or cylinders met at their caps or at their sides",
        promise: Promise::Glass,
        make: Make::Walks(
            PATHS,
            [glass::solids::<Fast>, glass::solids::<Watertight>, glass::solids::<Exact>],
        ),
    },
    Family {
        name: "glass-touching",
        about: "the same where the spheres touch, so that gaps are thinner than any roundoff",
        promise: Promise::Glass,
        make: Make::Walks(
            PATHS,
            [glass::contact::<Fast>, glass::contact::<Watertight>, glass::contact::<Exact>],
        ),
    },
    Family {
        name: "glass-far",
        about: "the same up to 1e5 from the origin, where f32 has seven bits for what lies within a unit",
        promise: Promise::Glass,
        make: Make::Walks(PATHS, [glass::far::<Fast>, glass::far::<Watertight>, glass::far::<Exact>]),
    },
    Family {
        name: "glass-shells",
        about: "through ten glass spheres one inside the other: 20 interfaces",
        promise: Promise::Glass,
        make: Make::Walks(
            PATHS,
            [glass::shells::<Fast>, glass::shells::<Watertight>, glass::shells::<Exact>],
        ),
    },
    Family {
        name: "critical-angle",
        about: "refraction at the critical angle, within some roundoffs: finite, of length one, on the right side",
        promise: Promise::Glass,
        make: Make::Walks(PATHS, [critical::<Fast>, critical::<Watertight>, critical::<Exact>]),
    },
];

/// Paths of a trial.
pub(super) const PATHS: usize = 16;

type Point<R> = Vec3<R>;

/// A ray from a point without end.
fn ray<R: Real>(origin: Point<R>, direction: Vec3<R>) -> RayLanes<R> {
    RayLanes { origin, direction, t_min: R::zero(), t_max: R::constant(f64::INFINITY) }
}

/// A given ray, without end.
fn given<R: Real>(r: &Ray) -> RayLanes<R> {
    ray(vector(r.origin.map(f64::from)), vector(r.direction.map(f64::from)))
}

pub(super) fn vector<R: Real>(v: [f64; 3]) -> Vec3<R> {
    Vec3::splat(v.map(R::from_f64))
}

/// Where a ray met a surface, as the renderer evaluates it.
struct Surface<R> {
    point: Point<R>,
    error: R,
    normal: Vec3<R>,
}

impl<R: Real> Surface<R> {
    fn of<T: Tier<Real = R>>(g: &Geometry, ray: &RayLanes<R>, hit: &NearestHit<R>) -> Self {
        let all = RayLanes::<T::Wide>::splat(ray);
        let lanes = HitLanes {
            origin: all.origin,
            direction: all.direction,
            t: T::Wide::splat(hit.t),
            u: T::Wide::splat(hit.u),
            v: T::Wide::splat(hit.v),
            row: [hit.prim.row() as u32; WIDTH],
            instance: [hit.instance; WIDTH],
        };
        let met = evaluate(g, hit.prim.kind(), &lanes);
        let one = |v: Vec3<T::Wide>| Vec3::splat(v.get(0));
        Self { point: one(met.point), error: met.error.get(0), normal: one(met.geometric_normal) }
    }

    /// A ray that starts on the side of the surface to which it goes.
    fn leave(&self, direction: Vec3<R>) -> RayLanes<R> {
        let outwards = direction.dot(self.normal) > R::zero();
        let normal = if outwards { self.normal } else { -self.normal };
        ray(offset_along(self.point, self.error, normal), direction)
    }
}

fn leaving<T: Tier>(dice: &mut Dice, tally: &mut Tally) {
    let size = dice.magnitude(-3.0, 6.0).abs();
    let away = dice.point().map(|x| x * size * [0.0, 1.0, 1e3][dice.below(3)]);
    let (g, center) = alone(dice, size, away);
    leave::<T>(dice, tally, &g, &Shown { center, size, to_world: Transform::IDENTITY });
}

fn leaving_instances<T: Tier>(dice: &mut Dice, tally: &mut Tally) {
    let size = dice.magnitude(-3.0, 3.0).abs();
    let away = dice.point().map(|x| x * size * [0.0, 1.0, 1e3][dice.below(3)]);
    // Instances show no planes.
    let (mut g, center, group) = loop {
        let (mut g, center) = alone(dice, size, away);
        if let Some(group) = g.groups.pop() {
            break (g, center, group);
        }
    };
    let to_world = placed(dice, center, size);
    g.groups = vec![Group { triangles: 0..0, spheres: 0..0, cylinders: 0..0 }, group];
    g.instances = vec![Instance { group: 1, to_world, material: NO_MATERIAL, object: 1 }];
    leave::<T>(dice, tally, &g, &Shown { center, size, to_world });
}

/// Radii of two spheres around one centre.
const SHELLS: [f32; 2] = [1.0, 1.0 + 4e-6];

/// Inside out from the inner shell, or outside in from the outer one, but not so flat that it could pass the inner one.
fn thin_shells<T: Tier>(dice: &mut Dice, tally: &mut Tally) {
    let center = rounded(dice.point().map(|x| 0.5 * x));
    let shapes = SHELLS.map(|radius| Shape::Sphere { center, radius }).to_vec();
    let g = Trial { shapes, rays: Vec::new(), claim: Claim::Leaving }.geometry();
    let center = center.map(f64::from);
    for _ in 0..PATHS {
        let from = dice.below(2);
        let origin = match from {
            0 => add(center, dice.point(), 0.3),
            _ => add(center, dice.heading(), 2.0),
        };
        let first = given::<T::Real>(&towards(origin, add(center, dice.heading(), [1.0, 0.5][from])));
        let Some(hit) = brute::closest::<T>(&g, &first).filter(|hit| hit.prim.row() == from) else {
            continue;
        };
        let met = Surface::of::<T>(&g, &first, &hit);
        let onwards = met.normal.get(0).map(Real::to_f64);
        let onwards = if from == 0 { onwards } else { onwards.map(|x| -x) };
        let flattest = [dice.magnitude(-7.0, -1.0).abs(), 0.1][from];
        let steep = [dice.between(0.1, 2.0), flattest][dice.below(2)];
        let next = met.leave(vector(add(across(dice, onwards), onwards, steep)));
        tally.rays += 1;
        match brute::closest::<T>(&g, &next) {
            Some(next) if next.prim.row() != from => tally.hits += 1,
            found => {
                tally.add(Fault::SelfHit, || format!("{next:?} leaves shell {from} and comes to {found:?}"))
            }
        }
    }
}

/// What is aimed at, and how it is placed in the world.
struct Shown {
    center: [f64; 3],
    size: f64,
    to_world: Transform,
}

fn leave<T: Tier>(dice: &mut Dice, tally: &mut Tally, g: &Geometry, shown: &Shown) {
    let &Shown { center, size, to_world } = shown;
    for _ in 0..PATHS {
        let reach = [0.5 * size, 1e-3 * size][dice.below(2)];
        let target = to_world.point(add(center, dice.point(), reach));
        let origin = to_world.point(add(center, dice.heading(), 12.0 * size));
        let first = given::<T::Real>(&towards(origin, target));
        let Some(hit) = brute::closest::<T>(g, &first) else { continue };
        let met = Surface::of::<T>(g, &first, &hit);
        let normal = met.normal.get(0).map(Real::to_f64);
        // To the side the ray came from, now and then nearly along the surface.
        let facing =
            if met.normal.dot(first.direction) > T::Real::zero() { normal.map(|x| -x) } else { normal };
        let steep = [dice.unit(), dice.magnitude(-7.0, -1.0).abs()][dice.below(2)];
        let way = add(across(dice, normal), facing, steep);
        let next = met.leave(vector(way));
        tally.rays += 1;
        if let Some(again) = brute::closest::<T>(g, &next) {
            tally.hits += 1;
            tally.add(Fault::SelfHit, || format!("{next:?} leaves {g:?} and hits it at {:?}", again.t));
        }
    }
}

/// One primitive of a size, and a point to aim at: its middle at some place, or, now and then, a point of its surface at the
/// origin, where coordinates are small and what they are computed from is not.
fn alone(dice: &mut Dice, size: f64, away: [f64; 3]) -> (Geometry, [f64; 3]) {
    let through_origin = dice.below(3) == 0;
    let aside = dice.heading();
    let center = |reach: f64| if through_origin { aside.map(|x| x * reach) } else { away };
    let mut plane = Geometry::default();
    let shape = match dice.below(4) {
        0 if through_origin => Shape::Triangle(triangle_through_origin(dice, size)),
        0 => Shape::Triangle(triangle(dice, away, size)),
        1 => Shape::Sphere { center: rounded(center(size)), radius: size as f32 },
        2 => {
            let axis = if through_origin { across(dice, aside) } else { dice.heading() };
            let from = center(0.5 * size);
            let reach = size * dice.magnitude(-1.0, 1.0).abs();
            let from = if through_origin { add(from, axis, -0.5 * reach) } else { from };
            Shape::Cylinder {
                from: rounded(from),
                to: rounded(add(from, axis, reach)),
                radius: (0.5 * size) as f32,
            }
        }
        _ => {
            let normal = if through_origin { across(dice, aside) } else { dice.heading() };
            plane.planes.push(rounded(center(size)), rounded(normal), NO_MATERIAL);
            return (plane, if through_origin { [0.0; 3] } else { away });
        }
    };
    let trial = Trial { shapes: vec![shape], rays: Vec::new(), claim: Claim::Leaving };
    (trial.geometry(), if through_origin { [0.0; 3] } else { away })
}

/// Two corners at random, and the third such that the origin is about in the middle.
fn triangle_through_origin(dice: &mut Dice, size: f64) -> [[f32; 3]; 3] {
    let [a, b, _] = triangle(dice, [0.0; 3], size);
    [a, b, std::array::from_fn(|k| -(a[k] + b[k]))]
}

fn critical<T: Tier>(dice: &mut Dice, tally: &mut Tally) {
    for _ in 0..PATHS {
        let ior = [1.5, 1.33, 2.4, 1.0001, 1.0 + f64::from(f32::EPSILON)][dice.below(5)];
        let sine = (1.0 / ior) * (1.0 + dice.magnitude(-17.0, -6.0));
        let cosine = (1.0 - sine * sine).max(0.0).sqrt();
        let normal = dice.heading();
        let way = add(across(dice, normal).map(|x| x * sine.min(1.0)), normal, cosine);
        let (d, n) = (vector::<T::Real>(way).normalize(), vector::<T::Real>(normal).normalize());
        let eta = T::Real::from_f64(1.0 / ior);
        let ((refracted, total), share) = (refract(d, n, eta), fresnel_dielectric(d.dot(n), eta).to_f64());
        let length = refracted.length().to_f64();
        let along = refracted.dot(n).to_f64();
        tally.rays += 1;
        tally.hits += usize::from(total);
        let right = (0.0..=1.0).contains(&share) && (!total || share == 1.0);
        let goes_on = (length - 1.0).abs() < 1e-6 && along > -1e-6;
        if !(right && (total || goes_on)) {
            tally.add(Fault::SelfHit, || {
                format!("{d:?} at {n:?}, eta {eta:?}: {refracted:?}, total {total}, share {share}")
            });
        }
    }
}
