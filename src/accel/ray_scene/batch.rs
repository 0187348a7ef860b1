//! Rays as columns for a stream, and room for what they hit, in the number type of its tier.

use super::is_usable;
use crate::accel::stream::{Apex, Bound, HitColumns, RayColumns};
use crate::intersect::{Hit, PrimId, Ray};
use crate::math::{Real, WIDTH};

/// Some rays, and room for what they hit.
#[derive(Default)]
pub(super) struct Batch<R> {
    origin: [Vec<f32>; 3],
    direction: [Vec<f32>; 3],
    t_min: Vec<f32>,
    t_max: Vec<f32>,
    apex: Option<Apex>,
    t: Vec<R>,
    u: Vec<R>,
    v: Vec<R>,
    prim: Vec<u32>,
    occluded: Vec<u8>,
}

impl<R: Real> Batch<R> {
    /// Takes rays in. Those that can hit nothing take the way of the one before, so that they cannot spoil its packet, and a
    /// `t_max` that tells the stream to leave them alone.
    pub(super) fn load(&mut self, rays: &[Ray]) {
        self.columns().for_each(Vec::clear);
        let mut way = rays.iter().copied().find(is_usable).unwrap_or(Ray::new([0.0; 3], [0.0, 0.0, 1.0]));
        for &ray in rays {
            let usable = is_usable(&ray);
            way = if usable { ray } else { Ray { t_max: f32::NEG_INFINITY, ..way } };
            self.push(&way);
        }
        self.apex = match rays {
            [a, b, ..] if a.origin == b.origin => Some(Apex::Origin(a.origin)),
            [a, b, ..] if a.direction == b.direction => Some(Apex::Parallel),
            _ => None,
        };
    }

    fn columns(&mut self) -> impl Iterator<Item = &mut Vec<f32>> {
        self.origin.iter_mut().chain(&mut self.direction).chain([&mut self.t_min, &mut self.t_max])
    }

    fn push(&mut self, ray: &Ray) {
        for k in 0..3 {
            self.origin[k].push(ray.origin[k]);
            self.direction[k].push(ray.direction[k]);
        }
        self.t_min.push(ray.t_min);
        self.t_max.push(ray.t_max);
    }

    /// What the rays may have in common: if the first two start at one point, or go the same way, maybe all do.
    pub(super) fn apex(&self) -> Option<Apex> {
        self.apex
    }

    /// The rays, and room for their hits.
    pub(super) fn asked_for_hits(&mut self) -> (RayColumns<'_, f32>, HitColumns<'_, R>) {
        let len = self.t_max.len();
        for column in [&mut self.t, &mut self.u, &mut self.v] {
            column.resize(len, R::default());
        }
        self.prim.resize(len, 0);
        let rays = rays(&self.origin, &self.direction, &self.t_min, &self.t_max);
        let (t, u, v) = (&mut self.t[..], &mut self.u[..], &mut self.v[..]);
        (rays, HitColumns { t, u, v, prim: &mut self.prim, instance: &mut [] })
    }

    /// The rays, and room for a bit each.
    pub(super) fn asked_for_any(&mut self) -> (RayColumns<'_, f32>, &mut [u8]) {
        self.occluded.resize(self.t_max.len().div_ceil(WIDTH), 0);
        (rays(&self.origin, &self.direction, &self.t_min, &self.t_max), &mut self.occluded)
    }

    /// The hit of ray `i`.
    pub(super) fn hit(&self, i: usize) -> Option<Hit> {
        (self.t[i] < R::from_f32(self.t_max[i])).then(|| Hit {
            t: self.t[i].to_f32(),
            u: self.u[i].to_f32(),
            v: self.v[i].to_f32(),
            prim: PrimId(self.prim[i]),
            instance: 0,
        })
    }

    /// Whether ray `i` hits anything.
    pub(super) fn is_occluded(&self, i: usize) -> bool {
        self.occluded[i / WIDTH] >> (i % WIDTH) & 1 != 0
    }
}

fn rays<'a>(
    origin: &'a [Vec<f32>; 3],
    direction: &'a [Vec<f32>; 3],
    t_min: &'a [f32],
    t_max: &'a [f32],
) -> RayColumns<'a, f32> {
    RayColumns {
        len: t_max.len(),
        origin: origin.each_ref().map(|c| &c[..]),
        direction: direction.each_ref().map(|c| &c[..]),
        t_min: Bound::Each(t_min),
        t_max: Bound::Each(t_max),
    }
}
