//! Small scenes: every way through the tree gives what the plain loop over all primitives gives, bit for bit.
#![no_main]

use libfuzzer_sys::arbitrary::{self, Arbitrary};
use libfuzzer_sys::fuzz_target;
use octray::accel::stream::{Apex, Bound, HitColumns, RayColumns, RayStream};
use octray::accel::{Accel, Hint, Traversal, brute};
use octray::geometry::{Geometry, Group, Instance, NO_MATERIAL};
use octray::intersect::{Exact, PrimId, RayLanes, Tier, Watertight};
use octray::math::{BitLane, Lane, Real, Transform, Vec3, WIDTH};

/// A coordinate on a grid that makes things touch, beside it, or anywhere moderate.
#[derive(Arbitrary, Clone, Copy, Debug)]
enum Number {
    Grid(i8),
    Beside(i8),
    Anywhere(i16),
}

impl Number {
    fn value(self) -> f32 {
        match self {
            Number::Grid(i) => f32::from(i) * 0.5,
            Number::Beside(i) => (f32::from(i) * 0.5).next_up(),
            Number::Anywhere(i) => f32::from(i) * 1e-3,
        }
    }
}

type Point = [Number; 3];

#[derive(Arbitrary, Clone, Debug)]
enum Shape {
    Triangle([Point; 3]),
    Sphere(Point, Number),
    Cylinder(Point, Point, Number, bool),
    Plane(Point, Point),
}

#[derive(Arbitrary, Debug)]
struct Input {
    shapes: Vec<Shape>,
    shown: Vec<Shape>,
    instances: Vec<[[Number; 4]; 3]>,
    rays: [(Point, Point, Number, Option<Number>); WIDTH],
}

fn push3(columns: &mut [Vec<f32>; 3], point: Point) {
    columns.iter_mut().zip(point).for_each(|(column, x)| column.push(x.value()));
}

fn push(g: &mut Geometry, shape: &Shape) {
    let positive = |x: Number| x.value().abs().max(1e-3);
    let vector = |p: Point| p.map(Number::value);
    match *shape {
        Shape::Triangle(corners) => {
            for (column, corner) in g.triangles.vertex.iter_mut().zip(corners) {
                column.push(g.triangles.position[0].len() as u32);
                push3(&mut g.triangles.position, corner);
            }
            g.triangles.material.push(NO_MATERIAL);
        }
        Shape::Sphere(center, radius) => g.spheres.push(vector(center), positive(radius), NO_MATERIAL),
        Shape::Cylinder(from, to, radius, capped) => {
            let (from, mut to) = (vector(from), vector(to));
            if from == to {
                to[1] += 1.0;
            }
            g.cylinders.push([from, to], positive(radius), capped, NO_MATERIAL);
        }
        Shape::Plane(point, normal) => {
            let normal = vector(normal);
            if normal != [0.0; 3] {
                g.planes.push(vector(point), normal, NO_MATERIAL);
            }
        }
    }
}

fn group(g: &mut Geometry, shapes: &[Shape]) {
    let start = [g.triangles.len(), g.spheres.len(), g.cylinders.len()];
    shapes.iter().for_each(|shape| push(g, shape));
    g.groups.push(Group {
        triangles: start[0]..g.triangles.len(),
        spheres: start[1]..g.spheres.len(),
        cylinders: start[2]..g.cylinders.len(),
    });
}

fn geometry(input: &Input) -> Geometry {
    let mut g = Geometry::default();
    group(&mut g, &input.shapes);
    group(&mut g, &input.shown);
    let place = |rows: &[[Number; 4]; 3]| {
        let rows = rows.map(|row| row.map(|x| f64::from(x.value())));
        let to_world = Transform::from_rows(rows).ok().filter(|t| t.determinant().abs() > 1e-2)?;
        Some(Instance { group: 1, to_world, material: NO_MATERIAL, object: 1 })
    };
    if !input.shown.is_empty() {
        g.instances = input.instances.iter().filter_map(place).collect();
    }
    g
}

fn lanes<T: Tier>(input: &Input) -> RayLanes<T::Wide> {
    let ray = |i: usize| {
        let (origin, direction, t_min, t_max) = input.rays[i];
        let mut direction = direction.map(Number::value);
        if direction == [0.0; 3] {
            direction[2] = 1.0;
        }
        let t_max = t_max.map_or(f32::INFINITY, Number::value);
        let [ox, oy, oz] = origin.map(Number::value);
        let [dx, dy, dz] = direction;
        [ox, oy, oz, dx, dy, dz, t_min.value(), t_max]
    };
    let column = |k: usize| T::Wide::from_fn(|i| T::Real::from_f32(ray(i)[k]));
    RayLanes {
        origin: Vec3::new(column(0), column(1), column(2)),
        direction: Vec3::new(column(3), column(4), column(5)),
        t_min: column(6),
        t_max: column(7),
    }
}

type Bits = (u64, u64, u64, u32, u32);

fn check<T: Tier>(geometry: &Geometry, accel: &Accel, rays: &RayLanes<T::Wide>) {
    let bits = |x: T::Real| x.to_f64().to_bits();
    let plainly = |i: usize| -> Option<Bits> {
        let hit = brute::closest::<T>(geometry, &rays.get(i))?;
        let id = |prim: PrimId| (prim.kind() as u32) << 29 | prim.row() as u32;
        Some((bits(hit.t), bits(hit.u), bits(hit.v), id(hit.prim), hit.instance))
    };
    let expected: [Option<Bits>; WIDTH] = std::array::from_fn(plainly);
    let any: u32 = (0..WIDTH).map(|i| u32::from(expected[i].is_some()) << i).sum();
    let mut traversal = Traversal::new(accel);
    for hint in [Hint::Coherent, Hint::Incoherent, Hint::Auto] {
        let found = traversal.closest::<T>(rays, hint);
        for (i, expected) in expected.iter().enumerate() {
            let hit = found.t.get(i) < rays.t_max.get(i);
            let [t, u, v] = [found.t, found.u, found.v].map(|x| bits(x.get(i)));
            let found = hit.then(|| (t, u, v, found.prim.get(i), found.instance.get(i)));
            assert_eq!(found, *expected, "{:?} {hint:?}, ray {i}", T::NAME);
        }
        assert_eq!(traversal.any::<T>(rays, hint), any, "any, {:?} {hint:?}", T::NAME);
        check_streams::<T>(accel, rays, hint, &expected);
    }
}

/// Streams, told nothing or that the rays have in common what the first of them has: true or not, results do not change.
/// A packet, and as many as a large bundle is made of: the same rays again and again, each time by one lane further.
fn check_streams<T: Tier>(
    accel: &Accel,
    rays: &RayLanes<T::Wide>,
    hint: Hint,
    expected: &[Option<Bits>; WIDTH],
) {
    for rows in [WIDTH, (WIDTH + 1) * WIDTH] {
        check_rows::<T>(accel, (rays, rows), hint, expected);
    }
}

fn check_rows<T: Tier>(
    accel: &Accel,
    (rays, rows): (&RayLanes<T::Wide>, usize),
    hint: Hint,
    expected: &[Option<Bits>; WIDTH],
) {
    let ray = |row: usize| (row + row / WIDTH) % WIDTH;
    let column = |v: T::Wide| -> Vec<T::Real> { (0..rows).map(|row| v.get(ray(row))).collect() };
    let axes = |v: Vec3<T::Wide>| [column(v.x), column(v.y), column(v.z)];
    let (origin, direction) = (axes(rays.origin), axes(rays.direction));
    let (t_min, t_max) = (column(rays.t_min), column(rays.t_max));
    let columns = RayColumns {
        len: rows,
        origin: origin.each_ref().map(|c| &c[..]),
        direction: direction.each_ref().map(|c| &c[..]),
        t_min: Bound::Each(&t_min),
        t_max: Bound::Each(&t_max),
    };
    let start = origin.each_ref().map(|c| c[0].to_f32());
    let end = std::array::from_fn(|k| start[k] + direction[k][0].to_f32());
    let mut stream = RayStream::<T>::new(accel);
    for apex in [None, Some(Apex::Origin(start)), Some(Apex::Target(end))] {
        let real = || vec![T::Real::default(); rows];
        let (mut t, mut u, mut v) = (real(), real(), real());
        let (mut prim, mut instance, mut occluded) = (vec![0; rows], vec![0; rows], vec![0; rows / WIDTH]);
        let mut hits =
            HitColumns { t: &mut t, u: &mut u, v: &mut v, prim: &mut prim, instance: &mut instance };
        stream.closest(&columns, apex, hint, &mut hits);
        stream.any(&columns, apex, hint, &mut occluded);
        let bits = |x: T::Real| x.to_f64().to_bits();
        for row in 0..rows {
            let expected = expected[ray(row)];
            let hit = (bits(t[row]), bits(u[row]), bits(v[row]), prim[row], instance[row]);
            let found = (t[row] < t_max[row]).then_some(hit);
            assert_eq!(found, expected, "{:?} {hint:?} {apex:?}, row {row} of {rows}", T::NAME);
            let any = occluded[row / WIDTH] >> (row % WIDTH) & 1 != 0;
            assert_eq!(any, expected.is_some(), "any, {:?} {hint:?} {apex:?}, row {row} of {rows}", T::NAME);
        }
    }
}

fuzz_target!(|input: Input| {
    let geometry = geometry(&input);
    let accel = Accel::build(&geometry);
    check::<Watertight>(&geometry, &accel, &lanes::<Watertight>(&input));
    check::<Exact>(&geometry, &accel, &lanes::<Exact>(&input));
});
