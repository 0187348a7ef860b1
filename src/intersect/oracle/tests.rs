//! Answers that can be worked out by hand, some beyond what `f64` can tell.

use super::*;

fn line(origin: [f64; 3], direction: [f64; 3]) -> Line {
    Line { origin, direction }
}

#[test]
fn decides_what_f64_cannot() {
    let sliver = [[0.0, 0.0, 1.0], [1e30, 0.0, 1.0], [0.0, 1e-30, 1.0]];
    let at = |y: f64| line([1e29, y, 0.0], [0.0, 0.0, 1.0]);
    assert_eq!(triangle(&at(0.8e-30), sliver), Some(1.0));
    assert_eq!(triangle(&at(0.95e-30), sliver), None);
    let tangent = line([1.0, 0.0, -5.0], [0.0, 0.0, 1.0]);
    let beside = line([1.0f64.next_up(), 0.0, -5.0], [0.0, 0.0, 1.0]);
    assert_eq!(sphere(&tangent, [0.0; 3], 1.0), Some([5.0, 5.0]));
    assert_eq!(sphere(&beside, [0.0; 3], 1.0), None);
    let upright = Cylinder { from: [0.0; 3], to: [0.0, 2.0, 0.0], radius: 1.0, capped: true };
    assert_eq!(cylinder(&tangent, &upright), Some([(5.0, true); 2]));
    assert_eq!(cylinder(&beside, &upright), None);
    let unit = |x: f64| aabb(&line([x, 0.5, -1.0], [0.0, -0.0, 2.0]), [0.0; 3], [1.0; 3]);
    assert_eq!(unit(1.0), Some([0.5, 1.0]));
    assert_eq!(unit(1.0f64.next_up()), None);
}

#[test]
fn edges_and_corners_belong_to_a_triangle_and_its_plane_edge_on_does_not() {
    let corners = [[0.0, 0.0, 2.0], [1.0, 0.0, 2.0], [0.0, 1.0, 2.0]];
    let down = |x: f64, y: f64| triangle(&line([x, y, 0.0], [0.0, 0.0, 0.5]), corners);
    for (x, y) in [(0.0, 0.0), (1.0, 0.0), (0.5, 0.5), (0.25, 0.0), (0.2, 0.3)] {
        assert_eq!(down(x, y), Some(4.0));
    }
    for (x, y) in [(-1e-300, 0.0), (0.5, 0.5 + 1e-16), (2.0, 0.0), (0.0, -5e-324)] {
        assert_eq!(down(x, y), None, "{x} {y}");
    }
    assert_eq!(triangle(&line([-1.0, 0.2, 2.0], [1.0, 0.0, 0.0]), corners), None);
    assert_eq!(triangle(&line([0.0; 3], [0.0, 0.0, 1.0]), [[0.0, 0.0, 1.0]; 3]), None, "no area");
}

#[test]
fn a_cylinder_tells_side_from_cap_and_has_no_rim_gap() {
    let c = Cylinder { from: [0.0; 3], to: [0.0, 0.0, 2.0], radius: 1.0, capped: true };
    let cap_then_side = line([-1.0, 0.0, -0.5], [1.0, 0.0, 1.0]);
    assert_eq!(cylinder(&cap_then_side, &c), Some([(0.5, false), (2.0, true)]));
    assert_eq!(cylinder(&line([0.5, 0.0, -1.0], [0.0, 0.0, 1.0]), &c), Some([(1.0, false), (3.0, false)]));
    assert_eq!(cylinder(&line([0.0, 0.0, 5.0], [0.0, 0.0, -1.0]), &c), Some([(3.0, false), (5.0, false)]));
    assert_eq!(cylinder(&line([-3.0, 0.0, 2.0], [1.0, 0.0, 0.0]), &c), Some([(2.0, true), (4.0, true)]));
    // Through a point of the rim alone.
    assert_eq!(
        cylinder(&line([-2.0, 0.0, -1.0], [1.0, 0.0, 1.0]), &c).map(|ends| ends[0]),
        Some((1.0, true))
    );
    assert_eq!(cylinder(&line([2.0, 0.0, 1.0], [-1.0, 0.0, 1.0]), &c), Some([(1.0, true); 2]));
    assert_eq!(cylinder(&line([2.0, 0.0, 1.0 + 1e-15], [-1.0, 0.0, 1.0]), &c), None);
    let open = Shape::Cylinder(Cylinder { capped: false, ..c });
    assert_eq!(surfaces(&cap_then_side, &open), [None, Some(2.0)]);
}

#[test]
fn no_root_cancels() {
    // Nearly tangent to a huge sphere at the origin: one root is tiny beside the other.
    let [near, far] = sphere(&line([0.0, 1e-20, 0.0], [0.0, -1.0, 0.0]), [0.0, -1e20, 0.0], 1e20).unwrap();
    assert_eq!((near, far), (1e-20, 2e20));
    // Each is the mirror image of the other.
    let (ahead, back) = (line([1e-9, 0.0, 0.0], [3.0, 0.0, 0.0]), line([1e-9, 0.0, 0.0], [-3.0, 0.0, 0.0]));
    let [a, b] = sphere(&ahead, [0.0; 3], 2.0).unwrap();
    assert_eq!(sphere(&back, [0.0; 3], 2.0), Some([-b, -a]));
}

#[test]
fn the_nearest_of_a_mixed_scene_and_the_first_of_two_alike() {
    let shapes = [
        Shape::Sphere { center: [0.0, 0.0, 9.0], radius: 1.0 },
        Shape::Triangle([[-1.0, -1.0, 5.0], [1.0, -1.0, 5.0], [0.0, 1.0, 5.0]]),
        Shape::Box { min: [-1.0, -1.0, 5.0], max: [1.0, 1.0, 6.0] },
    ];
    let ahead = line([0.0; 3], [0.0, 0.0, 1.0]);
    assert_eq!(nearest(&ahead, &shapes, |t| t > 0.0), Some((1, 5.0)));
    assert_eq!(nearest(&ahead, &shapes, |t| t > 6.0), Some((0, 8.0)));
    assert_eq!(nearest(&ahead, &shapes, |t| t > 10.0), None);
}

#[test]
fn grown_shapes_hold_the_smaller_ones() {
    let c = Cylinder { from: [0.0; 3], to: [0.0, 0.0, 2.0], radius: 1.0, capped: true };
    let shape = Shape::Cylinder(c);
    let ahead = line([0.5, 0.0, -1.0], [0.0, 0.0, 1.0]);
    assert_eq!(surfaces(&ahead, &shape.grown(0.25).unwrap()), [Some(0.75), Some(3.25)]);
    assert_eq!(surfaces(&ahead, &shape.grown(-0.25).unwrap()), [Some(1.25), Some(2.75)]);
    assert_eq!(shape.grown(-1.0), None);
    assert!(Shape::Box { min: [0.0; 3], max: [1.0; 3] }.grown(-0.6).is_none());
}
