//! Light against closed forms, through whole renders; and a test for each slip of the course report's pseudo-code.
//!
//! | slip | test here (its twin at the kernel, where there is one) |
//! |---|---|
//! | no offset: rays hit their own surface | `shape::no_surface_shades_itself` |
//! | cylinder's quadratic with d.y for d.z, a = 0 divides by zero | `shape::a_cylinder_from_any_side`, `shape::a_cylinder_along_its_axis` (intersect/cylinder) |
//! | caps tested by height and side alike, points lost by rounding | `shape::convex_things_have_no_holes` (intersect/cylinder) |
//! | triangle test on two of three edges, and on an edge's extended line | `shape::a_triangle_is_where_its_three_edges_say` (intersect/triangle) |
//! | flat boxes miss, 0 x infinity is NaN | `shape::axis_parallel_rays_meet_axis_parallel_quads` (intersect/aabb) |
//! | shadow rays run past the light | `light::a_shadow_ray_stops_at_the_light` |
//! | refraction on exit keeps the old cosine | `glass::a_slab_displaces_and_does_not_bend` (shading/scatter) |
//! | total internal reflection is black | `glass::a_prism_reflects_everything` (shading/fresnel) |
//! | specular towards the camera for secondary rays too | `bounce::a_mirror_shows_what_the_mirrored_camera_sees` (shading/blinn_phong) |
//! | diffuse direction is no cosine lobe | `bounce::diffuse_bounces_follow_the_cosine` (sampling/warp) |
//! | pixel numbers as world coordinates | `picture::the_window_does_not_depend_on_the_number_of_pixels` |
//! | colour never reset | `picture::no_pixel_depends_on_another` |
//! | no depth limit | `bounce::facing_mirrors_end_at_max_depth` |
//! | b^2 - 4ac cancels for far or huge spheres | `shape::far_and_huge_spheres_are_round` (intersect/sphere) |
//! | no clamp or gamma | `picture::bytes_are_clamped_srgb` (film/srgb) |

#[path = "../common/mod.rs"]
mod common;

mod bounce;
mod glass;
mod light;
mod picture;
mod shape;

use common::{film, parse};
use octray::describe::Tier;

/// What the centre of a one-pixel picture sees, in `Watertight`, and the same in `Exact` within `tolerance`.
fn look(scene: &str, max_depth: u32, tolerance: f64) -> [f64; 3] {
    let head = format!(
        "[render]\nsize = [1, 1]\nspp = 1\nmin_throughput = 0\nmax_depth = {max_depth}\nfilter = {{ radius = 0 }}\n"
    );
    let mut scene = parse(&format!("{head}{scene}"));
    let [watertight, exact] = [Tier::Watertight, Tier::Exact].map(|tier| {
        scene.render.tier = tier;
        film(&scene).pixels[0].map(f64::from)
    });
    close(watertight, exact, tolerance, "Watertight and Exact");
    watertight
}

fn camera(position: [f64; 3], look_at: [f64; 3]) -> String {
    format!("[camera]\nposition = {position:?}\nlook_at = {look_at:?}\nup = [0.1, 1, 0.2]\n")
}

fn close(a: [f64; 3], b: [f64; 3], tolerance: f64, what: &str) {
    let near = a.iter().zip(b).all(|(a, b)| (a - b).abs() <= tolerance);
    assert!(near, "{what}: {a:?} is not {b:?} within {tolerance}");
}
