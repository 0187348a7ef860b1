//! PLY bytes to a mesh.
#![no_main]

mod mesh_file;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| mesh_file::load("a.ply", bytes));
