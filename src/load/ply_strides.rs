//! Bodies of binary PLY files whose values lie at known places: read by those, not property by property.

use super::Mesh;
use super::polygon::triangulate;
use ply_rs_bw::ply::{ElementDef, Encoding, Header, PropertyType, ScalarType};

/// The mesh in the bytes behind a header. Nothing where they are laid out in another way, or are not what the header
/// says: the general way reads or explains those.
pub(super) fn read(header: &Header, body: &[u8]) -> Option<Mesh> {
    match header.encoding {
        Encoding::Ascii => None,
        Encoding::BinaryLittleEndian => elements::<Little>(header, body),
        Encoding::BinaryBigEndian => elements::<Big>(header, body),
    }
}

/// A byte order.
trait Order {
    fn u32(bytes: [u8; 4]) -> u32;
    fn f64(bytes: [u8; 8]) -> f64;
}

struct Little;

impl Order for Little {
    fn u32(bytes: [u8; 4]) -> u32 {
        u32::from_le_bytes(bytes)
    }

    fn f64(bytes: [u8; 8]) -> f64 {
        f64::from_le_bytes(bytes)
    }
}

struct Big;

impl Order for Big {
    fn u32(bytes: [u8; 4]) -> u32 {
        u32::from_be_bytes(bytes)
    }

    fn f64(bytes: [u8; 8]) -> f64 {
        f64::from_be_bytes(bytes)
    }
}

fn elements<O: Order>(header: &Header, mut body: &[u8]) -> Option<Mesh> {
    let mut mesh = Mesh::default();
    for (name, element) in &header.elements {
        body = match name.as_str() {
            "vertex" => vertices::<O>(&mut mesh, element, body)?,
            "face" => faces::<O>(&mut mesh, element, body)?,
            _ => split(element, body)?.1,
        };
    }
    Some(mesh)
}

/// The records of an element without lists, and what follows them.
fn split<'a>(element: &ElementDef, body: &'a [u8]) -> Option<(&'a [u8], &'a [u8])> {
    body.split_at_checked(stride(element)?.checked_mul(element.count)?)
}

/// Bytes of a record; nothing if they differ from record to record.
fn stride(element: &ElementDef) -> Option<usize> {
    element.properties.values().map(|property| size(&property.data_type)).sum()
}

/// Bytes of a property that is one number.
fn size(property: &PropertyType) -> Option<usize> {
    let PropertyType::Scalar(number) = property else { return None };
    Some(match number {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    })
}

/// Where a number lies in a record.
#[derive(Clone, Copy)]
enum Place {
    Float(usize),
    Double(usize),
}

impl Place {
    fn read<O: Order>(self, record: &[u8]) -> f32 {
        match self {
            Self::Float(at) => f32::from_bits(O::u32(array(&record[at..]))),
            Self::Double(at) => O::f64(array(&record[at..])) as f32,
        }
    }
}

/// The first bytes of a slice. **Panics** if it has fewer.
fn array<const N: usize>(bytes: &[u8]) -> [u8; N] {
    *bytes.first_chunk().expect("a record has all its properties")
}

fn vertices<'a, O: Order>(mesh: &mut Mesh, element: &ElementDef, body: &'a [u8]) -> Option<&'a [u8]> {
    let (records, rest) = split(element, body)?;
    let stride = stride(element)?;
    let has = |names: &[&str]| names.iter().all(|name| element.properties.contains_key(*name));
    mesh.positions = column::<O, 3>(records, stride, places(element, [&["x"], &["y"], &["z"]])?);
    if has(&["nx", "ny", "nz"]) {
        mesh.normals = column::<O, 3>(records, stride, places(element, [&["nx"], &["ny"], &["nz"]])?);
    }
    if super::ply::UV_NAMES.iter().any(|names| has(names)) {
        let names = [0, 1].map(|axis| super::ply::UV_NAMES.map(|names| names[axis]));
        mesh.uvs = column::<O, 2>(records, stride, places(element, names.each_ref().map(|n| &n[..]))?);
    }
    Some(rest)
}

/// Where each axis lies; of several properties for one axis the last one counts.
fn places<const N: usize>(element: &ElementDef, axes: [&[&str]; N]) -> Option<[Place; N]> {
    let mut found = [None; N];
    let mut at = 0;
    for (name, property) in &element.properties {
        if let Some(axis) = axes.iter().position(|names| names.contains(&name.as_str())) {
            found[axis] = Some(match property.data_type {
                PropertyType::Scalar(ScalarType::Float) => Place::Float(at),
                PropertyType::Scalar(ScalarType::Double) => Place::Double(at),
                _ => return None,
            });
        }
        at += size(&property.data_type)?;
    }
    let all: Vec<Place> = found.into_iter().collect::<Option<_>>()?;
    all.try_into().ok()
}

/// One attribute of all records.
fn column<O: Order, const N: usize>(records: &[u8], stride: usize, places: [Place; N]) -> Vec<[f32; N]> {
    records.chunks_exact(stride).map(|record| places.map(|place| place.read::<O>(record))).collect()
}

/// A record with the list of corners, one byte for their number and four for each.
struct FaceLayout {
    /// Bytes before the list.
    before: usize,
    /// Bytes behind it.
    after: usize,
    /// Whether the upper half of the corners are negative numbers.
    signed: bool,
}

impl FaceLayout {
    fn of(element: &ElementDef) -> Option<Self> {
        let mut found = None;
        let mut before = 0;
        for (name, property) in &element.properties {
            match (&property.data_type, name.as_str()) {
                (PropertyType::List(ScalarType::UChar, corner), "vertex_indices" | "vertex_index")
                    if found.is_none() =>
                {
                    let signed = match corner {
                        ScalarType::Int => true,
                        ScalarType::UInt => false,
                        _ => return None,
                    };
                    found = Some(Self { before: std::mem::take(&mut before), after: 0, signed });
                }
                (number, _) => before += size(number)?,
            }
        }
        found.map(|layout| Self { after: before, ..layout })
    }
}

fn faces<'a, O: Order>(mesh: &mut Mesh, element: &ElementDef, mut body: &'a [u8]) -> Option<&'a [u8]> {
    let FaceLayout { before, after, signed } = FaceLayout::of(element)?;
    let vertices = mesh.positions.len().min(if signed { 1 << 31 } else { usize::MAX });
    // As many triangles as there are bytes for: the header may promise anything.
    mesh.triangles.reserve(element.count.min(body.len() / (before + TRIANGLE + after)));
    let mut polygon = Vec::new();
    for _ in 0..element.count {
        let (&corners, rest) = body.get(before..)?.split_first()?;
        let (list, rest) = rest.split_at_checked(4 * usize::from(corners))?;
        body = rest.get(after..)?;
        let corners = list.chunks_exact(4).map(|corner| O::u32(array(corner)));
        polygon.clear();
        polygon.extend(corners);
        if polygon.iter().any(|&corner| corner as usize >= vertices) {
            return None;
        }
        mesh.report.degenerate += usize::from(polygon.len() < 3);
        triangulate(&mesh.positions, &polygon, &mut mesh.triangles);
    }
    Some(body)
}

/// Bytes of the list of a triangle's corners.
const TRIANGLE: usize = 13;
