//! The plain version of a traversal: every primitive of the scene, one after the other, one ray at a time.
//!
//! Uses the scalar form of the same kernels, no tree and no packets: what every traversal must equal bit for bit.

use super::Accel;
use super::query::{Closest, Query};
use crate::geometry::{Geometry, Group, row3};
use crate::intersect::{Curved, PrimId, PrimKind, RayLanes, Tier, TriangleTest, cylinder, plane, sphere};
use crate::math::{Real, Vec3};

/// The nearest hit of a ray, in the number type of its tier; fields as in [`crate::intersect::Hit`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestHit<R> {
    /// Distance.
    pub t: R,
    /// First coordinate on the primitive.
    pub u: R,
    /// Second coordinate on the primitive.
    pub v: R,
    /// What was hit.
    pub prim: PrimId,
    /// Through which instance; 0 is none.
    pub instance: u32,
}

/// The nearest hit of a ray among all primitives.
pub fn closest<T: Tier>(geometry: &Geometry, ray: &RayLanes<T::Real>) -> Option<NearestHit<T::Real>> {
    let mut query = Closest::new(ray.t_max);
    planes::<T>(geometry, ray, &mut query);
    if let Some(world) = geometry.groups.first() {
        group::<T>(geometry, world, ray, &mut query);
    }
    for (i, instance) in geometry.instances.iter().enumerate() {
        query.enter_instance(i as u32 + 1);
        let local = Accel::local_rays::<T::Real>(&instance.to_world, ray);
        group::<T>(geometry, &geometry.groups[instance.group], &local, &mut query);
    }
    let found = query.t < ray.t_max;
    found.then_some(NearestHit {
        t: query.t,
        u: query.u,
        v: query.v,
        prim: PrimId(query.prim),
        instance: query.instance,
    })
}

fn splat<R: Real>(v: [f32; 3]) -> Vec3<R> {
    Vec3::splat_f32(v)
}

fn planes<T: Tier>(geometry: &Geometry, ray: &RayLanes<T::Real>, query: &mut Closest<T::Real>) {
    let p = &geometry.planes;
    for i in 0..p.len() {
        let lanes = plane::Lanes { point: splat(row3(&p.point, i)), normal: splat(row3(&p.normal, i)) };
        query.accept(ray, &plane::solve(ray, &lanes), PrimId::new(PrimKind::Plane, i).0);
    }
}

fn group<T: Tier>(g: &Geometry, group: &Group, ray: &RayLanes<T::Real>, query: &mut Closest<T::Real>) {
    let prepared = T::Triangle::prepare(ray);
    for i in group.triangles.clone() {
        let hit = T::Triangle::test(ray, &prepared, g.triangles.corners(i).map(splat), query.limit());
        query.accept(ray, &hit, PrimId::new(PrimKind::Triangle, i).0);
    }
    for i in group.spheres.clone() {
        let s = &g.spheres;
        let lanes =
            sphere::Lanes { center: splat(row3(&s.center, i)), radius: T::Real::from_f32(s.radius[i]) };
        query.accept(ray, &T::Curved::sphere(ray, &lanes), PrimId::new(PrimKind::Sphere, i).0);
    }
    for i in group.cylinders.clone() {
        let c = &g.cylinders;
        let lanes = cylinder::Lanes {
            from: splat(row3(&c.from, i)),
            to: splat(row3(&c.to, i)),
            radius: T::Real::from_f32(c.radius[i]),
            capped: c.capped[i],
        };
        query.accept(ray, &T::Curved::cylinder(ray, &lanes), PrimId::new(PrimKind::Cylinder, i).0);
    }
}
