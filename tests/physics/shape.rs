//! Shapes as pictures: silhouettes and normals by formula. A light along the view makes radiance the cosine of the normal.

use super::common::{TIERS, at_centres, film, in_tier, parse};
use octray::describe::{SceneDescription, Tier};
use octray::film::Film;

const SIDE: u32 = 61;

/// Seen along -z through a window of height 4 around the origin, lit along the view; black where nothing is.
fn seen_from(distance: f64, object: &str) -> SceneDescription {
    at_centres(parse(&format!(
        "
[camera]
kind = 'orthographic'
position = [0, 0, {distance}]
look_at = [0, 0, 0]
height = 4
[render]
size = [{SIDE}, {SIDE}]
[[light.directional]]
direction = [0, 0, -1]
intensity = 1
[[material]]
name = 'white'
ka = 0
kd = 1
{object}
material = 'white'
"
    )))
}

/// Compares with the cosine at each place of the window, `None` where nothing is; places within `edge` are left out by
/// giving NaN.
fn check(film: &Film, tolerance: f64, what: &str, cosine: impl Fn(f64, f64) -> Option<f64>) {
    for row in 0..SIDE {
        for column in 0..SIDE {
            let place = |i: u32| (f64::from(i) + 0.5) * 4.0 / f64::from(SIDE) - 2.0;
            let (x, y) = (place(column), -place(row));
            let expected = cosine(x, y).unwrap_or(0.0);
            let found = f64::from(film.pixel(column, row)[0]);
            if !expected.is_nan() {
                assert!((found - expected).abs() <= tolerance, "{what} at {x}, {y}: {found}, not {expected}");
            }
        }
    }
}

/// The cosine of a shape `q <= 1` whose surface has the normal `(nx, ny, nz)`; nothing is said near the edge.
fn quadric(q: f64, [nx, ny, nz]: [f64; 3]) -> Option<f64> {
    match q {
        q if (q - 1.0).abs() < 0.03 => Some(f64::NAN),
        q if q > 1.0 => None,
        _ => Some(nz / (nx * nx + ny * ny + nz * nz).sqrt()),
    }
}

#[test]
fn no_surface_shades_itself() {
    for scale in [1e-3, 1.0, 1e4] {
        for tier in TIERS {
            let mut scene = seen_from(10.0, "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1.5");
            scene.camera.position = [3.0 * scale, -2.0 * scale, 10.0 * scale];
            scene.camera.look_at = [3.0 * scale, -2.0 * scale, 0.0];
            scene.camera.height = Some(4.0 * scale);
            scene.sphere[0].center = scene.camera.look_at;
            scene.sphere[0].radius = 1.5 * scale;
            check(&film(&in_tier(scene, tier)), 2e-3, &format!("scale {scale} {tier:?}"), |x, y| {
                let q = (x * x + y * y) / 2.25;
                quadric(q, [x, y, (2.25 - x * x - y * y).max(0.0).sqrt()])
            });
        }
    }
}

#[test]
fn far_and_huge_spheres_are_round() {
    let far = seen_from(1e4, "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1.5");
    let cosine =
        |x: f64, y: f64| quadric((x * x + y * y) / 2.25, [x, y, (2.25 - x * x - y * y).max(0.0).sqrt()]);
    check(&film(&far), 5e-3, "far", cosine);
    let huge = seen_from(10.0, "[[sphere]]\ncenter = [0, 0, -100000]\nradius = 100000");
    check(&film(&huge), 1e-5, "huge", |_, _| Some(1.0));
}

#[test]
fn a_scaled_sphere_is_an_ellipsoid() {
    let (a, b, c, turn) = (1.6, 0.7, 2.5, 30f64.to_radians());
    let object = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\ntransform = [{ scale = [1.6, 0.7, 2.5] }, { rotate_deg = { axis = [0, 0, 1], angle = 30 } }]";
    check(&film(&seen_from(10.0, object)), 2e-4, "ellipsoid", |x, y| {
        let (u, v) = (x * turn.cos() + y * turn.sin(), y * turn.cos() - x * turn.sin());
        let q = (u / a).powi(2) + (v / b).powi(2);
        let w = c * (1.0 - q).max(0.0).sqrt();
        quadric(q, [u / (a * a), v / (b * b), w / (c * c)])
    });
}

#[test]
fn a_scaled_cylinder_is_elliptic() {
    let object = "[[cylinder]]\nfrom = [0, -1, 0]\nto = [0, 1, 0]\nradius = 1\ntransform = [{ scale = [1.5, 1.2, 0.4] }]";
    check(&film(&seen_from(10.0, object)), 2e-4, "elliptic cylinder", |x, y| {
        let q = (x / 1.5).powi(2);
        let z = 0.4 * (1.0 - q).max(0.0).sqrt();
        if y.abs() > 1.2 { None } else { quadric(q, [x / 2.25, 0.0, z / 0.16]) }
    });
}

#[test]
fn a_cylinder_from_any_side() {
    for (axis, up) in [([0.0, 1.0, 0.0], 0), ([1.0, 0.0, 0.0], 1)] {
        let [from, to] = [axis.map(|x: f64| -1.3 * x), axis.map(|x| 1.3 * x)];
        let object = format!("[[cylinder]]\nfrom = {from:?}\nto = {to:?}\nradius = 0.8");
        check(&film(&seen_from(10.0, &object)), 1e-4, "from the side", |x, y| {
            let (across, along) = if up == 0 { (x, y) } else { (y, x) };
            let q = (across / 0.8).powi(2);
            if along.abs() > 1.3 {
                None
            } else {
                quadric(q, [across, 0.0, (0.64 - across * across).max(0.0).sqrt()])
            }
        });
    }
}

#[test]
fn a_cylinder_along_its_axis() {
    let object = "[[cylinder]]\nfrom = [0, 0, -1]\nto = [0, 0, 1]\nradius = 1.4";
    let disc = |x: f64, y: f64| quadric((x * x + y * y) / 1.96, [0.0, 0.0, 1.0]);
    check(&film(&seen_from(10.0, object)), 1e-6, "closed", disc);
    let open = format!("{object}\ncaps = false");
    check(&film(&seen_from(10.0, &open)), 0.0, "open: only its edge could be seen", |x, y| {
        disc(x, y).filter(|c| c.is_nan())
    });
}

#[test]
fn a_triangle_is_where_its_three_edges_say() {
    let corners: [[f64; 2]; 3] = [[-1.7, -1.1], [1.5, -0.6], [0.2, 1.8]];
    let [a, b, c] = corners;
    let object = format!(
        "[[triangle]]\nvertices = [[{}, {}, 0], [{}, {}, 0], [{}, {}, 0]]",
        a[0], a[1], b[0], b[1], c[0], c[1]
    );
    let side =
        |p: [f64; 2], q: [f64; 2], x: f64, y: f64| (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
    check(&film(&seen_from(10.0, &object)), 1e-6, "triangle", |x, y| {
        let sides = [side(a, b, x, y), side(b, c, x, y), side(c, a, x, y)];
        if sides.iter().any(|s| s.abs() < 1e-5) {
            return Some(f64::NAN);
        }
        sides.iter().all(|&s| s > 0.0).then_some(1.0)
    });
}

#[test]
fn axis_parallel_rays_meet_axis_parallel_quads() {
    for tier in [Tier::Watertight, Tier::Exact] {
        for axis in 0..3 {
            let (mut u, mut v) = ([0.0; 3], [0.0; 3]);
            (u[(axis + 1) % 3], v[(axis + 2) % 3]) = (4.0, 4.0);
            let origin: [f64; 3] = std::array::from_fn(|i| if i == axis { 0.0 } else { -2.0 });
            let object = format!("[[quad]]\norigin = {origin:?}\nedge_u = {u:?}\nedge_v = {v:?}");
            let mut scene = in_tier(seen_from(10.0, &object), tier);
            let towards: [f64; 3] = std::array::from_fn(|i| if i == axis { -1.0 } else { 0.0 });
            scene.camera.position = towards.map(|x| -5.0 * x);
            scene.camera.up = std::array::from_fn(|i| if i == (axis + 1) % 3 { 1.0 } else { 0.0 });
            scene.light.directional[0].direction = towards;
            check(&film(&scene), 1e-6, &format!("axis {axis} {tier:?}"), |_, _| Some(1.0));
        }
    }
}

/// Every row of a convex silhouette is one run: a lost point of a rim would cut it.
#[test]
fn convex_things_have_no_holes() {
    for angle in [1e-4, 0.01, 5.0, 30.0, 45.0, 89.99, 90.0] {
        let object = format!(
            "[[cylinder]]\nfrom = [0, 0, -1]\nto = [0, 0, 1]\nradius = 0.9\ntransform = [{{ rotate_deg = {{ axis = [1, 0.3, 0], angle = {angle} }} }}]"
        );
        for tier in [Tier::Watertight, Tier::Exact] {
            let mut scene = in_tier(seen_from(10.0, &object), tier);
            scene.material[0].emission = Some(octray::describe::Rgb::WHITE);
            for row in film(&scene).rows() {
                let changes = row.windows(2).filter(|w| (w[0][0] > 0.0) != (w[1][0] > 0.0)).count();
                assert!(changes <= 2, "a hole at {angle} degrees, {tier:?}");
            }
        }
    }
}

/// An instance with a negative determinant is the mesh with mirrored vertices: same faces outside, same glass.
#[test]
fn a_mirrored_instance_is_the_mirrored_mesh() {
    let vertices = [[0.0, 1.0, 0.0], [0.9, -0.5, 0.3], [-0.6, -0.5, 0.7], [-0.2, -0.5, -0.9f64]];
    let base = |rest: &str| {
        parse(&format!(
            "[camera]\nposition = [1, 1, 4]\nlook_at = [0, 0, 0]\n[render]\nsize = [48, 36]\n[background]\nbottom = 0.1\ntop = [0.3, 0.6, 1]\n\
             [[light.point]]\nposition = [2, 3, 4]\nintensity = 20\n[[material]]\nname = 'glass'\nkind = 'dielectric'\n\
             [[plane]]\npoint = [0, -1, 0]\nnormal = [0, 1, 0]\n{rest}"
        ))
    };
    let faces = "[[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]]";
    // Mirrored vertices turn the faces inside out: written the other way round they look out again.
    let turned = "[[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]]";
    let shown = format!(
        "[[group]]\nname = 'g'\n[[group.mesh]]\nvertices = {vertices:?}\nfaces = {faces}\nmaterial = 'glass'\n\
         [[instance]]\nof = 'g'\ntransform = [{{ scale = [-1, 1, 1.5] }}]"
    );
    let mirrored = vertices.map(|[x, y, z]| [-x, y, 1.5 * z]);
    let plain = format!("[[mesh]]\nvertices = {mirrored:?}\nfaces = {turned}\nmaterial = 'glass'");
    let direct = format!(
        "[[mesh]]\nvertices = {vertices:?}\nfaces = {faces}\nmaterial = 'glass'\ntransform = [{{ scale = [-1, 1, 1.5] }}]"
    );
    let [a, b, c] = [shown, plain, direct].map(|rest| film(&at_centres(base(&rest))));
    for (name, other) in [("instance", &a), ("moved mesh", &c)] {
        let off =
            other.pixels.iter().zip(&b.pixels).filter(|(p, q)| (0..3).any(|k| (p[k] - q[k]).abs() > 1e-3));
        assert!(off.count() <= 8, "{name}: only edges may differ");
    }
}
