//! The point that rays have in common.

use wide::f32x8;

use super::narrow;
use super::view::View;
use crate::intersect::{RayLanes, Tier};
use crate::math::{Lane, Transform, Vec3};

/// What rays of a stream have in common. It changes time, never results: rays that it is not true of go another way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Apex {
    /// All start here, up to rounding.
    Origin([f32; 3]),
    /// All pass through here, up to rounding, at or beyond their `t_max`.
    Target([f32; 3]),
    /// All would have passed near here had they started earlier: the image of a camera behind a mirror.
    Behind([f32; 3]),
    /// All go the same way, up to rounding, as if from infinitely far: towards a sun, or from an orthographic camera.
    Parallel,
}

impl Apex {
    /// The same, in the space of an instance.
    pub(in super::super) fn in_space_of(self, to_world: &Transform) -> Self {
        let inside = |p: [f32; 3]| to_world.inverted().point(p.map(f64::from)).map(|x| x as f32);
        match self {
            Self::Origin(point) => Self::Origin(inside(point)),
            Self::Target(point) => Self::Target(inside(point)),
            Self::Behind(point) => Self::Behind(inside(point)),
            Self::Parallel => Self::Parallel,
        }
    }

    /// The point, if there is one.
    pub(super) fn point(self) -> Option<[f32; 3]> {
        match self {
            Self::Origin(point) | Self::Target(point) | Self::Behind(point) => Some(point),
            Self::Parallel => None,
        }
    }

    pub(in super::super) fn is_target(self) -> bool {
        matches!(self, Self::Target(_))
    }

    pub(in super::super) fn is_behind(self) -> bool {
        matches!(self, Self::Behind(_))
    }

    /// From the apex along the rays: their directions, or where they come from.
    #[inline(always)]
    pub(super) fn towards<T: Tier>(self, rays: &RayLanes<T::Wide>) -> Vec3<f32x8> {
        match self {
            Self::Target(point) => narrow::<T>(rays.origin) - Vec3::splat(point),
            Self::Origin(_) | Self::Behind(_) | Self::Parallel => narrow::<T>(rays.direction),
        }
    }

    /// Where along `z` rays of these slopes start, 0 at the apex or eye, and how far they pass the apex by, or by how much
    /// their slopes differ from those of the others; infinite where they are not as the apex says.
    #[inline(always)]
    pub(super) fn start<T: Tier>(
        self,
        rays: &RayLanes<T::Wide>,
        view: &View,
        (from, slopes): (Vec3<f32x8>, [f32x8; 2]),
    ) -> (f32x8, f32x8) {
        let (start, by) = match self {
            Self::Origin(_) => (f32x8::ZERO, from.abs().max_component()),
            Self::Target(_) => (f32x8::ZERO, passes_by::<T>(rays, view, from)),
            Self::Behind(_) => (from.z, passed_by(from, slopes)),
            Self::Parallel => (from.z, view.leans_from(slopes)),
        };
        (start, Lane::select(by.ge(f32x8::ZERO), by, f32x8::splat(f32::INFINITY)))
    }
}

/// How far rays from `from` pass by the target; infinite where they are asked for what is beyond it.
#[inline(always)]
fn passes_by<T: Tier>(rays: &RayLanes<T::Wide>, view: &View, from: Vec3<f32x8>) -> f32x8 {
    let d = view.direction(narrow::<T>(rays.direction));
    let t = -from.z / d.z;
    let by = Lane::max((from.x + t * d.x).abs(), (from.y + t * d.y).abs());
    let ends = T::nearest_f32(rays.t_max).le(t * f32x8::splat(1.0 + 4.0 * f32::EPSILON));
    Lane::select(ends, by, f32x8::splat(f32::INFINITY))
}

/// How far rays passed by the apex before they started; infinite where they start before it.
#[inline(always)]
fn passed_by(from: Vec3<f32x8>, [a, b]: [f32x8; 2]) -> f32x8 {
    let by = Lane::max((from.x - a * from.z).abs(), (from.y - b * from.z).abs());
    Lane::select(from.z.ge(f32x8::ZERO), by, f32x8::splat(f32::INFINITY))
}
