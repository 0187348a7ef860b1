//! OBJ bytes to a mesh; a line `%%MTL` divides them from an MTL file called `a.mtl`.
#![no_main]

mod mesh_file;

use libfuzzer_sys::fuzz_target;

const DIVIDER: &[u8] = b"%%MTL\n";

fuzz_target!(|bytes: &[u8]| {
    let at = bytes.windows(DIVIDER.len()).position(|window| window == DIVIDER);
    let (obj, mtl) = at.map_or((bytes, &[][..]), |at| (&bytes[..at], &bytes[at + DIVIDER.len()..]));
    mesh_file::write("a.mtl", mtl);
    mesh_file::load("a.obj", obj);
});
