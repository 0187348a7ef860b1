//! Which dielectrics a ray is inside of: four bodies, the innermost first; 0 is none.
//!
//! A sphere of the scene itself is a body by its primitive id. What takes several primitives to close (meshes, planes, quads),
//! and what stands behind an instance, is one body by its material: row plus one. Four nested bodies are tracked; entering a
//! fifth forgets the outermost.

use crate::geometry::Geometry;
use crate::intersect::{PrimId, PrimKind};

/// Bodies that a ray is inside of.
pub(super) type Media = [u32; 4];

/// Outside of everything.
pub(super) const OUTSIDE: Media = [NO_BODY; 4];

/// No body.
pub(super) const NO_BODY: u32 = 0;

/// The body of a dielectric surface.
pub(super) fn body_of(kind: PrimKind, row: u32, instance: u32, material: u32) -> u32 {
    match kind {
        PrimKind::Sphere if instance == 0 => PrimId::new(kind, row as usize).0,
        _ => material + 1,
    }
}

/// The row of a body that is a sphere by itself.
pub(super) fn sphere_of(body: u32) -> Option<u32> {
    let first = PrimId::new(PrimKind::Sphere, 0).0;
    body.checked_sub(first)
}

/// The row of a body, not [`NO_BODY`]: of the sphere, or of its material.
pub(super) fn row_of(body: u32) -> u32 {
    sphere_of(body).unwrap_or(body - 1)
}

/// The material row of a body.
pub(super) fn material_of_body(geometry: &Geometry, body: u32) -> u32 {
    match sphere_of(body) {
        Some(row) => geometry.material(PrimKind::Sphere, row as usize),
        None => body - 1,
    }
}

/// The state inside `body`.
pub(super) fn enter([a, b, c, _]: Media, body: u32) -> Media {
    [body, a, b, c]
}

/// The state after leaving `body`: its innermost mention is taken out; a body never entered changes nothing.
pub(super) fn leave(state: Media, body: u32) -> Media {
    let [a, b, c, d] = state;
    match state.iter().position(|&around| around == body) {
        Some(0) => [b, c, d, NO_BODY],
        Some(1) => [a, c, d, NO_BODY],
        Some(2) => [a, b, d, NO_BODY],
        Some(_) => [a, b, c, NO_BODY],
        None => state,
    }
}

/// Whether the ray is known to be inside `body`.
pub(super) fn is_inside(state: Media, body: u32) -> bool {
    state.contains(&body)
}

/// The state of a ray found inside `body`: as if it had entered, where no entry was seen (a camera inside a body).
pub(super) fn found_inside(state: Media, body: u32) -> Media {
    if body == NO_BODY || is_inside(state, body) { state } else { enter(state, body) }
}

/// The body whose inside counts: the innermost.
pub(super) fn innermost(state: Media) -> u32 {
    state[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nested_bodies_are_left_in_any_order() {
        let inside = enter(enter(OUTSIDE, 3), 7);
        assert_eq!(innermost(inside), 7);
        assert_eq!(innermost(leave(inside, 7)), 3);
        assert_eq!(innermost(leave(inside, 3)), 7);
        assert_eq!(leave(leave(inside, 3), 7), OUTSIDE);
    }

    #[test]
    fn leaving_what_was_never_entered_changes_nothing() {
        assert_eq!(leave(enter(OUTSIDE, 2), 5), enter(OUTSIDE, 2));
        let full = (1..=4).fold(OUTSIDE, enter);
        for state in [OUTSIDE, enter(OUTSIDE, 2), full] {
            assert_eq!((leave(state, NO_BODY), found_inside(state, NO_BODY)), (state, state));
        }
    }

    #[test]
    fn a_ray_found_inside_without_entering_gets_out() {
        let inside = found_inside(enter(OUTSIDE, 2), 9);
        assert_eq!(innermost(inside), 9);
        assert_eq!(found_inside(inside, 2), inside);
        assert_eq!(leave(inside, 9), enter(OUTSIDE, 2));
    }

    #[test]
    fn the_fifth_body_forgets_the_outermost() {
        let deep = (1..=5).fold(OUTSIDE, enter);
        let out = [5, 4, 3, 2].into_iter().fold(deep, leave);
        assert_eq!(out, OUTSIDE);
    }

    #[test]
    fn spheres_are_bodies_of_their_own_but_for_those_of_instances() {
        let [first, second] = [0, 1].map(|row| body_of(PrimKind::Sphere, row, 0, 6));
        assert_eq!([first, second].map(sphere_of), [Some(0), Some(1)]);
        for (kind, instance) in [(PrimKind::Sphere, 4), (PrimKind::Plane, 0), (PrimKind::Triangle, 1)] {
            let body = body_of(kind, 1, instance, 6);
            assert_eq!((body, sphere_of(body)), (7, None));
        }
    }
}
