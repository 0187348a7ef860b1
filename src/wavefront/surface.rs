//! From hits to surfaces: where the ray met what, evaluated from the tiny hit, eight at a time by primitive kind.
//!
//! All of it in `f64` and rounded once: a point on a ground sphere of radius 1e6 is then as good as its coordinates, and
//! the bound that secondary rays are offset by stays a few roundoffs of the point, whatever the primitive's size.

mod placement;
mod shape;

use crate::geometry::Geometry;
use crate::intersect::PrimKind;
use crate::math::{Lane, Mask, Real, Vec3, WIDTH, gamma_of};
use placement::Placement;

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

/// What of surfaces is asked for beside points and geometric normals, in whose place the other stands if not.
#[derive(Clone, Copy)]
pub(super) struct Wanted {
    pub(super) shading_normal: bool,
    pub(super) uv: bool,
}

/// Lanes of `f64`, which all of this is evaluated in.
pub(super) trait Double: Lane<Scalar = f64, Double = Self> {}
impl<D: Lane<Scalar = f64, Double = D>> Double for D {}

/// `n` roundoffs of a number type.
fn roundoffs<L: Lane>(n: u32) -> L {
    L::constant(gamma_of(n, <L::Scalar as Real>::ROUNDOFF))
}

impl<L: Lane> HitLanes<L> {
    #[inline(always)]
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
    #[inline(always)]
    fn narrow(s: SurfaceLanes<L::Double>, wanted: Wanted) -> Self {
        let point = Vec3::<L>::narrow(s.point);
        let geometric_normal = Vec3::narrow(s.geometric_normal);
        Self {
            error: L::narrow(s.error) + point.abs().max_component() * roundoffs(3),
            point,
            geometric_normal,
            shading_normal: match wanted.shading_normal {
                true => Vec3::narrow(s.shading_normal),
                false => geometric_normal,
            },
            uv: (L::narrow(s.uv.0), L::narrow(s.uv.1)),
        }
    }
}

/// The surfaces that rays met, all of one kind.
pub(crate) fn evaluate<L: Lane>(g: &Geometry, kind: PrimKind, hit: &HitLanes<L>) -> SurfaceLanes<L> {
    evaluate_wanted(g, kind, hit, Wanted { shading_normal: true, uv: true })
}

/// The same where not all is wanted. In line, as is what it is made of: hits and surfaces that are handed over in memory wait
/// there, since they are written and read in pieces of other sizes.
#[inline(always)]
pub(super) fn evaluate_wanted<L: Lane>(
    g: &Geometry,
    kind: PrimKind,
    hit: &HitLanes<L>,
    wanted: Wanted,
) -> SurfaceLanes<L> {
    if g.instances.is_empty() || hit.instance == [0; WIDTH] {
        return SurfaceLanes::narrow(shape::evaluate(g, kind, &hit.widen(), wanted).0, wanted);
    }
    through_instances(g, kind, hit, wanted)
}

#[inline(never)]
fn through_instances<L: Lane>(
    g: &Geometry,
    kind: PrimKind,
    hit: &HitLanes<L>,
    wanted: Wanted,
) -> SurfaceLanes<L> {
    let hit = hit.widen();
    let placed = Placement::gather(g, &hit.instance);
    let origin = placed.to_local.point(hit.origin);
    let local = HitLanes { origin, direction: placed.to_local.direction(hit.direction), ..hit };
    let (surface, size) = shape::evaluate(g, kind, &local, wanted);
    let seen_through = (0..WIDTH).map(|i| u32::from(hit.instance[i] != 0) << i).sum();
    // Lanes without instance are what they are alone, to the bit.
    let world = placed.to_world::<L>(&surface, size);
    SurfaceLanes::narrow(SurfaceLanes::select(Mask::from_bits(seen_through), world, surface), wanted)
}

#[cfg(test)]
mod tests;
