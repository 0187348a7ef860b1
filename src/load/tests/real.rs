//! Files as people find them, where they are at hand.

use std::path::{Path, PathBuf};

use crate::load::load_mesh;

/// A real scene file, or `None`, said aloud, where it is not at hand.
fn real(file: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/scenes").join(file);
    if !path.exists() {
        println!("skipped: {file} is not at hand");
    }
    path.exists().then_some(path)
}

#[test]
fn real_files_have_their_known_triangle_counts() {
    for (file, triangles) in REAL_FILES {
        let Some(path) = real(file) else { continue };
        let mesh = load_mesh(&path).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(mesh.report.triangles_read, *triangles, "{file}");
        assert_eq!(mesh.triangles.len() + mesh.report.degenerate, *triangles, "{file}");
        assert!(mesh.triangle_materials.is_empty() || mesh.triangle_materials.len() == mesh.triangles.len());
        assert!(mesh.normals.is_empty() || mesh.normals.len() == mesh.positions.len(), "{file}");
        assert!(mesh.uvs.is_empty() || mesh.uvs.len() == mesh.positions.len(), "{file}");
    }
}

#[test]
fn real_files_with_faults_are_refused() {
    for (file, part) in [
        ("ply/points_ascii.ply", "5 points but no faces"),
        ("ply/points_bin.ply", "5 points but no faces"),
        ("obj/polygonfaces.obj", "surface.mtl cannot be read"),
    ] {
        let Some(path) = real(file) else { continue };
        let message = load_mesh(&path).unwrap_err().to_string();
        assert!(message.contains(part), "{message}");
    }
}

#[test]
fn the_dragon_has_its_triangles_without_area() {
    let Some(path) = real("dragon/dragon.ply") else { return };
    assert_eq!(load_mesh(&path).unwrap().report.degenerate, 108);
}

const REAL_FILES: &[(&str, usize)] = &[
    ("dragon/dragon.ply", 871_414),
    ("dragon/dragon_res2_big_endian.ply", 202_520),
    ("dragon/dragon_res3_ascii.ply", 47_794),
    ("classic/stanford_bunny.obj", 69_451),
    ("classic/armadillo.obj", 86_482),
    ("classic/nefertiti.obj", 99_938),
    ("classic/utah_teapot.obj", 6_320),
    ("classic/suzanne.obj", 968),
    ("classic/cow.obj", 5_804),
    ("classic/spot/spot_triangulated.obj", 5_856),
    ("classic/spot/spot_quadrangulated.obj", 5_856),
    ("classic/spot/spot_control_mesh.obj", 372),
    ("sponza/sponza.obj", 66_454),
    ("living_room/living_room.obj", 143_163),
    ("modern_hall/modern_hall.obj", 31_077),
    ("cornell_box/cornell_box.obj", 34),
    ("cornell_box/spheres.obj", 1_922),
    ("foliage/sponza_column_shrubbery.obj", 31_436),
    ("foliage/generated_hairball.ply", 192_000),
    ("obj/box.obj", 12),
    ("obj/groups.obj", 2_308),
    ("obj/negative_indices.obj", 12),
    ("obj/two_objects.obj", 16),
    ("obj/cube_compressed.obj", 12),
    ("obj/cubevt.obj", 12),
    ("obj/textured_tetrahedron.obj", 4),
    ("obj/capsule.obj", 10_200),
    ("ply/fuze.ply", 1_000),
    ("ply/fuze_ascii.ply", 1_000),
    ("ply/reference.ply", 1_610),
    ("ply/cycloidal.ply", 43_368),
    ("ply/bunny.ply", 16_301),
    ("ply/suzanne.ply", 968),
    ("ply/cube_blender_uv.ply", 12),
    ("ply/BoxTextured.ply", 12),
    ("ply/sphere.ply", 1_280),
    ("ply/metadata.ply", 2),
    ("ply/multi.ply", 2),
    ("ply/plane_tri.ply", 2),
    ("ply/mirror.ply", 286),
    ("ply/bunny_lowres.ply", 948),
];
