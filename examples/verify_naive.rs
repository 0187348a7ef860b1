//! The verification of octray, run on two intersectors as tutorials have them. Both fail where they are known to. Then its
//! bench times one of them on the same rays.
//!
//! ```sh
//! cargo run --release --example verify_naive
//! ```

use std::error::Error;

use octray::describe::builtin;
use octray::measure::bench::{Class, Options, Subject, View, bench_scene, box_tests_a_second};
use octray::measure::verify::{
    Bounds, Effort, Family, FamilyReport, Intersector, Shape, peer_scene, verify_intersector,
};
use octray::scene::Scene;
use octray::{Ray, TierName};

type Point = [f32; 3];

fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Point, b: Point) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Moeller and Trumbore's test with an absolute epsilon.
struct NaiveTriangles;

const EPSILON: f32 = 1e-6;

fn meet([a, b, c]: [Point; 3], ray: &Ray) -> Option<f32> {
    let (e1, e2, s) = (sub(b, a), sub(c, a), sub(ray.origin, a));
    let p = cross(ray.direction, e2);
    let determinant = dot(e1, p);
    if determinant.abs() < EPSILON {
        return None;
    }
    let u = dot(s, p) / determinant;
    let q = cross(s, e1);
    let v = dot(ray.direction, q) / determinant;
    let t = dot(e2, q) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > ray.t_min && t < ray.t_max).then_some(t)
}

impl Intersector for NaiveTriangles {
    type Scene = Vec<[Point; 3]>;

    fn build(&self, shapes: &[Shape]) -> Option<Self::Scene> {
        let corners = |shape: &Shape| match shape {
            Shape::Triangle(corners) => Some(*corners),
            _ => None,
        };
        shapes.iter().map(corners).collect()
    }

    fn nearest(&self, scene: &Self::Scene, ray: &Ray) -> Option<f32> {
        scene.iter().filter_map(|corners| meet(*corners, ray)).min_by(f32::total_cmp)
    }
}

/// The slab test as it is first written: zero times infinity is not looked for.
struct NaiveSlabs;

impl Intersector for NaiveSlabs {
    type Scene = (Point, Point);

    fn build(&self, shapes: &[Shape]) -> Option<Self::Scene> {
        match shapes {
            [Shape::Box { min, max }] => Some((*min, *max)),
            _ => None,
        }
    }

    fn nearest(&self, (min, max): &Self::Scene, ray: &Ray) -> Option<f32> {
        let (mut enter, mut leave) = (ray.t_min, ray.t_max);
        for k in 0..3 {
            let reciprocal = 1.0 / ray.direction[k];
            let (a, b) = ((min[k] - ray.origin[k]) * reciprocal, (max[k] - ray.origin[k]) * reciprocal);
            let (near, far) = if a < b { (a, b) } else { (b, a) };
            enter = if near > enter { near } else { enter };
            leave = if far < leave { far } else { leave };
            if near.is_nan() || far.is_nan() || enter > leave {
                return None;
            }
        }
        Some(enter)
    }
}

/// Verifies over a family and tells what was found.
fn verify(name: &str, intersector: &impl Intersector, family: &str) -> Result<FamilyReport, String> {
    let family = Family::named(family).ok_or_else(|| format!("no family is called {family}"))?;
    let effort = Effort { rays: 20_000, seed: 1 };
    let report = verify_intersector(name, intersector, family, &Bounds::default(), effort);
    let report = report.ok_or_else(|| format!("{name} knows no shape of {}", family.name))?;
    let found = report.rates.iter().filter(|rate| rate.count > 0);
    let found: Vec<String> = found.map(|rate| format!("{} {:.0}", rate.what, rate.per_million)).collect();
    let ulps = report.t_ulps.map_or(String::new(), |t| format!("; t p99 {:.3} ulp", t.p99));
    println!("{name}, {}, a million rays: {}{ulps}", family.name, found.join(", "));
    Ok(report)
}

/// Fails unless a fault that the intersector is known for was found.
fn expect(report: &FamilyReport, fault: &str) -> Result<(), String> {
    let is_found = report.rate(fault).is_some_and(|rate| rate.count > 0);
    if is_found { Ok(()) } else { Err(format!("{} has no {fault} in {}", report.tier, report.family)) }
}

/// Times the triangles on a small terrain beside octray, and compares what they say.
fn bench() -> Result<(), Box<dyn Error>> {
    let terrain = builtin("terrain:1000")?.ok_or("no such scene")?;
    let subject = Subject::new("terrain".into(), Scene::compile(&terrain)?, View::Outside).ok_or("empty")?;
    let peer = peer_scene("naive Moeller-Trumbore", NaiveTriangles, &subject).ok_or("not only triangles")?;
    let options = Options {
        classes: vec![Class::Primary, Class::Shadow, Class::Random],
        tier: TierName::Watertight,
        size: [64, 64],
        runs: 3,
        peak_box_tests_s: box_tests_a_second(),
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let report = bench_scene(&subject, &[peer], &options, &pool, &|_| ())?;
    for class in &report.classes {
        for engine in &class.engines {
            let (rate, differ) = (engine.mrays_s.median, engine.differs.hits);
            println!(
                "{}, {}: {rate:.3} million rays a second, {differ} of {} answered differently",
                engine.engine, class.class, class.rays
            );
        }
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let triangles = |family| verify("naive Moeller-Trumbore", &NaiveTriangles, family);
    expect(&triangles("closed-inside")?, "leak")?;
    expect(&triangles("closed-outside")?, "leak")?;
    expect(&triangles("triangles")?, "gross miss")?;
    expect(&triangles("triangle-edges")?, "false hit")?;
    triangles("slivers")?;
    let slabs = |family| verify("naive slabs", &NaiveSlabs, family);
    expect(&slabs("boxes")?, "false miss")?;
    expect(&slabs("box-planes")?, "false miss")?;
    bench()
}
