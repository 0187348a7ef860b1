//! Binary PLY by strides gives what the general way gives, whatever the header says.

use super::ply::{header, read_body};
use super::{Mesh, ply_strides};
use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;
use proptest::sample::{select, subsequence};
use std::path::Path;

/// Types of numbers in the order of their codes here.
const TYPES: [&str; 8] = ["char", "uchar", "short", "ushort", "int", "uint", "float", "double"];
const UCHAR: usize = 1;
const INTS: [usize; 2] = [4, 5];
const FLOATS: [usize; 2] = [6, 7];

/// A property: its name, the type of its numbers, and that of their count if it is a list.
#[derive(Debug, Clone)]
struct Column {
    name: &'static str,
    number: usize,
    count: Option<usize>,
}

/// An element: its name, how many there are, its properties.
type Element = (&'static str, usize, Vec<Column>);

/// A file in pieces; its numbers are taken from `pool` in turn.
#[derive(Debug, Clone)]
struct File {
    big: bool,
    elements: Vec<Element>,
    pool: Vec<u8>,
}

fn column(name: &'static str, number: usize) -> Column {
    Column { name, number, count: None }
}

/// Properties that no mesh needs.
fn extras() -> impl Strategy<Value = Vec<Column>> {
    let names = subsequence(vec!["red", "alpha", "confidence", "flags"], 0..=3);
    (names, vec((0..TYPES.len(), option::weighted(0.1, Just(UCHAR))), 3)).prop_map(|(names, types)| {
        let of = |(name, (number, count))| Column { name, number, count };
        names.into_iter().zip(types).map(of).collect()
    })
}

/// Mostly floating-point numbers, sometimes others.
fn coordinate() -> impl Strategy<Value = usize> {
    prop_oneof![20 => select(&FLOATS[..]), 1 => 0..TYPES.len()]
}

fn vertex() -> impl Strategy<Value = Vec<Column>> {
    let optional = vec!["nx", "ny", "nz", "s", "t", "u", "v", "texture_u", "texture_v"];
    let all = prop_oneof![Just(vec!["x", "y", "z", "nx", "ny", "nz"]), Just(vec!["z", "x", "y", "u", "v"])];
    let some = subsequence(optional, 0..9).prop_map(|names| [vec!["x", "y", "z"], names].concat());
    (prop_oneof![all, some], vec(coordinate(), 12), extras()).prop_flat_map(|(names, types, extras)| {
        let named = names.into_iter().zip(types).map(|(name, number)| column(name, number));
        Just(named.chain(extras).collect::<Vec<_>>()).prop_shuffle()
    })
}

fn face() -> impl Strategy<Value = Vec<Column>> {
    let count = prop_oneof![9 => Just(UCHAR), 1 => 0..6usize];
    let corner = prop_oneof![9 => select(&INTS[..]), 1 => 0..6usize];
    (select(vec!["vertex_indices", "vertex_index"]), count, corner, extras()).prop_flat_map(
        |(name, count, number, extras)| {
            let list = Column { name, number, count: Some(count) };
            Just([vec![list], extras].concat()).prop_shuffle()
        },
    )
}

fn file() -> impl Strategy<Value = File> {
    let more = |name: &'static str| (Just(name), 0..4usize, extras());
    let elements = (
        (Just("vertex"), 0..9usize, vertex()),
        (Just("face"), 0..9usize, face()),
        option::weighted(0.3, more("edge")),
        option::weighted(0.3, more("camera")),
    );
    let elements = elements.prop_map(|(vertex, face, edge, camera)| {
        edge.into_iter().chain([vertex]).chain(camera).chain([face]).collect()
    });
    (any::<bool>(), elements, vec(any::<u8>(), 1..40)).prop_map(|(big, elements, pool)| File {
        big,
        elements,
        pool,
    })
}

impl File {
    fn bytes(&self) -> Vec<u8> {
        let order = if self.big { "big" } else { "little" };
        let mut bytes = format!("ply\nformat binary_{order}_endian 1.0\n").into_bytes();
        for (name, count, columns) in &self.elements {
            bytes.extend(format!("element {name} {count}\n").bytes());
            for Column { name, number, count } in columns {
                let list = count.map_or(String::new(), |count| format!("list {} ", TYPES[count]));
                bytes.extend(format!("property {list}{} {name}\n", TYPES[*number]).bytes());
            }
        }
        bytes.extend(b"end_header\n");
        let mut pool = self.pool.iter().copied().cycle();
        let mut next = || pool.next().expect("the pool is not empty");
        for (_, count, columns) in &self.elements {
            for column in (0..*count).flat_map(|_| columns) {
                let numbers = column.count.map_or(1, |count| {
                    let numbers = next() % 6;
                    self.push(&mut bytes, count, numbers);
                    numbers
                });
                (0..numbers).for_each(|_| self.push(&mut bytes, column.number, next() % 10));
            }
        }
        bytes
    }

    /// One number; floating-point ones have fractions.
    fn push(&self, bytes: &mut Vec<u8>, number: usize, value: u8) {
        let float = f64::from(value) / 4.0;
        let mut little = match TYPES[number] {
            "char" | "uchar" => vec![value],
            "short" | "ushort" => u16::from(value).to_le_bytes().to_vec(),
            "int" | "uint" => u32::from(value).to_le_bytes().to_vec(),
            "float" => (float as f32).to_le_bytes().to_vec(),
            _ => float.to_le_bytes().to_vec(),
        };
        if self.big {
            little.reverse();
        }
        bytes.extend(little);
    }
}

/// Both readings: by strides if they apply, and the general one.
fn both(bytes: &[u8]) -> (Option<Mesh>, Result<Mesh, String>) {
    let path = Path::new("a.ply");
    let (header, mut reader) = header(path, bytes).unwrap();
    let strided = ply_strides::read(&header, reader.get_ref());
    (strided, read_body(path, &header, &mut reader).map_err(|error| error.to_string()))
}

proptest! {
    #[test]
    fn strides_read_what_the_general_way_reads(file in file(), cut in 0..30usize) {
        let bytes = file.bytes();
        let (strided, general) = both(&bytes);
        if let Some(strided) = strided {
            prop_assert_eq!(Ok(strided), general);
        }
        let body = bytes.len() - bytes.windows(11).position(|w| w == b"end_header\n").unwrap() - 11;
        let (strided, general) = both(&bytes[..bytes.len() - cut.min(body)]);
        prop_assert!(strided.is_none() || Ok(strided.unwrap()) == general, "cut by {}", cut);
        let surplus = [&bytes[..], &[7; 5]].concat();
        let (strided, general) = both(&surplus);
        prop_assert!(strided.is_none() || Ok(strided.unwrap()) == general, "with more behind it");
    }
}

/// A file such as most programs write.
fn usual(big: bool, corners: &[u8]) -> Vec<u8> {
    let vertex = ["x", "y", "z", "nx", "ny", "nz", "u", "v"].map(|name| column(name, FLOATS[0]));
    let face = Column { name: "vertex_indices", number: INTS[0], count: Some(UCHAR) };
    let elements = vec![("vertex", 4, vertex.to_vec()), ("face", 1, vec![face])];
    let pool = (0..32).chain([corners.len() as u8]).chain(corners.iter().copied()).collect();
    File { big, elements, pool }.bytes()
}

#[test]
fn usual_files_are_read_by_strides() {
    for big in [false, true] {
        for (corners, triangles) in [(&[0, 1, 2][..], 1), (&[0, 1, 2, 3], 2), (&[0, 1], 0)] {
            let (strided, general) = both(&usual(big, corners));
            let mesh = strided.expect("has fixed strides");
            assert_eq!(mesh.triangles.len(), triangles);
            assert_eq!((mesh.normals.len(), mesh.uvs.len()), (4, 4));
            assert_eq!(Ok(mesh), general);
        }
    }
}

#[test]
fn what_is_wrong_is_left_to_the_general_way_to_tell() {
    let (strided, general) = both(&usual(false, &[0, 1, 7]));
    assert!(strided.is_none() && general.unwrap_err().contains("face 0 uses vertex 7"));
    let mut bytes = usual(false, &[0, 1, 2]);
    let last = bytes.len() - 1;
    bytes[last] = 0xff;
    let (strided, general) = both(&bytes);
    assert!(strided.is_none() && general.unwrap_err().contains("face 0 uses vertex 4294967295"));
}

/// Neither way takes memory for what a header only promises.
#[test]
fn promises_of_a_header_take_no_memory() {
    let xyz = "property float x\nproperty float y\nproperty float z\n";
    let list = "property list uchar int vertex_indices\n";
    for (header, word) in [
        (format!("element vertex 4294967295\n{xyz}element face 1\n{list}"), "vertex"),
        (format!("element vertex 18446744073709551615\n{xyz}element face 1\n{list}"), "vertex"),
        (format!("element vertex 1\n{xyz}element face 4294967295\n{list}"), "face"),
        (format!("element vertex 4294967295\nelement face 1\n{list}"), "no `x`"),
        (format!("element vertex 1\n{xyz}element face 4294967295\n"), "no faces"),
        (format!("element edge 4294967295\nelement vertex 1\n{xyz}element face 1\n{list}"), "face"),
    ] {
        for order in ["little", "big"] {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("a.ply");
            let text = format!("ply\nformat binary_{order}_endian 1.0\n{header}end_header\n");
            std::fs::write(&path, [text.as_bytes(), &[0; 12]].concat()).unwrap();
            let error = super::load_mesh(&path).unwrap_err().to_string();
            assert!(error.contains(word), "{header}: {error}");
        }
    }
}
