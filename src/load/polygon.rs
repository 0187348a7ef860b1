//! Polygons to triangles: ears cut off one by one, so that concave polygons keep their outline.

/// Appends the triangles of a polygon, corners minus two of them; nothing for fewer than three corners.
///
/// Triangles and convex polygons become a fan from the first corner. Others lose one ear at a time: a corner that turns
/// the right way with no other corner inside. A polygon that crosses itself has no ears left at some point; the
/// rest becomes a fan.
///
/// **Needs**: every index is below the number of positions.
/// **Source**: ear clipping, Meisters 1975; the plane of the polygon by Newell's method.
pub(super) fn triangulate(positions: &[[f32; 3]], polygon: &[u32], triangles: &mut Vec<[u32; 3]>) {
    match *polygon {
        [] | [_] | [_, _] => {}
        [a, b, c] => triangles.push([a, b, c]),
        _ => cut(positions, polygon, triangles),
    }
}

fn cut(positions: &[[f32; 3]], polygon: &[u32], triangles: &mut Vec<[u32; 3]>) {
    let corners = flatten(positions, polygon);
    let mut rest: Vec<usize> = (0..polygon.len()).collect();
    if is_convex(&corners) {
        return fan(polygon, &rest, triangles);
    }
    while rest.len() > 3 {
        let Some(ear) = (0..rest.len()).find(|&i| is_ear(&corners, &rest, i)) else { break };
        triangles.push(around(&rest, ear).map(|corner| polygon[corner]));
        rest.remove(ear);
    }
    fan(polygon, &rest, triangles);
}

fn fan(polygon: &[u32], rest: &[usize], triangles: &mut Vec<[u32; 3]>) {
    triangles.extend(rest[1..].windows(2).map(|pair| [polygon[rest[0]], polygon[pair[0]], polygon[pair[1]]]));
}

/// The corners in the plane of the polygon, counter-clockwise as a whole.
fn flatten(positions: &[[f32; 3]], polygon: &[u32]) -> Vec<[f64; 2]> {
    let points: Vec<[f64; 3]> = polygon.iter().map(|&v| positions[v as usize].map(f64::from)).collect();
    let mut normal = [0.0; 3];
    for (i, a) in points.iter().enumerate() {
        let b = points[(i + 1) % points.len()];
        for (axis, n) in normal.iter_mut().enumerate() {
            let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
            *n += (a[j] - b[j]) * (a[k] + b[k]);
        }
    }
    // Dropping the axis along which the normal is longest keeps the most area.
    let axis = (0..3).max_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs())).unwrap_or(2);
    let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
    let (j, k) = if normal[axis] < 0.0 { (k, j) } else { (j, k) };
    points.iter().map(|p| [p[j], p[k]]).collect()
}

/// Twice the area of a triangle, positive when counter-clockwise.
fn area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// All corners turn left, and together once around (a star turns left everywhere too, but twice around).
fn is_convex(corners: &[[f64; 2]]) -> bool {
    let n = corners.len();
    let left = (0..n).all(|i| area([corners[i], corners[(i + 1) % n], corners[(i + 2) % n]]) >= 0.0);
    left && (2..n).all(|i| area([corners[0], corners[i - 1], corners[i]]) >= 0.0)
}

fn around(rest: &[usize], i: usize) -> [usize; 3] {
    let n = rest.len();
    [rest[(i + n - 1) % n], rest[i], rest[(i + 1) % n]]
}

fn is_ear(corners: &[[f64; 2]], rest: &[usize], i: usize) -> bool {
    let ear = around(rest, i);
    let [a, b, c] = ear.map(|corner| corners[corner]);
    let holds = |p: [f64; 2]| area([a, b, p]) >= 0.0 && area([b, c, p]) >= 0.0 && area([c, a, p]) >= 0.0;
    area([a, b, c]) > 0.0
        && rest.iter().filter(|&corner| !ear.contains(corner)).all(|&corner| {
            let p = corners[corner];
            // A corner may stand where one of ours does: polygons with a hole are cut open like that.
            p == a || p == b || p == c || !holds(p)
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut_flat(outline: &[[f32; 2]]) -> Vec<[u32; 3]> {
        let positions: Vec<[f32; 3]> = outline.iter().map(|p| [p[0], 0.0, p[1]]).collect();
        let polygon: Vec<u32> = (0..outline.len() as u32).collect();
        let mut triangles = Vec::new();
        triangulate(&positions, &polygon, &mut triangles);
        triangles
    }

    fn covered(outline: &[[f32; 2]], triangles: &[[u32; 3]]) -> f64 {
        let at = |v: u32| outline[v as usize].map(f64::from);
        triangles.iter().map(|t| area(t.map(at)).abs() / 2.0).sum()
    }

    #[test]
    fn convex_polygons_become_fans() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        assert_eq!(cut_flat(&square), [[0, 1, 2], [0, 2, 3]]);
        let backwards = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
        assert_eq!(cut_flat(&backwards), [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn concave_polygons_keep_their_outline() {
        let dart = [[0.0, 0.0], [4.0, 0.0], [1.0, 1.0], [0.0, 4.0]];
        let comb =
            [[0.0, 0.0], [5.0, 0.0], [5.0, 3.0], [4.0, 3.0], [4.0, 1.0], [3.0, 1.0], [3.0, 3.0], [0.0, 3.0]];
        for (outline, expected) in [(&dart[..], 4.0), (&comb[..], 13.0)] {
            let triangles = cut_flat(outline);
            assert_eq!(triangles.len(), outline.len() - 2);
            assert_eq!(covered(outline, &triangles), expected);
        }
    }

    #[test]
    fn hopeless_polygons_give_corners_minus_two() {
        let star = [[0.0, 3.0], [2.0, -3.0], [-3.0, 1.0], [3.0, 1.0], [-2.0, -3.0]];
        assert_eq!(cut_flat(&star).len(), 3);
        assert_eq!(cut_flat(&[[1.0, 1.0]; 6]).len(), 4);
        assert_eq!(cut_flat(&[[f32::NAN, 0.0]; 5]).len(), 3);
        assert_eq!(cut_flat(&[[0.0, 0.0], [1.0, 0.0]]).len(), 0);
    }
}
