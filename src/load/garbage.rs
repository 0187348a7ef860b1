//! Broken files: whatever the bytes, an error or a sound mesh, never a panic.

use super::*;

const OBJ: &str = "mtllib a.mtl\nv 0 0 0\nv 1 0 0 1 1 1\nv 1 1 0 2\nv 0 1 0\nvt 0 0\nvn 0 0 1\nusemtl red\n\
    f 1/1/1 2/1/1 3/1/1 4/1/1\no x\nf -1//-1 -2//-1 -3//-1\nl 1 2 3 4\ng y\nf 1 2 \\\n3\n";
const MTL: &str = "newmtl red\nKd 1 0 0\nKs 0.5\nNs 10\nNi 1.5\nd 0.5\nTr 0.5\nillum 4\nTf 1 1 1\nKe 0 0 0\n";
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
    property float nx\nproperty float ny\nproperty float nz\nelement face 2\n\
    property list uchar int vertex_indices\nend_header\n0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n\
    4 0 1 2 3\n3 0 1 2\n";
const STL: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n\
    endfacet\nendsolid a\n";
/// Pieces that parsers trip over.
const PIECES: [&str; 16] = [
    "nan",
    "inf",
    "-inf",
    "1e999",
    "-",
    "/",
    "//",
    "\\\n",
    "\0",
    "4294967295",
    "-9223372036854775808",
    "\n",
    " ",
    "#",
    "list",
    "f 1 1 1 1 1 1\n",
];

/// A repeatable sequence of numbers (PCG's multiplier, upper half of the state).
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % limit.max(1)
    }
}

/// One to three changes: a byte, a cut, a piece put in, a stretch doubled.
fn broken(text: &str, numbers: &mut Numbers) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    for _ in 0..=numbers.below(3) {
        let at = numbers.below(bytes.len());
        match numbers.below(4) {
            0 if !bytes.is_empty() => bytes[at] = numbers.below(256) as u8,
            1 => bytes.truncate(at),
            2 => {
                let piece = PIECES[numbers.below(PIECES.len())].bytes();
                bytes.splice(at..at, piece);
            }
            _ => {
                let end = (at + numbers.below(40)).min(bytes.len());
                bytes.extend_from_within(at..end);
            }
        }
    }
    bytes
}

fn is_sound(mesh: &Mesh) -> bool {
    let vertices = mesh.positions.len();
    let finite = |v: &u32| mesh.positions[*v as usize].iter().all(|x| x.is_finite());
    mesh.triangles.as_flattened().iter().all(|v| (*v as usize) < vertices && finite(v))
        && (mesh.normals.is_empty() || mesh.normals.len() == vertices)
        && (mesh.uvs.is_empty() || mesh.uvs.len() == vertices)
        && (mesh.triangle_materials.is_empty() || mesh.triangle_materials.len() == mesh.triangles.len())
        && mesh.triangle_materials.iter().all(|&m| (m as usize) < mesh.materials.len())
}

#[test]
fn broken_files_are_errors_or_sound_meshes() {
    let folder = tempfile::tempdir().unwrap();
    let mut numbers = Numbers(7);
    let mut loaded = [0; 2];
    for _ in 0..3000 {
        std::fs::write(folder.path().join("a.mtl"), broken(MTL, &mut numbers)).unwrap();
        for (name, text) in [("a.obj", OBJ), ("a.ply", PLY), ("a.stl", STL)] {
            let path = folder.path().join(name);
            let bytes = broken(text, &mut numbers);
            std::fs::write(&path, &bytes).unwrap();
            let result = load_mesh(&path);
            loaded[usize::from(result.is_ok())] += 1;
            if let Ok(mesh) = result {
                assert!(is_sound(&mesh), "{name}: {:?}", String::from_utf8_lossy(&bytes));
            }
        }
    }
    assert!(loaded.iter().all(|&count| count > 500), "both ways must be seen: {loaded:?}");
}
