//! Leaves: up to eight primitives of a kind, stored so that a test loads them as lanes.

mod gather;
mod walk;

pub use gather::Picks;
pub use walk::{PrimitivesByRay, RaysByPrimitive, Walk};

use crate::geometry::Geometry;
use crate::intersect::{PrimId, PrimKind, cylinder, sphere};
use crate::math::{Lane, Vec3, WIDTH, eight, three};
use wide::{f32x8, u32x8};

/// Up to eight triangles by their corners: a shared vertex must be the same three numbers in every triangle.
/// Free lanes, the last ones, hold NaN, which no ray hits, and an id that no primitive has.
///
/// **Shape:** nine columns of eight floats, then eight ids: 320 bytes in five cache lines.
#[repr(C, align(64))]
#[derive(Clone, Debug)]
pub struct TriangleBlock {
    corner: [[[f32; WIDTH]; 3]; 3],
    id: [u32; WIDTH],
}

/// The id in free lanes.
const NO_PRIMITIVE: u32 = u32::MAX;

/// Up to eight spheres.
#[repr(C, align(32))]
#[derive(Clone, Debug)]
pub struct SphereBlock {
    center: [[f32; WIDTH]; 3],
    radius: [f32; WIDTH],
    id: [u32; WIDTH],
    len: u32,
}

/// Up to eight cylinders.
#[repr(C, align(32))]
#[derive(Clone, Debug)]
pub struct CylinderBlock {
    from: [[f32; WIDTH]; 3],
    to: [[f32; WIDTH]; 3],
    radius: [f32; WIDTH],
    id: [u32; WIDTH],
    capped: u32,
    len: u32,
}

/// Lane by lane from the rows of a leaf; NaN beyond them.
#[inline(always)]
fn lanes(rows: &[u32], value: impl Fn(usize) -> f32) -> [f32; WIDTH] {
    eight(|i| rows.get(i).map_or(f32::NAN, |&r| value(r as usize)))
}

fn lanes3(rows: &[u32], columns: &[Vec<f32>; 3]) -> [[f32; WIDTH]; 3] {
    columns.each_ref().map(|c| lanes(rows, |r| c[r]))
}

fn ids(rows: &[u32], kind: PrimKind) -> [u32; WIDTH] {
    eight(|i| rows.get(i).map_or(NO_PRIMITIVE, |&r| PrimId::new(kind, r as usize).0))
}

impl TriangleBlock {
    /// Packs rows of the triangle columns.
    pub fn pack(geometry: &Geometry, rows: &[u32]) -> Self {
        let t = &geometry.triangles;
        let mut corner = [[[f32::NAN; WIDTH]; 3]; 3];
        for (lane, &row) in rows.iter().enumerate() {
            for (corner, vertex) in corner.iter_mut().zip(&t.vertex) {
                let vertex = vertex[row as usize] as usize;
                for (axis, position) in corner.iter_mut().zip(&t.position) {
                    axis[lane % WIDTH] = position[vertex];
                }
            }
        }
        Self { corner, id: ids(rows, PrimKind::Triangle) }
    }
    /// True if the corners are the same bits.
    pub fn stands_as(&self, o: &Self) -> bool {
        let bits = |block: &Self| block.corner.map(|c| c.map(|axis| axis.map(f32::to_bits)));
        bits(self) == bits(o)
    }
    /// Corners, axes and triangles.
    #[inline(always)]
    pub fn corner_columns(&self) -> &[[[f32; WIDTH]; 3]; 3] {
        &self.corner
    }
    /// Corners of the primitives at a step.
    #[inline(always)]
    pub fn corners<W: Walk, L: Lane>(&self, step: usize) -> [Vec3<L>; 3] {
        let [a, b, c] = &self.corner;
        [W::vec3(a, step), W::vec3(b, step), W::vec3(c, step)]
    }
}

impl SphereBlock {
    /// Packs rows of the sphere columns.
    pub fn pack(geometry: &Geometry, rows: &[u32]) -> Self {
        let s = &geometry.spheres;
        Self {
            center: lanes3(rows, &s.center),
            radius: lanes(rows, |r| s.radius[r]),
            id: ids(rows, PrimKind::Sphere),
            len: rows.len() as u32,
        }
    }
    /// Spheres at a step.
    #[inline(always)]
    pub fn spheres<W: Walk, L: Lane>(&self, step: usize) -> sphere::Lanes<L> {
        sphere::Lanes { center: W::vec3(&self.center, step), radius: W::value(&self.radius, step) }
    }
}

impl CylinderBlock {
    /// Packs rows of the cylinder columns.
    pub fn pack(geometry: &Geometry, rows: &[u32]) -> Self {
        let c = &geometry.cylinders;
        let capped = rows.iter().enumerate().map(|(i, &r)| u32::from(c.capped[r as usize]) << i).sum();
        Self {
            from: lanes3(rows, &c.from),
            to: lanes3(rows, &c.to),
            radius: lanes(rows, |r| c.radius[r]),
            id: ids(rows, PrimKind::Cylinder),
            capped,
            len: rows.len() as u32,
        }
    }
    /// Cylinders at a step.
    #[inline(always)]
    pub fn cylinders<W: Walk, L: Lane>(&self, step: usize) -> cylinder::Lanes<L> {
        cylinder::Lanes {
            from: W::vec3(&self.from, step),
            to: W::vec3(&self.to, step),
            radius: W::value(&self.radius, step),
            capped: W::flags(self.capped, step),
        }
    }
}

/// Columns of round primitives.
#[derive(Clone, Copy, Debug)]
pub enum Round<'a> {
    /// Spheres.
    Spheres {
        /// Centres, by axis.
        center: &'a [[f32; WIDTH]; 3],
        /// Radii.
        radius: &'a [f32; WIDTH],
    },
    /// Cylinders.
    Cylinders {
        /// Centres of both caps, by axis.
        ends: [&'a [[f32; WIDTH]; 3]; 2],
        /// Radii.
        radius: &'a [f32; WIDTH],
    },
}

/// A block of primitives that rays are tested against.
pub trait Block {
    /// How many primitives count.
    fn count(&self) -> u32;
    /// Their ids.
    fn ids(&self) -> &[u32; WIDTH];
    /// Their boxes along an axis, least and greatest coordinates, up to a roundoff; NaN in free lanes.
    fn extent(&self, axis: usize) -> [f32x8; 2];
    /// Where they stand, if they are round.
    #[inline(always)]
    fn round(&self) -> Option<Round<'_>> {
        None
    }
    /// The corners, if they are triangles.
    fn corners_of_triangles(&self) -> Option<&[[[f32; WIDTH]; 3]; 3]> {
        None
    }
}

/// What blocks that know their length say of themselves.
macro_rules! counted {
    () => {
        #[inline(always)]
        fn count(&self) -> u32 {
            self.len
        }
        #[inline(always)]
        fn ids(&self) -> &[u32; WIDTH] {
            &self.id
        }
    };
}

impl Block for TriangleBlock {
    #[inline(always)]
    fn count(&self) -> u32 {
        WIDTH as u32 - u32x8::new(self.id).simd_eq(u32x8::splat(NO_PRIMITIVE)).to_bitmask().count_ones()
    }
    #[inline(always)]
    fn ids(&self) -> &[u32; WIDTH] {
        &self.id
    }
    #[inline(always)]
    fn extent(&self, axis: usize) -> [f32x8; 2] {
        let [a, b, c] = three(|v| f32x8::new(self.corner[v][axis]));
        [Lane::min(Lane::min(a, b), c), Lane::max(Lane::max(a, b), c)]
    }
    #[inline(always)]
    fn corners_of_triangles(&self) -> Option<&[[[f32; WIDTH]; 3]; 3]> {
        Some(&self.corner)
    }
}

impl Block for SphereBlock {
    counted!();
    #[inline(always)]
    fn extent(&self, axis: usize) -> [f32x8; 2] {
        let (center, radius) = (f32x8::new(self.center[axis]), f32x8::new(self.radius));
        [center - radius, center + radius]
    }
    #[inline(always)]
    fn round(&self) -> Option<Round<'_>> {
        Some(Round::Spheres { center: &self.center, radius: &self.radius })
    }
}

/// The box of the balls around both ends holds the cylinder.
impl Block for CylinderBlock {
    counted!();
    #[inline(always)]
    fn extent(&self, axis: usize) -> [f32x8; 2] {
        let (from, to) = (f32x8::new(self.from[axis]), f32x8::new(self.to[axis]));
        let radius = f32x8::new(self.radius);
        [Lane::min(from, to) - radius, Lane::max(from, to) + radius]
    }
    #[inline(always)]
    fn round(&self) -> Option<Round<'_>> {
        Some(Round::Cylinders { ends: [&self.from, &self.to], radius: &self.radius })
    }
}
