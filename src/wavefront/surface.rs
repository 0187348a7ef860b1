//! From hits to surfaces: where the ray met what, evaluated from the tiny hit, eight at a time by primitive kind.
//!
//! All of it in `f64` and rounded once: a point on a ground sphere of radius 1e6 is then as good as its coordinates, and
//! the bound that secondary rays are offset by stays a few roundoffs of the point, whatever the primitive's size.

use crate::geometry::{Geometry, entries, gather, gather3};
use crate::intersect::PrimKind;
use crate::math::{Lane, Mask, Real, Transform, Vec3, WIDTH, gamma_of, three};

/// Hits as lanes.
#[derive(Clone, Copy)]
pub(crate) struct HitLanes<L: Lane> {
    pub(crate) origin: Vec3<L>,
    pub(crate) direction: Vec3<L>,
    pub(crate) t: L,
    pub(crate) u: L,
    pub(crate) v: L,
    /// Rows among the columns of the kind.
    pub(crate) row: [u32; WIDTH],
    /// Through which instance; 0 is none.
    pub(crate) instance: [u32; WIDTH],
}

/// Surfaces as lanes. Normals have length one and point outwards, as the primitive defines it.
#[derive(Clone, Copy)]
pub(crate) struct SurfaceLanes<L> {
    pub(crate) point: Vec3<L>,
    /// Bound on what each coordinate of `point` is off the surface.
    pub(crate) error: L,
    pub(crate) geometric_normal: Vec3<L>,
    pub(crate) shading_normal: Vec3<L>,
    pub(crate) uv: (L, L),
}

/// Lanes of `f64`, which all of this is evaluated in.
pub(super) trait Double: Lane<Scalar = f64, Double = Self> {}
impl<D: Lane<Scalar = f64, Double = D>> Double for D {}

/// `n` roundoffs of a number type.
fn roundoffs<L: Lane>(n: u32) -> L {
    L::constant(gamma_of(n, <L::Scalar as Real>::ROUNDOFF))
}

impl<L: Lane> HitLanes<L> {
    fn widen(&self) -> HitLanes<L::Double> {
        HitLanes {
            origin: self.origin.widen(),
            direction: self.direction.widen(),
            t: self.t.widen(),
            u: self.u.widen(),
            v: self.v.widen(),
            row: self.row,
            instance: self.instance,
        }
    }
}

impl<L: Lane> SurfaceLanes<L> {
    /// `yes` where the mask is true, `no` elsewhere.
    pub(super) fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self {
            point: Vec3::select(mask, yes.point, no.point),
            error: L::select(mask, yes.error, no.error),
            geometric_normal: Vec3::select(mask, yes.geometric_normal, no.geometric_normal),
            shading_normal: Vec3::select(mask, yes.shading_normal, no.shading_normal),
            uv: (L::select(mask, yes.uv.0, no.uv.0), L::select(mask, yes.uv.1, no.uv.1)),
        }
    }
    /// Rounds: one roundoff a coordinate, one for the addition of the offset, one for slack.
    fn narrow(s: SurfaceLanes<L::Double>) -> Self {
        let point = Vec3::<L>::narrow(s.point);
        Self {
            error: L::narrow(s.error) + point.abs().max_component() * roundoffs(3),
            point,
            geometric_normal: Vec3::narrow(s.geometric_normal),
            shading_normal: Vec3::narrow(s.shading_normal),
            uv: (L::narrow(s.uv.0), L::narrow(s.uv.1)),
        }
    }
}

/// The surfaces that rays met, all of one kind.
pub(crate) fn evaluate<L: Lane>(g: &Geometry, kind: PrimKind, hit: &HitLanes<L>) -> SurfaceLanes<L> {
    let hit = hit.widen();
    if g.instances.is_empty() || hit.instance == [0; WIDTH] {
        return SurfaceLanes::narrow(evaluate_local(g, kind, &hit).0);
    }
    let placed = Placement::gather(g, &hit.instance);
    let origin = placed.to_local.point(hit.origin);
    let local = HitLanes { origin, direction: placed.to_local.direction(hit.direction), ..hit };
    let (surface, size) = evaluate_local(g, kind, &local);
    let seen_through = (0..WIDTH).map(|i| u32::from(hit.instance[i] != 0) << i).sum();
    // Lanes without instance are what they are alone, to the bit.
    let world = placed.to_world::<L>(&surface, size);
    SurfaceLanes::narrow(SurfaceLanes::select(Mask::from_bits(seen_through), world, surface))
}

/// The surfaces, and the largest coordinates of their primitives.
#[inline(always)]
fn evaluate_local<D: Double>(g: &Geometry, kind: PrimKind, hit: &HitLanes<D>) -> (SurfaceLanes<D>, D) {
    match kind {
        PrimKind::Triangle => triangle(g, hit),
        PrimKind::Sphere => sphere(g, hit),
        PrimKind::Cylinder => cylinder(g, hit),
        PrimKind::Plane => plane(g, hit),
    }
}

/// The point by its barycentric weights, which is nearer to the plane than `o + t d`.
///
/// **Source:** Pharr, Jakob and Humphreys, 4th ed., 6.8.5: gamma(7) of the sum of magnitudes.
#[inline(always)]
fn triangle<D: Double>(g: &Geometry, hit: &HitLanes<D>) -> (SurfaceLanes<D>, D) {
    let t = &g.triangles;
    let vertex = three(|k| entries(&t.vertex[k], &hit.row));
    let [p0, p1, p2] = three(|k| gather3::<D>(&t.position, &vertex[k]));
    let weights = [D::one() - hit.u - hit.v, hit.u, hit.v];
    let [a, b, c] = [p0 * weights[0], p1 * weights[1], p2 * weights[2]];
    let sizes = (a.abs() + b.abs() + c.abs()).max_component();
    let geometric_normal = (p1 - p0).cross(p2 - p0).normalize();
    let shading_normal = match t.normal[0].is_empty() {
        true => geometric_normal,
        false => smooth_normal(three(|k| gather3::<D>(&t.normal, &vertex[k])), weights, geometric_normal),
    };
    let uv = match t.uv[0].is_empty() {
        true => (hit.u, hit.v),
        false => (blend(&t.uv[0], &vertex, weights), blend(&t.uv[1], &vertex, weights)),
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

/// The point pulled back to the sphere along its radius.
#[inline(always)]
fn sphere<D: Double>(g: &Geometry, hit: &HitLanes<D>) -> (SurfaceLanes<D>, D) {
    let s = &g.spheres;
    let (center, radius) = (gather3::<D>(&s.center, &hit.row), gather::<D>(&s.radius, &hit.row));
    let normal = (hit.origin + hit.direction * hit.t - center).normalize();
    let size = center.abs().max_component() + radius;
    let surface = SurfaceLanes {
        point: center + normal * radius,
        error: size * roundoffs(8),
        geometric_normal: normal,
        shading_normal: normal,
        uv: octahedral(normal),
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

/// The point pulled back to the side along its radius, or to the cap along the axis.
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
        error: size * roundoffs(20),
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

/// Rows of eight affine maps.
struct Maps<D>([[D; 4]; 3]);

impl<D: Double> Maps<D> {
    fn gather(maps: &[Transform; WIDTH], rows: impl Fn(&Transform) -> [[f64; 4]; 3]) -> Self {
        let all = maps.each_ref().map(rows);
        Self(std::array::from_fn(|r| std::array::from_fn(|c| D::from_fn(|i| all[i][r][c]))))
    }
    fn direction(&self, d: Vec3<D>) -> Vec3<D> {
        let row = |r: &[D; 4]| r[0] * d.x + r[1] * d.y + r[2] * d.z;
        Vec3 { x: row(&self.0[0]), y: row(&self.0[1]), z: row(&self.0[2]) }
    }
    fn point(&self, p: Vec3<D>) -> Vec3<D> {
        let [x, y, z] = self.0.each_ref().map(|r| r[3]);
        self.direction(p) + Vec3 { x, y, z }
    }
    /// The largest sum of magnitudes that makes a coordinate of the image of `p`: what its rounding is relative to.
    fn sizes(&self, p: Vec3<D>) -> D {
        let row = |r: &[D; 4]| (r[0] * p.x).abs() + (r[1] * p.y).abs() + (r[2] * p.z).abs() + r[3].abs();
        let [x, y, z] = self.0.each_ref().map(row);
        x.max(y).max(z)
    }
    /// The transposed linear part applied to `n`.
    fn transposed(&self, n: Vec3<D>) -> Vec3<D> {
        let m = &self.0;
        let column = |c: usize| m[0][c] * n.x + m[1][c] * n.y + m[2][c] * n.z;
        Vec3 { x: column(0), y: column(1), z: column(2) }
    }
    /// How far the longest error a coordinate may have is stretched.
    fn stretch(&self) -> D {
        let [x, y, z] = self.0.each_ref().map(|r| r[0].abs() + r[1].abs() + r[2].abs());
        x.max(y).max(z)
    }
}

/// The transforms of eight instances; the identity where a lane has none.
struct Placement<D> {
    to_world: Maps<D>,
    to_local: Maps<D>,
}

impl<D: Double> Placement<D> {
    fn gather(geometry: &Geometry, instance: &[u32; WIDTH]) -> Self {
        let placed = instance.map(|n| match n {
            0 => Transform::IDENTITY,
            n => geometry.instances[n as usize - 1].to_world,
        });
        Self {
            to_world: Maps::gather(&placed, Transform::rows),
            to_local: Maps::gather(&placed, Transform::inverse_rows),
        }
    }

    /// Points by the transform, normals by its transposed inverse.
    ///
    /// The bound grows by the stretch, and so does what is lost between the spaces: on the way out and on the next ray's way
    /// back in to sums of products that may cancel, and where that ray becomes numbers `L`. Its origin loses 1 roundoff of
    /// `size` by that, the largest coordinate of the primitive, and its direction 2 over the primitive's length; 1 is slack.
    fn to_world<L: Lane<Double = D>>(&self, s: &SurfaceLanes<D>, size: D) -> SurfaceLanes<D> {
        let point = self.to_world.point(s.point);
        let sums = (self.to_local.sizes(point) + size) * roundoffs(8);
        let narrowed = size * D::constant(gamma_of(4, <L::Scalar as Real>::ROUNDOFF));
        SurfaceLanes {
            point,
            error: (s.error + sums + narrowed) * self.to_world.stretch(),
            geometric_normal: self.to_local.transposed(s.geometric_normal).normalize(),
            shading_normal: self.to_local.transposed(s.shading_normal).normalize(),
            uv: s.uv,
        }
    }
}

#[cfg(test)]
mod tests;
