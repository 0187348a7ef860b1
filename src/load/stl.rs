//! STL, text and binary, through `stl_io`.

use super::{LoadError, Mesh};
use std::collections::HashMap;
use std::io::Cursor;
use std::path::Path;

/// Binary files: a header of 80 bytes and the number of triangles.
const HEAD: usize = 84;
/// Binary files: bytes a triangle.
const RECORD: usize = 50;

/// The mesh in an STL file. Corners at the same place become one vertex; facet normals are left, as they follow from
/// the corners.
pub(super) fn parse(path: &Path, mut bytes: Vec<u8>) -> Result<Mesh, LoadError> {
    let malformed = |message: String| LoadError::malformed(path, None, message);
    if let Some(count) = binary_count(&bytes) {
        let room = (bytes.len() - HEAD) / RECORD;
        if room < count {
            return Err(malformed(format!("is cut off: expected {count} triangles, found {room}")));
        }
        // Binary headers may begin with "solid" as well; the reader would then take the file for text.
        bytes[0] = b'-';
    } else if bytes.starts_with(b"solid\n") || bytes.starts_with(b"solid\r") {
        // The reader expects a space behind "solid" even when no name follows.
        bytes.insert(5, b' ');
    } else if !bytes.starts_with(b"solid ") {
        return Err(malformed(format!(
            "is no STL file: {} bytes, expected text or at least {HEAD}",
            bytes.len()
        )));
    }
    let mut source = Cursor::new(bytes);
    let triangles = stl_io::create_stl_reader(&mut source).map_err(|e| malformed(e.to_string()))?;
    let mut mesh = Mesh::default();
    let mut vertices = HashMap::new();
    for triangle in triangles {
        let corners = triangle.map_err(|e| malformed(e.to_string()))?.vertices;
        mesh.triangles.push(corners.map(|corner| {
            *vertices.entry(corner.0.map(f32::to_bits)).or_insert_with(|| {
                mesh.positions.push(corner.0);
                mesh.positions.len() as u32 - 1
            })
        }));
    }
    Ok(mesh)
}

/// The number of triangles of a binary file, `None` for a text file.
fn binary_count(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(HEAD - 4..HEAD)?;
    let count = u32::from_le_bytes([count[0], count[1], count[2], count[3]]) as usize;
    let exact = bytes.len() == HEAD + RECORD * count;
    (exact || !bytes.starts_with(b"solid")).then_some(count)
}
