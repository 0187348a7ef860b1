//! Whole files, tiny ones written here.

mod real;

use super::*;

/// Loads a file of this content under this name.
fn load(name: &str, content: impl AsRef<[u8]>) -> Result<Mesh, LoadError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, content).unwrap();
    load_mesh(&path)
}

fn message(name: &str, content: impl AsRef<[u8]>) -> String {
    let text = load(name, content).unwrap_err().to_string();
    assert!(text.contains(name), "{text}");
    text
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn obj_polygons_and_negative_indices() {
    let mesh = load("a.obj", format!("{SQUARE}f -4 -3 -2 -1\nf 1 2 3\n")).unwrap();
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 1, 2]]);
    assert_eq!((mesh.normals.len(), mesh.uvs.len(), mesh.triangle_materials.len()), (0, 0, 0));
    assert_eq!(mesh.bounds(), Some([[0.0; 3], [1.0, 1.0, 0.0]]));
}

#[test]
fn obj_corners_with_different_normals_are_different_vertices() {
    let text = format!("{SQUARE}vn 0 0 2\nvn 1 0 0\nvt 0 1\nf 1/1/1 2/1/1 3/1/1\nf 1/1/2 3/1/2 4/1/2\n");
    let mesh = load("a.obj", text).unwrap();
    assert_eq!(mesh.positions.len(), 6);
    assert_eq!((mesh.normals[0], mesh.normals[3]), ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0]));
    assert_eq!(mesh.uvs, [[0.0, 1.0]; 6]);
}

#[test]
fn obj_groups_without_normals_stay_flat_beside_those_with() {
    let text = format!("{SQUARE}vn 1 0 0\ng a\nf 1//1 2//1 3//1\ng b\nf 1 2 3 4\n");
    let mesh = load("a.obj", text).unwrap();
    assert_eq!((mesh.positions.len(), mesh.normals.len()), (9, 9));
    assert_eq!(mesh.normals[3..], [[0.0, 0.0, 1.0]; 6]);
    assert_eq!(mesh.triangles, [[0, 1, 2], [3, 4, 5], [6, 7, 8]]);
}

#[test]
fn triangles_without_area_are_counted() {
    let text = format!("{SQUARE}v 2 0 0\nv 1 0 0\nf 1 2 3\nf 1 2 5\nf 1 1 2\nf 2 6 3\nf 1 2\n");
    let mesh = load("a.obj", text).unwrap();
    assert_eq!(mesh.triangles, [[0, 1, 2]]);
    assert_eq!((mesh.report.triangles_read, mesh.report.degenerate), (4, 4));
}

#[test]
fn bad_obj_files_say_where() {
    assert!(message("a.obj", "").contains("no faces"));
    assert!(message("a.obj", SQUARE).contains("4 points but no faces") || cfg!(not(miri)));
    assert!(message("a.obj", format!("{SQUARE}f 1 2 9\n")).contains("a.obj:5: a face uses vertex 9"));
    assert!(message("a.obj", "v 0 0 0\nv 1 zero 0\n").contains("a.obj:2: position parse error"));
    assert!(message("a.obj", "v 0 0 0\nv 1 0 0\nv 0 inf 0\nf 1 2 3\n").contains("vertex 3 is not finite"));
    assert!(message("a.obj", b"\x00\xff\xfe\nf f f\n").contains("a.obj:2"));
}

#[test]
fn missing_companions_of_an_obj_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let obj = folder.path().join("a.obj");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    let fault = || load_mesh(&obj).unwrap_err().to_string();
    write("a.obj", &format!("mtllib a.mtl\n{SQUARE}usemtl red\nf 1 2 3\n"));
    assert!(
        fault().contains("a.obj:1: material file ") && fault().contains("a.mtl cannot be read"),
        "{}",
        fault()
    );
    assert!(load_mesh_with(&obj, LoadOptions { materials: false, ..Default::default() }).is_ok());
    write("a.mtl", "newmtl blue\nKd 0 0 1\n");
    assert!(fault().contains("a.obj:6: there is no material `red` in a.mtl"), "{}", fault());
    write("a.mtl", "newmtl red\nmap_Kd -s 1 1 1 brick.png\n");
    assert!(fault().contains("brick.png of material `red` does not exist"), "{}", fault());
    write("brick.png", "");
    let mesh = load_mesh(&obj).unwrap();
    assert_eq!(mesh.materials[0].texture, Some(folder.path().join("brick.png")));
    assert_eq!(mesh.triangle_materials, [0]);
}

#[test]
fn faces_before_any_material_get_a_plain_one() {
    let folder = tempfile::tempdir().unwrap();
    let obj = folder.path().join("a.obj");
    std::fs::write(folder.path().join("m.mtl"), "newmtl red\nKd 1 0 0\n").unwrap();
    let text = format!("mtllib m.mtl\n{SQUARE}f 1 2 3\nusemtl red\nf 1 3 4\n");
    std::fs::write(&obj, text).unwrap();
    let mesh = load_mesh(&obj).unwrap();
    assert_eq!(mesh.triangle_materials, [1, 0]);
    assert_eq!(mesh.materials[1].kd(), [0.8; 3]);
}

const PLY_HEAD: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty double y\n\
    property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";

#[test]
fn ply_polygons() {
    let mesh = load("a.PLY", format!("{PLY_HEAD}0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n")).unwrap();
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.positions[2], [1.0, 1.0, 0.0]);
}

#[test]
fn ply_binary_in_both_byte_orders() {
    for (order, big) in [("binary_little_endian", false), ("binary_big_endian", true)] {
        let head = format!(
            "ply\nformat {order} 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
             property uchar red\nelement edge 1\nproperty int vertex1\nelement face 1\n\
             property list uchar uint vertex_index\nend_header\n"
        );
        let mut bytes = head.into_bytes();
        let word = |w: u32| bytes_of(w, big);
        let mut body = Vec::new();
        for position in [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] {
            position.iter().for_each(|x| body.extend(word(x.to_bits())));
            body.push(7);
        }
        body.extend(word(5));
        body.push(3);
        [2, 1, 0].iter().for_each(|&v| body.extend(word(v)));
        bytes.extend(&body);
        assert_eq!(load("a.ply", &bytes).unwrap().triangles, [[2, 1, 0]], "{order}");
        bytes.pop();
        assert!(message("a.ply", &bytes).len() > 10);
    }
}

fn bytes_of(word: u32, big: bool) -> [u8; 4] {
    if big { word.to_be_bytes() } else { word.to_le_bytes() }
}

#[test]
fn bad_ply_files_are_errors() {
    message("a.ply", "");
    message("a.ply", "ply\n");
    message("a.ply", PLY_HEAD);
    assert!(
        message("a.ply", format!("{PLY_HEAD}0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 7\n")).contains("vertex 7")
    );
    assert!(message("a.ply", format!("{PLY_HEAD}0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 -1\n")).contains("face 0"));
    let no_face = PLY_HEAD.replace("element face 1", "element face 0");
    assert!(
        message("a.ply", format!("{no_face}0 0 0\n1 0 0\n1 1 0\n0 1 0\n")).contains("4 points but no faces")
    );
    let flat = PLY_HEAD.replace("property float z\n", "");
    assert!(message("a.ply", format!("{flat}0 0\n1 0\n1 1\n0 1\n3 0 1 2\n")).contains("no `z`"));
    let binary = PLY_HEAD.replace("ascii", "binary_little_endian");
    let cut = message("a.ply", format!("{binary}0123456789"));
    assert!(cut.contains("a.ply: Unexpected end"), "bytes have no lines: {cut}");
    let huge = PLY_HEAD.replace("element vertex 4", "element vertex 4000000000");
    message("a.ply", format!("{huge}0 0 0\n"));
}

const STL_FACET: &str =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

#[test]
fn stl_text_and_binary() {
    for head in ["solid\n", "solid name\n"] {
        let mesh = load("a.stl", format!("{head}{STL_FACET}{STL_FACET}endsolid\n")).unwrap();
        assert_eq!((mesh.positions.len(), mesh.triangles.len()), (3, 2));
    }
    for header in [&b"binary"[..], b"solid but binary"] {
        let mut bytes = header.to_vec();
        bytes.resize(80, b' ');
        bytes.extend(1u32.to_le_bytes());
        [0.0f32, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]
            .iter()
            .for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes.extend([0, 0]);
        let mesh = load("a.stl", &bytes).unwrap();
        assert_eq!(mesh.positions, [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    }
}

#[test]
fn bad_stl_files_are_errors() {
    message("a.stl", "");
    message("a.stl", "solid\n");
    assert!(message("a.stl", "solid a\nendsolid a\n").contains("no faces"));
    assert!(message("a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n").contains("vertex"));
    let mut bytes = vec![b'x'; 80];
    bytes.extend(1000u32.to_le_bytes());
    assert!(message("a.stl", &bytes).contains("expected 1000 triangles, found 0"));
}

#[test]
fn other_endings_and_missing_files() {
    assert!(message("a.fbx", "").contains(".obj, .ply or .stl"));
    let missing = load_mesh("no/such.obj".as_ref()).unwrap_err();
    assert!(matches!(missing, LoadError::Read { .. }) && missing.to_string().contains("no/such.obj"));
}

#[test]
fn smooth_normals_join_over_seams() {
    // Two triangles of a roof that share an edge in space but no vertex.
    let text = "v 0 0 0\nv 0 0 1\nv 1 1 0\nv 0 0 0\nv 0 0 1\nv -1 1 0\nf 1 2 3\nf 4 6 5\n";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("roof.obj");
    std::fs::write(&path, text).unwrap();
    let mesh = load_mesh_with(&path, LoadOptions { smooth: true, ..Default::default() }).unwrap();
    for (v, p) in mesh.positions.iter().enumerate().filter(|(_, p)| p[0] == 0.0) {
        assert_eq!(mesh.normals[v], [0.0, 1.0, 0.0], "{p:?}");
    }
}

#[test]
fn normals_without_direction_are_replaced() {
    let text = format!("{SQUARE}vn 0 0 0\nvn nan 0 0\nf 1//1 2//1 3//2\n");
    let mesh = load("a.obj", text).unwrap();
    assert_eq!(mesh.normals, [[0.0, 0.0, 1.0]; 3]);
    assert_eq!(mesh.report.normals_replaced, 3);
}

#[test]
fn described_meshes_come_from_all_sources() {
    use crate::describe::{self, Procedural, ProceduralKind};
    let vertices = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let inline = describe::Mesh::inline(vertices.clone(), vec![vec![0, 1, 2, 3]]);
    assert_eq!(load_described(&inline, "".as_ref()).unwrap().triangles, [[0, 1, 2], [0, 2, 3]]);
    let outside = describe::Mesh::inline(vertices, vec![vec![0, 1, 9]]);
    assert!(load_described(&outside, "".as_ref()).unwrap_err().to_string().contains("vertex 9"));
    let terrain = Procedural { kind: ProceduralKind::Terrain, triangles: 200, seed: 0 };
    let terrain = load_described(&describe::Mesh::procedural(terrain), "".as_ref()).unwrap();
    assert_eq!(terrain.triangles.len(), 200);
    let missing = describe::Mesh::from_path("gone.stl");
    let message = load_described(&missing, "somewhere".as_ref()).unwrap_err().to_string();
    assert!(message.starts_with("somewhere/gone.stl"), "{message}");
}
