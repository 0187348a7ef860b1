//! Spheres of glass that touch: which surface comes next where gaps are thinner than roundoff.
//!
//! A ray starts as far from the surface that it leaves as rounding may have moved it. Where another body touches, that may
//! already be inside of it, its surface skipped; or the other's surface is met before the one that the ray has yet to leave.
//! Either way the ray would stray: it would refract in the wrong order, or be inside of a body for ever. What it is inside of
//! tells which surface is missing, and how near the surface is tells whether rounding is to blame:
//! - met from inside, never entered, and it starts at the surface: there it enters, or never really was inside;
//! - met while inside of another body whose surface is just there, and leaving that one: it leaves first.
//!
//! Scenes without dielectrics never come here; others pay some comparisons of words, and more only in such cases.

use super::medium::{Media, NO_BODY, body_of, innermost, is_inside, material_of_body, sphere_of};
use super::queue::Rows;
use super::surface::{HitLanes, SurfaceLanes, Wanted, evaluate, evaluate_wanted};
use super::surface_queue::{from_inside, materials_of};
use crate::geometry::{Geometry, entries};
use crate::intersect::PrimKind;
use crate::math::{Lane, Mask, Vec3, WIDTH, eight};
use crate::scene::{Scatter, Scene};

/// How far from a surface rounding may leave a ray that belongs on its other side, in bounds on the error of points: the
/// offset from one surface, which is up to the square root of three, twice, and the error of the other.
const NEAR: f64 = 4.0;

/// Eight surfaces that rays met.
pub(super) struct Met<L: Lane> {
    pub(super) surface: SurfaceLanes<L>,
    pub(super) materials: [u32; WIDTH],
    /// What becomes of rays there.
    pub(super) scatter: [Scatter; WIDTH],
    /// The ray comes from inside, against the outward normal.
    pub(super) inside: L::Mask,
    /// What the surface bounds, see [`super::medium`]; none for a surface that is passed as if it were not there.
    pub(super) bodies: [u32; WIDTH],
}

impl<L: Lane> Met<L> {
    /// The surfaces of hits. `media` is what paths are inside of, empty in scenes without dielectrics.
    #[inline(always)]
    pub(super) fn new(
        scene: &Scene,
        kind: PrimKind,
        hit: &HitLanes<L>,
        media: &[Media],
        paths: &Rows,
    ) -> Self {
        let needs = &scene.requirements;
        let wanted = Wanted { shading_normal: needs.shading_normals, uv: needs.textures };
        let surface = evaluate_wanted(&scene.geometry, kind, hit, wanted);
        let materials = materials_of(scene, kind, hit);
        let scatter = entries(&scene.materials.scatter, &materials);
        let inside = from_inside(hit.direction, &surface);
        let met = Self { surface, materials, scatter, inside, bodies: [NO_BODY; WIDTH] };
        if !media.is_empty() && scatter.contains(&Scatter::Dielectric) {
            let bodies = eight(|i| match scatter[i] {
                Scatter::Dielectric => body_of(kind, hit.row[i], hit.instance[i], materials[i]),
                _ => NO_BODY,
            });
            return Self { bodies, ..met }.settled(scene, hit, &paths.of(media));
        }
        met
    }

    /// With that put right which rounding has put in the wrong order.
    #[inline(always)]
    fn settled(self, scene: &Scene, hit: &HitLanes<L>, media: &[Media; WIDTH]) -> Self {
        let inside = self.inside.bits();
        let (mut unseen, mut other) = (0, 0);
        for (i, &state) in media.iter().enumerate() {
            let (body, around) = (self.bodies[i], innermost(state));
            if inside >> i & 1 != 0 && sphere_of(body).is_some() && !is_inside(state, body) {
                unseen |= 1 << i;
            } else if body != NO_BODY && body != around && sphere_of(around).is_some() {
                other |= 1 << i;
            }
        }
        if unseen | other == 0 { self } else { self.reordered(scene, hit, media, [unseen, other]) }
    }

    /// With what was never entered entered, and left what is left before.
    #[cold]
    #[inline(never)]
    fn reordered(
        mut self,
        scene: &Scene,
        hit: &HitLanes<L>,
        media: &[Media; WIDTH],
        [unseen, other]: [u32; 2],
    ) -> Self {
        if unseen != 0 {
            self.enter_late(&scene.geometry, hit, unseen);
        }
        if other != 0 {
            self.leave_first(&scene.geometry, hit, other, media.map(innermost));
            self.scatter = entries(&scene.materials.scatter, &self.materials);
        }
        self
    }

    /// Of bodies met from inside that were never entered: those at whose surface the ray starts are met there.
    fn enter_late(&mut self, geometry: &Geometry, hit: &HitLanes<L>, lanes: u32) {
        let (there, near) = surface_at(geometry, &self.bodies, lanes, hit.origin, hit.direction);
        let enters = there.geometric_normal.dot(hit.direction).lt(L::zero());
        self.replace(near & enters, there);
        self.inside = self.inside & !(near & enters);
        let passed = (near & !enters).bits();
        self.bodies = eight(|i| if passed >> i & 1 != 0 { NO_BODY } else { self.bodies[i] });
    }

    /// Of surfaces met inside of `around`: where the ray leaves that one at the same place, it does so first.
    fn leave_first(&mut self, geometry: &Geometry, hit: &HitLanes<L>, lanes: u32, around: [u32; WIDTH]) {
        let (there, near) = surface_at(geometry, &around, lanes, self.surface.point, hit.direction);
        let leaves = near & from_inside(hit.direction, &there);
        self.replace(leaves, there);
        self.inside = self.inside | leaves;
        for i in super::queue::set_bits(leaves.bits()) {
            self.bodies[i] = around[i];
            self.materials[i] = material_of_body(geometry, around[i]);
        }
    }

    fn replace(&mut self, lanes: L::Mask, by: SurfaceLanes<L>) {
        self.surface = SurfaceLanes::select(lanes, by, self.surface);
    }
}

/// The surfaces of spheres where they are nearest to points, and for which of the lanes that is within rounding.
fn surface_at<L: Lane>(
    geometry: &Geometry,
    bodies: &[u32; WIDTH],
    lanes: u32,
    points: Vec3<L>,
    direction: Vec3<L>,
) -> (SurfaceLanes<L>, L::Mask) {
    // Some sphere stands in for lanes that are not asked for.
    let any = bodies[lanes.trailing_zeros() as usize];
    let row = eight(|i| sphere_of(if lanes >> i & 1 != 0 { bodies[i] } else { any }).unwrap_or(0));
    let zero = L::zero();
    let at = HitLanes { origin: points, direction, t: zero, u: zero, v: zero, row, instance: [0; WIDTH] };
    let surface = evaluate(geometry, PrimKind::Sphere, &at);
    let off = (surface.point - points).abs().max_component();
    (surface, L::Mask::from_bits(lanes) & off.le(surface.error * L::constant(NEAR)))
}
