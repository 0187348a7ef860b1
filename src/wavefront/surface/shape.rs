//! The surface of each kind of primitive where a ray met it, in the space that its columns are in.

use super::{Double, HitLanes, SurfaceLanes, Wanted, roundoffs};
use crate::geometry::{Geometry, entries, gather, gather3};
use crate::intersect::PrimKind;
use crate::math::{Vec3, WIDTH, three};

/// The surfaces, and the largest coordinates of their primitives.
#[inline(always)]
pub(super) fn evaluate<D: Double>(
    g: &Geometry,
    kind: PrimKind,
    hit: &HitLanes<D>,
    wanted: Wanted,
) -> (SurfaceLanes<D>, D) {
    match kind {
        PrimKind::Triangle => triangle(g, hit, wanted),
        PrimKind::Sphere => sphere(g, hit, wanted),
        PrimKind::Cylinder => cylinder(g, hit),
        PrimKind::Plane => plane(g, hit),
    }
}

/// The point by its barycentric weights, which is nearer to the plane than `o + t d`.
///
/// **Source:** Pharr, Jakob and Humphreys, 4th ed., 6.8.5: gamma(7) of the sum of magnitudes.
#[inline(always)]
fn triangle<D: Double>(g: &Geometry, hit: &HitLanes<D>, wanted: Wanted) -> (SurfaceLanes<D>, D) {
    let t = &g.triangles;
    let vertex = three(|k| entries(&t.vertex[k], &hit.row));
    // Written out: a closure of this size is called.
    let [p0, p1, p2] = [
        gather3::<D>(&t.position, &vertex[0]),
        gather3::<D>(&t.position, &vertex[1]),
        gather3::<D>(&t.position, &vertex[2]),
    ];
    let weights = [D::one() - hit.u - hit.v, hit.u, hit.v];
    let [a, b, c] = [p0 * weights[0], p1 * weights[1], p2 * weights[2]];
    let sizes = (a.abs() + b.abs() + c.abs()).max_component();
    let geometric_normal = (p1 - p0).cross(p2 - p0).normalize();
    let shading_normal = match wanted.shading_normal && !t.normal[0].is_empty() {
        false => geometric_normal,
        true => smooth_normal(three(|k| gather3::<D>(&t.normal, &vertex[k])), weights, geometric_normal),
    };
    let uv = match wanted.uv && !t.uv[0].is_empty() {
        false => (hit.u, hit.v),
        true => (blend(&t.uv[0], &vertex, weights), blend(&t.uv[1], &vertex, weights)),
    };
    let error = sizes * roundoffs(7);
    let size = p0.abs().max(p1.abs()).max(p2.abs()).max_component();
    (SurfaceLanes { point: a + b + c, error, geometric_normal, shading_normal, uv }, size)
}

/// A vertex column at barycentric weights.
#[inline(always)]
fn blend<D: Double>(column: &[f32], vertex: &[[u32; WIDTH]; 3], [a, b, c]: [D; 3]) -> D {
    let [x, y, z] = three(|k| gather::<D>(column, &vertex[k]));
    x * a + y * b + z * c
}

/// The interpolated normal, on the side of the geometric one; that one itself where a vertex has none.
#[inline(always)]
fn smooth_normal<D: Double>([n0, n1, n2]: [Vec3<D>; 3], [w, u, v]: [D; 3], geometric: Vec3<D>) -> Vec3<D> {
    let zero = D::zero();
    let given = n0.length_squared().gt(zero) & n1.length_squared().gt(zero) & n2.length_squared().gt(zero);
    let sum = n0 * w + n1 * u + n2 * v;
    let same_side = Vec3::select(sum.dot(geometric).lt(zero), -sum, sum);
    let usable = given & same_side.length_squared().gt(D::constant(1e-12));
    Vec3::select(usable, same_side.normalize(), geometric)
}

/// The point pulled back to the sphere along its radius: 8 roundoffs off it. With as many as the primitive test of tier `Exact`
/// allows for the place of a ray's start, and some for the offset, that test is in no doubt about rays that leave.
#[inline(always)]
fn sphere<D: Double>(g: &Geometry, hit: &HitLanes<D>, wanted: Wanted) -> (SurfaceLanes<D>, D) {
    let s = &g.spheres;
    let (center, radius) = (gather3::<D>(&s.center, &hit.row), gather::<D>(&s.radius, &hit.row));
    let normal = (hit.origin + hit.direction * hit.t - center).normalize();
    let size = center.abs().max_component() + radius;
    let surface = SurfaceLanes {
        point: center + normal * radius,
        error: size * roundoffs(20),
        geometric_normal: normal,
        shading_normal: normal,
        uv: if wanted.uv { octahedral(normal) } else { (hit.u, hit.v) },
    };
    (surface, size)
}

/// The unit sphere unfolded to the unit square: a texture map of arithmetic alone, where longitude and latitude would
/// need inverse functions.
///
/// **Source:** Cigolle et al., A Survey of Efficient Representations for Independent Unit Vectors, 2014.
#[inline(always)]
fn octahedral<D: Double>(n: Vec3<D>) -> (D, D) {
    let (half, one) = (D::constant(0.5), D::one());
    let scale = one / (n.x.abs() + n.y.abs() + n.z.abs());
    let (x, z) = (n.x * scale, n.z * scale);
    let fold = |a: D, b: D| (one - b.abs()).with_sign_of(a);
    let below = n.y.lt(D::zero());
    let (a, b) = (D::select(below, fold(x, z), x), D::select(below, fold(z, x), z));
    (a * half + half, b * half + half)
}

/// The point pulled back to the side along its radius, or to the cap along the axis: 20 roundoffs off it, and more as for spheres, of
/// the distance from an end, which may be 3.5 times the largest coordinate.
#[inline(always)]
fn cylinder<D: Double>(g: &Geometry, hit: &HitLanes<D>) -> (SurfaceLanes<D>, D) {
    let c = &g.cylinders;
    let (from, to) = (gather3::<D>(&c.from, &hit.row), gather3::<D>(&c.to, &hit.row));
    let radius = gather::<D>(&c.radius, &hit.row);
    let axis = (to - from).normalize();
    let raw = hit.origin + hit.direction * hit.t;
    let along = axis * (raw - from).dot(axis);
    let outward = (raw - from - along).normalize();
    let is_side = hit.u.lt(D::constant(0.5));
    let at_to = hit.u.gt(D::constant(1.5));
    let cap = Vec3::select(at_to, to, from);
    let on_cap = raw - axis * (raw - cap).dot(axis);
    let normal = Vec3::select(is_side, outward, Vec3::select(at_to, axis, -axis));
    let size = from.abs().max(to.abs()).max_component() + radius;
    let surface = SurfaceLanes {
        point: Vec3::select(is_side, from + along + outward * radius, on_cap),
        error: size * roundoffs(96),
        geometric_normal: normal,
        shading_normal: normal,
        uv: (hit.u, hit.v),
    };
    (surface, size)
}

/// The point pulled back to the plane along its normal.
#[inline(always)]
fn plane<D: Double>(g: &Geometry, hit: &HitLanes<D>) -> (SurfaceLanes<D>, D) {
    let p = &g.planes;
    let (on, normal) = (gather3::<D>(&p.point, &hit.row), gather3::<D>(&p.normal, &hit.row).normalize());
    let raw = hit.origin + hit.direction * hit.t;
    let point = raw - normal * (raw - on).dot(normal);
    let size = point.abs().max_component() + on.abs().max_component();
    let uv = (point.x, point.z);
    let error = size * roundoffs(12);
    (SurfaceLanes { point, error, geometric_normal: normal, shading_normal: normal, uv }, size)
}
