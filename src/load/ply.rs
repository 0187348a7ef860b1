//! PLY, text and both binary byte orders: headers through `ply-rs-bw`, and bodies too where they have no fixed strides.

use super::polygon::triangulate;
use super::{LoadError, Mesh, ply_strides};
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult};
use std::path::Path;

/// The mesh in a PLY file: `vertex` with `x y z`, optionally `nx ny nz` and texture coordinates, and `face`.
pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<Mesh, LoadError> {
    let (header, mut reader) = header(path, bytes)?;
    match ply_strides::read(&header, reader.get_ref()) {
        Some(mesh) => Ok(mesh),
        None => read_body(path, &header, &mut reader),
    }
}

/// The header of a file with vertices, and what is behind it.
pub(super) fn header<'a>(path: &Path, bytes: &'a [u8]) -> Result<(Header, Reader<&'a [u8]>), LoadError> {
    let mut reader = Reader::new(bytes);
    let header = Parser::<Skipped>::new().read_header(&mut reader);
    let header = header.map_err(|error| unreadable(path, &error, Encoding::Ascii))?;
    check_vertex(&header, path)?;
    Ok((header, reader))
}

/// The mesh behind a header, whatever its properties are.
pub(super) fn read_body(path: &Path, header: &Header, reader: &mut Reader<&[u8]>) -> Result<Mesh, LoadError> {
    let explain = |error: ParseError| unreadable(path, &error, header.encoding);
    let mut mesh = Mesh::default();
    for (name, element) in &header.elements {
        // Takes no byte however many there are, and would take memory for each.
        if element.properties.is_empty() && header.encoding != Encoding::Ascii {
            continue;
        }
        match name.as_str() {
            "vertex" => add_vertices(&mut mesh, reader, element, header).map_err(explain)?,
            "face" => {
                let faces = Parser::<Face>::new().read_payload_for_element(reader, element, header);
                add_faces(&mut mesh, &faces.map_err(explain)?, path)?;
            }
            _ => {
                let skipped = Parser::<Skipped>::new();
                skipped.read_payload_for_element(reader, element, header).map_err(explain)?;
            }
        }
    }
    Ok(mesh)
}

/// The parser's message carries the line and the text in several lines: ours has one, the line stands in front. Bytes have no
/// lines, though the parser counts on behind those of the header.
fn unreadable(path: &Path, error: &ParseError, encoding: Encoding) -> LoadError {
    let (line, message) = (error.line(), error.to_string());
    let message = message.split_once(": ").filter(|_| line.is_some()).map_or(&*message, |(_, rest)| rest);
    let shown: Vec<&str> = message.split_whitespace().collect();
    let shown: String = shown.join(" ").chars().take(300).collect();
    LoadError::malformed(path, line.filter(|_| encoding == Encoding::Ascii), shown)
}

fn check_vertex(header: &Header, path: &Path) -> Result<(), LoadError> {
    let has = |name: &str| header.elements.get("vertex").is_some_and(|v| v.properties.contains_key(name));
    match ["x", "y", "z"].into_iter().find(|name| !has(name)) {
        None => Ok(()),
        Some(name) => {
            Err(LoadError::malformed(path, None, format!("vertices have no `{name}`: expected x, y and z")))
        }
    }
}

fn add_vertices(
    mesh: &mut Mesh,
    reader: &mut Reader<&[u8]>,
    element: &ElementDef,
    header: &Header,
) -> Result<(), ParseError> {
    let vertices = Parser::<Vertex>::new().read_payload_for_element(reader, element, header)?;
    let has = |names: &[&str]| names.iter().all(|name| element.properties.contains_key(*name));
    mesh.positions = vertices.iter().map(|v| v.position).collect();
    if has(&["nx", "ny", "nz"]) {
        mesh.normals = vertices.iter().map(|v| v.normal).collect();
    }
    if UV_NAMES.iter().any(|names| has(names)) {
        mesh.uvs = vertices.iter().map(|v| v.uv).collect();
    }
    Ok(())
}

fn add_faces(mesh: &mut Mesh, faces: &[Face], path: &Path) -> Result<(), LoadError> {
    mesh.triangles.reserve(faces.len());
    let count = mesh.positions.len();
    for (number, Face { corners }) in faces.iter().enumerate() {
        if let Some(bad) = corners.iter().find(|&&v| v as usize >= count) {
            let message = format!("face {number} uses vertex {bad}: there are {count}, counted from 0");
            return Err(LoadError::malformed(path, None, message));
        }
        mesh.report.degenerate += usize::from(corners.len() < 3);
        triangulate(&mesh.positions, corners, &mut mesh.triangles);
    }
    Ok(())
}

/// The names under which programs write texture coordinates.
pub(super) const UV_NAMES: [[&str; 2]; 4] =
    [["s", "t"], ["u", "v"], ["texture_u", "texture_v"], ["texture_s", "texture_t"]];

/// What we keep of a vertex.
#[derive(Default)]
struct Vertex {
    position: [f32; 3],
    normal: [f32; 3],
    uv: [f32; 2],
}

impl Vertex {
    fn set(&mut self, name: &str, value: f32) -> PropertyAccessResult {
        let slot = match name {
            "x" => &mut self.position[0],
            "y" => &mut self.position[1],
            "z" => &mut self.position[2],
            "nx" => &mut self.normal[0],
            "ny" => &mut self.normal[1],
            "nz" => &mut self.normal[2],
            "s" | "u" | "texture_u" | "texture_s" => &mut self.uv[0],
            "t" | "v" | "texture_v" | "texture_t" => &mut self.uv[1],
            _ => return PropertyAccessResult::Ignored,
        };
        *slot = value;
        PropertyAccessResult::Set
    }
}

// The typed setters skip the library's general `Property`, which would cost most of the time.
impl PropertyAccess for Vertex {
    fn new() -> Vertex {
        Vertex::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        property.to_f32_lossy().map_or(PropertyAccessResult::Ignored, |value| self.set(name, value))
    }

    fn set_float(&mut self, name: &str, value: f32) -> PropertyAccessResult {
        self.set(name, value)
    }

    fn set_double(&mut self, name: &str, value: f64) -> PropertyAccessResult {
        self.set(name, value as f32)
    }

    fn set_uchar(&mut self, _: &str, _: u8) -> PropertyAccessResult {
        PropertyAccessResult::Ignored
    }
}

/// The corners of a face.
#[derive(Default)]
struct Face {
    corners: Vec<u32>,
}

impl Face {
    /// Keeps corners; a negative one becomes a number that no mesh has and is refused later.
    fn set<T: TryInto<u32>>(&mut self, name: &str, corners: Vec<T>) -> PropertyAccessResult {
        if !matches!(name, "vertex_indices" | "vertex_index") {
            return PropertyAccessResult::Ignored;
        }
        self.corners = corners.into_iter().map(|v| v.try_into().unwrap_or(u32::MAX)).collect();
        PropertyAccessResult::Set
    }
}

impl PropertyAccess for Face {
    fn new() -> Face {
        Face::default()
    }

    fn set_list_char(&mut self, name: &str, corners: Vec<i8>) -> PropertyAccessResult {
        self.set(name, corners)
    }

    fn set_list_uchar(&mut self, name: &str, corners: Vec<u8>) -> PropertyAccessResult {
        self.set(name, corners)
    }

    fn set_list_short(&mut self, name: &str, corners: Vec<i16>) -> PropertyAccessResult {
        self.set(name, corners)
    }

    fn set_list_ushort(&mut self, name: &str, corners: Vec<u16>) -> PropertyAccessResult {
        self.set(name, corners)
    }

    fn set_list_int(&mut self, name: &str, corners: Vec<i32>) -> PropertyAccessResult {
        self.set(name, corners)
    }

    fn set_list_uint(&mut self, name: &str, corners: Vec<u32>) -> PropertyAccessResult {
        self.set(name, corners)
    }
}

/// Elements that are no mesh: read, to come to what follows, and forgotten.
struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Skipped {
        Skipped
    }
}
