//! What goes into an intersection test and what comes out.

use crate::math::{Lane, Mask, Vec3, WIDTH, Wide};

/// A ray as users give it. Hits count where `t_min < t < t_max`, with `t` in units of `direction`'s length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where the ray starts.
    pub origin: [f32; 3],
    /// Where it goes; any length but zero.
    pub direction: [f32; 3],
    /// Hits at or before it do not count.
    pub t_min: f32,
    /// Hits at or beyond it do not count.
    pub t_max: f32,
}

impl Ray {
    /// A ray from `origin` without end.
    pub fn new(origin: [f32; 3], direction: [f32; 3]) -> Self {
        Self { origin, direction, t_min: 0.0, t_max: f32::INFINITY }
    }
}

/// The nearest hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance in units of the ray direction's length.
    pub t: f32,
    /// Triangle: barycentric weight of vertex 1. Cylinder: 0 on the side, 1 on the cap at `from`, 2 at `to`.
    pub u: f32,
    /// Triangle: barycentric weight of vertex 2. Cylinder: height from 0 at `from` to 1 at `to`.
    pub v: f32,
    /// What was hit.
    pub prim: PrimId,
    /// Through which instance; 0 where the primitive stands in the scene itself.
    pub instance: u32,
}

/// The kinds of primitive that the tracer knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum PrimKind {
    /// A triangle of a mesh.
    Triangle = 1,
    /// A sphere.
    Sphere = 2,
    /// A cylinder, capped or open.
    Cylinder = 3,
    /// An infinite plane.
    Plane = 4,
}

impl PrimKind {
    /// All kinds, in the order of their numbers.
    pub const ALL: [Self; 4] = [Self::Triangle, Self::Sphere, Self::Cylinder, Self::Plane];

    /// Name as printed.
    pub fn name(self) -> &'static str {
        ["triangle", "sphere", "cylinder", "plane"][self as usize - 1]
    }
}

/// Which primitive: its kind and its row among the columns of that kind.
///
/// Where two hits have the same `t`, the lower id counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PrimId(pub(crate) u32);

impl PrimId {
    pub(crate) const ROW_BITS: u32 = 29;
    /// Rows that one kind can have.
    pub const MAX_ROWS: usize = 1 << Self::ROW_BITS;

    /// The id of row `row` of a kind. **Panics** beyond [`PrimId::MAX_ROWS`].
    pub fn new(kind: PrimKind, row: usize) -> Self {
        assert!(row < Self::MAX_ROWS, "a scene holds at most 2^29 primitives of a kind");
        Self((kind as u32) << Self::ROW_BITS | row as u32)
    }
    /// The id that a column of hits holds.
    pub fn from_bits(bits: u32) -> Self {
        Self(bits)
    }
    /// The kind.
    #[inline(always)]
    pub fn kind(self) -> PrimKind {
        PrimKind::ALL[(self.0 >> Self::ROW_BITS) as usize - 1]
    }
    /// The row among the columns of the kind.
    #[inline(always)]
    pub fn row(self) -> usize {
        (self.0 & (Self::MAX_ROWS as u32 - 1)) as usize
    }
}

/// Rays as lanes: eight different ones, or one splatted.
#[derive(Clone, Copy, Debug)]
pub struct RayLanes<L> {
    /// Where the rays start.
    pub origin: Vec3<L>,
    /// Where they go; any length but zero.
    pub direction: Vec3<L>,
    /// Hits at or before it do not count.
    pub t_min: L,
    /// Hits at or beyond it do not count; NaN turns a lane off.
    pub t_max: L,
}

impl<L: Lane> RayLanes<L> {
    /// One ray in all lanes.
    pub fn splat(ray: &RayLanes<L::Scalar>) -> Self {
        let (o, d) = (ray.origin, ray.direction);
        Self {
            origin: Vec3::splat([o.x, o.y, o.z]),
            direction: Vec3::splat([d.x, d.y, d.z]),
            t_min: L::splat(ray.t_min),
            t_max: L::splat(ray.t_max),
        }
    }
    /// Lane `i` is `rays(i)`.
    #[inline(always)]
    pub fn gather<'a>(rays: impl Fn(usize) -> &'a RayLanes<L::Scalar>) -> Self
    where
        L::Scalar: 'a,
    {
        Self {
            origin: Vec3::gather(|i| &rays(i).origin),
            direction: Vec3::gather(|i| &rays(i).direction),
            t_min: L::from_fn(|i| rays(i).t_min),
            t_max: L::from_fn(|i| rays(i).t_max),
        }
    }
    /// Lane `i` as a ray of its own.
    pub fn get(&self, i: usize) -> RayLanes<L::Scalar> {
        let [ox, oy, oz] = self.origin.get(i);
        let [dx, dy, dz] = self.direction.get(i);
        RayLanes {
            origin: Vec3 { x: ox, y: oy, z: oz },
            direction: Vec3 { x: dx, y: dy, z: dz },
            t_min: self.t_min.get(i),
            t_max: self.t_max.get(i),
        }
    }
    /// Origin, direction and bounds of `t` one after the other.
    #[inline(always)]
    fn to_columns(self) -> [L; WIDTH] {
        let (o, d) = (self.origin, self.direction);
        [o.x, o.y, o.z, d.x, d.y, d.z, self.t_min, self.t_max]
    }
    /// The reverse of [`RayLanes::to_columns`].
    #[inline(always)]
    pub(crate) fn of_columns([ox, oy, oz, dx, dy, dz, t_min, t_max]: [L; WIDTH]) -> Self {
        Self { origin: Vec3::new(ox, oy, oz), direction: Vec3::new(dx, dy, dz), t_min, t_max }
    }
    /// The same rays in `f64`, exactly.
    #[inline(always)]
    pub fn widen(&self) -> RayLanes<L::Double> {
        RayLanes {
            origin: self.origin.widen(),
            direction: self.direction.widen(),
            t_min: self.t_min.widen(),
            t_max: self.t_max.widen(),
        }
    }
}

impl<L: Wide> RayLanes<L> {
    /// Each of eight rays by itself, in the order of [`RayLanes::of_columns`].
    #[inline(always)]
    pub(crate) fn to_rows(self) -> [L; WIDTH] {
        L::transpose(self.to_columns())
    }
    /// The reverse of [`RayLanes::to_rows`].
    #[inline(always)]
    pub(crate) fn of_rows(rows: [L; WIDTH]) -> Self {
        Self::of_columns(L::transpose(rows))
    }
}

impl From<&Ray> for RayLanes<f32> {
    fn from(r: &Ray) -> Self {
        let v = |a: [f32; 3]| Vec3 { x: a[0], y: a[1], z: a[2] };
        Self { origin: v(r.origin), direction: v(r.direction), t_min: r.t_min, t_max: r.t_max }
    }
}

/// Where the lines of the rays meet the primitives; whether `t` is in range is for the caller to ask.
#[derive(Clone, Copy, Debug)]
pub struct LaneHit<L: Lane> {
    /// Lanes that meet.
    pub mask: L::Mask,
    /// Distance in units of the direction's length.
    pub t: L,
    /// As in [`Hit`].
    pub u: L,
    /// As in [`Hit`].
    pub v: L,
}

impl<L: Lane> LaneHit<L> {
    /// No lane meets anything.
    #[inline(always)]
    pub fn none() -> Self {
        Self { mask: L::Mask::splat(false), t: L::zero(), u: L::zero(), v: L::zero() }
    }
    /// Those of some lanes.
    #[inline(always)]
    pub(crate) fn among(self, lanes: L::Mask) -> Self {
        Self { mask: self.mask & lanes, ..self }
    }
    /// The hit of `f64` lanes rounded to these lanes.
    #[inline(always)]
    pub fn narrow(hit: LaneHit<L::Double>) -> Self {
        Self { mask: L::narrow_mask(hit.mask), t: L::narrow(hit.t), u: L::narrow(hit.u), v: L::narrow(hit.v) }
    }
}
