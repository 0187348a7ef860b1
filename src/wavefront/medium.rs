//! Which dielectrics a ray is inside of: four numbers of 16 bits in a word, the innermost lowest; 0 is none.
//!
//! A number is a dielectric's material row plus one. Four nested bodies are tracked; entering a fifth forgets the
//! outermost.

/// Outside of everything.
pub(super) const OUTSIDE: u64 = 0;

/// The state inside `body`.
pub(super) fn enter(state: u64, body: u16) -> u64 {
    state << 16 | u64::from(body)
}

/// The state after leaving `body`: its innermost mention is taken out; a body never entered changes nothing.
pub(super) fn leave(state: u64, body: u16) -> u64 {
    for level in 0..4 {
        let shift = 16 * level;
        if (state >> shift) as u16 == body {
            let below = state & ((1u64 << shift) - 1);
            let above = if shift == 48 { 0 } else { state >> (shift + 16) << shift };
            return above | below;
        }
    }
    state
}

/// The state of a ray found inside `body`: as if it had entered, where no entry was seen (a camera inside a body).
pub(super) fn found_inside(state: u64, body: u16) -> u64 {
    let known = (0..4).any(|level| (state >> (16 * level)) as u16 == body);
    if known { state } else { enter(state, body) }
}

/// The body whose inside counts: the innermost.
pub(super) fn innermost(state: u64) -> u16 {
    state as u16
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
}
