//! octray in one tier as an intersector: every way of asking, of which one is judged and the others must say the same.

use std::marker::PhantomData;

use super::run::Subject;
use super::tally::{Answers, Numbers};
use super::trial::{Shape, Trial};
use crate::accel::brute::{self, NearestHit};
use crate::accel::query::{Closest, Query};
use crate::accel::stream::{Apex, Bound, HitColumns, RayColumns, RayStream};
use crate::accel::{Accel, Hint, Traversal, lanes};
use crate::geometry::{Geometry, row3};
use crate::intersect::aabb::{CullRay, OwnBox};
use crate::intersect::{Curved, PrimId, PrimKind, Ray, RayLanes, Tier, TriangleTest, cylinder, sphere};
use crate::math::{BitLane, Lane, Mask, Real, Vec3, WIDTH};

/// octray in a tier.
pub(super) struct Octray<T>(pub(super) PhantomData<T>);

const HINTS: [Hint; 3] = [Hint::Auto, Hint::Coherent, Hint::Incoherent];

/// Bits of a hit: `t`, `u`, `v`, primitive.
type Bits = Option<(u64, u64, u64, u32)>;

impl<T: Tier> Subject for Octray<T> {
    fn numbers(&self) -> Numbers {
        Numbers { roundoff: <T::Real as Real>::ROUNDOFF, round: |t| <T::Real as Real>::from_f64(t).to_f64() }
    }

    fn answers(&self, trial: &Trial) -> Option<Answers> {
        if let [Shape::Box { min, max }] = trial.shapes[..] {
            return Some(meet_box::<T>(trial, min, max));
        }
        let geometry = trial.geometry();
        let accel = Accel::build(&geometry);
        let mut asked = Asked::<T> {
            geometry: &geometry,
            traversal: Traversal::new(&accel),
            stream: RayStream::new(&accel),
            apex: trial.common_origin().map(Apex::Origin),
            answers: Answers::default(),
        };
        for packets in trial.rays.chunks(8 * WIDTH) {
            asked.ask(packets);
        }
        Some(asked.answers)
    }
}

/// A scene, every way to ask it, and what was answered.
struct Asked<'a, T: Tier> {
    geometry: &'a Geometry,
    traversal: Traversal<'a>,
    stream: RayStream<'a, T>,
    apex: Option<Apex>,
    answers: Answers,
}

impl<T: Tier> Asked<'_, T> {
    /// Asks up to eight packets.
    fn ask(&mut self, rays: &[Ray]) {
        let packets: Vec<RayLanes<T::Wide>> = rays.chunks(WIDTH).map(usable_lanes::<T>).collect();
        let one = |i: usize| packets[i / WIDTH].get(i % WIDTH);
        let expected: Vec<Bits> = (0..rays.len())
            .map(|i| brute::closest::<T>(self.geometry, &one(i)).map(|hit| bits_of(&hit)))
            .collect();
        let mut agrees = vec![true; rays.len()];
        for (number, packet) in packets.iter().enumerate() {
            let first = number * WIDTH;
            let here = &expected[first..rays.len().min(first + WIDTH)];
            for (i, same) in self.packet_agrees(packet, here).into_iter().enumerate().take(here.len()) {
                agrees[first + i] &= same;
            }
        }
        self.streams_agree(&packets, &expected, &mut agrees);
        let before = self.answers.nearest.len();
        self.answers.differing.extend((0..rays.len()).filter(|&i| !agrees[i]).map(|i| before + i));
        self.answers.nearest.extend(expected.iter().map(|hit| hit.map(|hit| f64::from_bits(hit.0))));
    }

    /// Whether eight lanes and every traversal say what is expected.
    fn packet_agrees(&mut self, rays: &RayLanes<T::Wide>, expected: &[Bits]) -> [bool; WIDTH] {
        let mut agrees = [true; WIDTH];
        let mut compare = |found: &Closest<T::Wide>, any: Option<u32>| {
            for (i, hit) in expected.iter().enumerate() {
                agrees[i] &= lane_bits(found, rays.t_max, i) == *hit;
                agrees[i] &= any.is_none_or(|any| (any >> i & 1 != 0) == hit.is_some());
            }
        };
        compare(&each_primitive::<T>(self.geometry, rays), None);
        for hint in HINTS {
            let any = self.traversal.any::<T>(rays, hint);
            compare(&self.traversal.closest::<T>(rays, hint), Some(any));
        }
        agrees
    }

    fn streams_agree(&mut self, packets: &[RayLanes<T::Wide>], expected: &[Bits], agrees: &mut [bool]) {
        let columns = Columns::<T::Real>::of(packets);
        let rays = columns.rays(expected.len());
        let padded = packets.len() * WIDTH;
        let real = || vec![T::Real::zero(); padded];
        let (mut t, mut u, mut v, mut prim) = (real(), real(), real(), vec![0; padded]);
        let mut occluded = vec![0u8; packets.len()];
        for (hint, apex) in HINTS.into_iter().flat_map(|hint| [(hint, None), (hint, self.apex)]) {
            let mut hits = HitColumns { t: &mut t, u: &mut u, v: &mut v, prim: &mut prim, instance: &mut [] };
            self.stream.closest(&rays, apex, hint, &mut hits);
            self.stream.any(&rays, apex, hint, &mut occluded);
            for (i, hit) in expected.iter().enumerate() {
                let found = (t[i] < columns.t_max[i]).then(|| (bits(t[i]), bits(u[i]), bits(v[i]), prim[i]));
                agrees[i] &= found == *hit && (occluded[i / WIDTH] >> (i % WIDTH) & 1 != 0) == hit.is_some();
            }
        }
    }
}

pub(in crate::measure::verify) fn usable_lanes<T: Tier>(rays: &[Ray]) -> RayLanes<T::Wide> {
    lanes::<T>(rays).unwrap_or_else(|| RayLanes {
        origin: Vec3::zero(),
        direction: Vec3::splat_f32([0.0, 0.0, 1.0]),
        t_min: Lane::zero(),
        t_max: Lane::constant(f64::NEG_INFINITY),
    })
}

fn bits<R: Real>(x: R) -> u64 {
    x.to_f64().to_bits()
}

fn bits_of<R: Real>(hit: &NearestHit<R>) -> (u64, u64, u64, u32) {
    (bits(hit.t), bits(hit.u), bits(hit.v), hit.prim.0)
}

fn lane_bits<L: Lane>(found: &Closest<L>, t_max: L, i: usize) -> Bits {
    let hit = found.t.get(i) < t_max.get(i);
    hit.then(|| (bits(found.t.get(i)), bits(found.u.get(i)), bits(found.v.get(i)), found.prim.get(i)))
}

/// Eight rays against one primitive after the other.
fn each_primitive<T: Tier>(g: &Geometry, rays: &RayLanes<T::Wide>) -> Closest<T::Wide> {
    let mut query = Closest::new(rays.t_max);
    let prepared = T::Triangle::prepare(rays);
    let real = |x: f32| T::Wide::splat(T::Real::from_f32(x));
    let id = |kind, row| BitLane::splat(PrimId::new(kind, row).0);
    for row in 0..g.triangles.len() {
        let corners = g.triangles.corners(row).map(Vec3::splat_f32);
        let hit = T::Triangle::test(rays, &prepared, corners, query.limit());
        query.accept(rays, &hit, id(PrimKind::Triangle, row));
    }
    for row in 0..g.spheres.len() {
        let center = Vec3::splat_f32(row3(&g.spheres.center, row));
        let lanes = sphere::Lanes { center, radius: real(g.spheres.radius[row]) };
        query.accept(rays, &T::Curved::sphere(rays, &lanes), id(PrimKind::Sphere, row));
    }
    for row in 0..g.cylinders.len() {
        let c = &g.cylinders;
        let ends = [&c.from, &c.to].map(|columns| Vec3::splat_f32(row3(columns, row)));
        let capped = Mask::splat(c.capped[row]);
        let lanes = cylinder::Lanes { from: ends[0], to: ends[1], radius: real(c.radius[row]), capped };
        query.accept(rays, &T::Curved::cylinder(rays, &lanes), id(PrimKind::Cylinder, row));
    }
    query
}

/// Rays by columns, for streams.
pub(in crate::measure::verify) struct Columns<R> {
    axes: [Vec<R>; 6],
    t_min: Vec<R>,
    t_max: Vec<R>,
}

impl<R: Real> Columns<R> {
    pub(in crate::measure::verify) fn of<L: Lane<Scalar = R>>(packets: &[RayLanes<L>]) -> Self {
        let column = |of: fn(&RayLanes<L>) -> L| -> Vec<R> {
            packets.iter().flat_map(|packet| (0..WIDTH).map(move |i| of(packet).get(i))).collect()
        };
        Self {
            axes: [
                column(|r| r.origin.x),
                column(|r| r.origin.y),
                column(|r| r.origin.z),
                column(|r| r.direction.x),
                column(|r| r.direction.y),
                column(|r| r.direction.z),
            ],
            t_min: column(|r| r.t_min),
            t_max: column(|r| r.t_max),
        }
    }

    pub(in crate::measure::verify) fn rays(&self, len: usize) -> RayColumns<'_, R> {
        let [ox, oy, oz, dx, dy, dz] = self.axes.each_ref().map(|column| &column[..]);
        let (t_min, t_max) = (Bound::Each(&self.t_min), Bound::Each(&self.t_max));
        RayColumns { len, origin: [ox, oy, oz], direction: [dx, dy, dz], t_min, t_max }
    }
}

/// A box of the tree, which culls in `f32`, and the own box of a primitive, whose lanes must have the bits of the scalar.
fn meet_box<T: Tier>(trial: &Trial, min: [f32; 3], max: [f32; 3]) -> Answers {
    let scale = min.iter().chain(&max).fold(0.0, |m: f32, x| m.max(x.abs()));
    let mut answers = Answers::default();
    for (number, ray) in trial.rays.iter().enumerate() {
        let one = RayLanes::from(ray);
        let cull = CullRay::new(one.origin, one.direction, scale);
        let (lo, hi) = (Vec3::splat(min), Vec3::splat(max));
        let (enter, leave) = cull.interval_any(lo, hi, one.t_min, one.t_max);
        let [(first, last), wide] =
            [own_interval::<T::Real, T>(ray, min, max), own_interval::<T::Wide, T>(ray, min, max)];
        let own = first <= last && last >= f64::from(ray.t_min) && first <= f64::from(ray.t_max);
        answers.nearest.push((enter <= leave && own).then_some(0.0));
        if (first.to_bits(), last.to_bits()) != (wide.0.to_bits(), wide.1.to_bits()) {
            answers.differing.push(number);
        }
    }
    answers
}

/// When the first lane is inside.
fn own_interval<L: Lane<Scalar = T::Real>, T: Tier>(ray: &Ray, min: [f32; 3], max: [f32; 3]) -> (f64, f64) {
    let own = OwnBox::<L>::new(Vec3::splat_f32(ray.origin), Vec3::splat_f32(ray.direction));
    let (first, last) = own.interval(Vec3::splat_f32(min), Vec3::splat_f32(max));
    (first.get(0).to_f64(), last.get(0).to_f64())
}
