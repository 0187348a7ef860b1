//! The statements of an OBJ text as columns and corners, every complaint with its line.
//!
//! The text is cut into pieces between statements. A first pass counts what each piece declares, so that a second one
//! can resolve and check every number of a face where it stands, all pieces at once; what comes out does not depend on
//! how they were cut.

use super::obj_piece::Piece;
use super::obj_words::{Statements, Words, pieces};
use rayon::prelude::*;

/// What an OBJ text says, in its order.
#[derive(Debug, Default, PartialEq)]
pub(super) struct ObjText {
    pub(super) positions: Vec<[f32; 3]>,
    pub(super) uvs: Vec<[f32; 2]>,
    pub(super) normals: Vec<[f32; 3]>,
    /// The corners of all faces: places in the columns of positions, texture coordinates and normals.
    pub(super) corners: Vec<[u32; 3]>,
    /// How many corners each face has, at least three.
    pub(super) arities: Vec<u32>,
    /// Between faces.
    pub(super) marks: Vec<Mark>,
    /// Faces with fewer than three corners.
    pub(super) thin_faces: usize,
    /// True for the attributes that faces name and the file does not have.
    pub(super) absent: [bool; 3],
}

/// Something that applies to the faces that follow.
#[derive(Debug, PartialEq)]
pub(super) struct Mark {
    /// How many faces stand before it.
    pub(super) face: usize,
    pub(super) line: usize,
    pub(super) kind: MarkKind,
}

#[derive(Debug, PartialEq)]
pub(super) enum MarkKind {
    /// `o` or `g`.
    Group,
    /// `mtllib` with its file names.
    Library(String),
    /// `usemtl`.
    Material(String),
}

/// What is wrong in which line.
pub(super) type LineError = (usize, String);

/// The place of an attribute that a corner does not have.
pub(super) const NONE: u32 = u32::MAX;

/// What corners of faces are made of.
pub(super) const KINDS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// Bytes a piece: enough to be worth a thread's while.
const PIECE_BYTES: usize = 1 << 18;

/// The columns and faces of an OBJ text.
///
/// # Errors
/// The first statement that makes no sense, or a face that points outside the file.
pub(super) fn read(source: &[u8]) -> Result<ObjText, LineError> {
    read_in(source, PIECE_BYTES)
}

fn read_in(source: &[u8], piece_bytes: usize) -> Result<ObjText, LineError> {
    let pieces = pieces(source.strip_prefix(b"\xef\xbb\xbf").unwrap_or(source), piece_bytes);
    let counts: Vec<Counts> = pieces.par_iter().map(|piece| Counts::of(piece)).collect();
    let mut total = Counts { lines: 1, kinds: [0; 3] };
    let starts: Vec<Counts> = counts.iter().map(|piece| total.advance(piece)).collect();
    if let Some(kind) = (0..3).find(|&kind| total.kinds[kind] >= i64::from(NONE)) {
        let [name, count] = [KINDS[kind], &total.kinds[kind].to_string()];
        return Err((1, format!("has {count} of kind {name}: at most 2^32 - 2 can be numbered")));
    }
    let read = |(piece, start): (&&[u8], Counts)| Piece::read(piece, start, total.kinds);
    let parts: Vec<Result<ObjText, LineError>> = pieces.par_iter().zip(starts).map(read).collect();
    let mut text = ObjText::default();
    for part in parts {
        text.append(part?);
    }
    Ok(text)
}

/// Lines, and statements of each of [`KINDS`].
#[derive(Clone, Copy)]
pub(super) struct Counts {
    pub(super) lines: usize,
    pub(super) kinds: [i64; 3],
}

impl Counts {
    fn of(piece: &[u8]) -> Self {
        let mut kinds = [0; 3];
        let mut statements = Statements::of(piece, 0);
        for (_, statement) in &mut statements {
            match Words::of(&statement).next() {
                Some(b"v") => kinds[0] += 1,
                Some(b"vt") => kinds[1] += 1,
                Some(b"vn") => kinds[2] += 1,
                _ => {}
            }
        }
        Self { lines: statements.line, kinds }
    }

    /// What there was before, and then also what `by` counts.
    fn advance(&mut self, by: &Self) -> Self {
        let before = *self;
        self.lines += by.lines;
        self.kinds = std::array::from_fn(|kind| self.kinds[kind] + by.kinds[kind]);
        before
    }
}

impl ObjText {
    /// Each `mtllib` line and its file names.
    pub(super) fn libraries(&self) -> impl Iterator<Item = (usize, &str)> {
        self.marks.iter().filter_map(|mark| match &mark.kind {
            MarkKind::Library(names) => Some((mark.line, names.as_str())),
            _ => None,
        })
    }

    /// Each `usemtl` line and its material.
    pub(super) fn materials(&self) -> impl Iterator<Item = (usize, &str)> {
        self.marks.iter().filter_map(|mark| match &mark.kind {
            MarkKind::Material(name) => Some((mark.line, name.as_str())),
            _ => None,
        })
    }

    /// What was odd but could be read.
    pub(super) fn notes(&self) -> Vec<String> {
        let absent = (0..3).filter(|&kind| self.absent[kind]);
        absent.map(|kind| format!("faces name {}s, but the file has none", KINDS[kind])).collect()
    }

    fn append(&mut self, mut part: Self) {
        let faces = self.arities.len();
        self.marks.extend(part.marks.drain(..).map(|mark| Mark { face: mark.face + faces, ..mark }));
        self.positions.append(&mut part.positions);
        self.uvs.append(&mut part.uvs);
        self.normals.append(&mut part.normals);
        self.corners.append(&mut part.corners);
        self.arities.append(&mut part.arities);
        self.thin_faces += part.thin_faces;
        self.absent = std::array::from_fn(|kind| self.absent[kind] || part.absent[kind]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

    fn fault(faces: &str) -> LineError {
        read(format!("{TRIANGLE}{faces}").as_bytes()).unwrap_err()
    }

    #[test]
    fn indices_outside_name_their_line() {
        assert_eq!(fault("f 1 2 3\nf 1 2 4\n"), (5, "a face uses vertex 4: the file has 3".into()));
        assert_eq!(fault("f 0 1 2").0, 4);
        assert!(fault("f -4 -2 -1").1.contains("counts back to a vertex before the first"));
        assert!(fault("vt 0 0\nf 1/1 2/2 3/1").1.contains("texture coordinate 2: the file has 1"));
        assert!(fault("vn 0 0 1\nf 1//1 2//-2 3//1").1.contains("normal before the first"));
        assert!(fault("f 1//-2 2//1 3//1\nvn 0 0 1").1.contains("normal before the first"));
        for bad in [
            "f 1 2 x",
            "f 1/2/3/4 1 2",
            "f / 1 2",
            "f 99999999999999999999 1 2",
            "f -9223372036854775808 1 2",
            "f 1 2 3 # four",
            "vt zero",
            "vt 0 # one",
            "vn 0 0",
            "v 0 0 0 0",
            "v 0 0 0 x",
            "usemtl ",
        ] {
            assert_eq!(fault(bad).0, 4, "{bad}");
        }
    }

    #[test]
    fn numbers_of_attributes_that_are_nowhere_are_ignored() {
        let text = read(format!("{TRIANGLE}f 1/7/-2 2/8/1 3/9/1\n").as_bytes()).unwrap();
        assert_eq!(text.notes().len(), 2, "{:?}", text.notes());
        assert_eq!(text.corners, [[0, NONE, NONE], [1, NONE, NONE], [2, NONE, NONE]]);
    }

    #[test]
    fn marks_keep_lines_and_faces() {
        let text =
            read(b"mtllib a b.mtl\nv 0 0 \\\n0\nl 1 2\nvt 0.5\nf 1 1 1\nusemtl\tred \n g x\n").unwrap();
        assert_eq!(text.libraries().collect::<Vec<_>>(), [(1, "a b.mtl")]);
        assert_eq!(text.materials().collect::<Vec<_>>(), [(7, "red")]);
        assert_eq!(text.marks[2], Mark { face: 1, line: 8, kind: MarkKind::Group });
        assert_eq!(text.uvs, [[0.5, 0.0]]);
    }

    #[test]
    fn colours_go_weights_divide_and_thin_faces_are_counted() {
        let text = read(b"v 0 0 0 1 0.5 0\nv 1 0 4 2\nf 1 2\nf 1\n").unwrap();
        assert_eq!(text.positions, [[0.0; 3], [0.5, 0.0, 2.0]]);
        assert_eq!((text.thin_faces, text.corners.len()), (2, 0));
    }

    #[test]
    fn all_cuts_give_the_same() {
        let source = format!(
            "{TRIANGLE}vt 0 1\ng a\nf -3/1 -2 \\\n -1\nv 2 \\\r\n2 2\r\nusemtl x\nf 1 2 3 4\nvn 0 0 1\nf 4//-1 -2 1\nf 1\n"
        );
        let whole = read(source.as_bytes()).unwrap();
        assert_eq!(whole.corners[7], [3, NONE, 0]);
        let broken = source.replace("f 4//-1", "f 9//-1");
        for bytes in 0..source.len() {
            assert_eq!(read_in(source.as_bytes(), bytes).unwrap(), whole, "{bytes}");
            assert_eq!(read_in(broken.as_bytes(), bytes).unwrap_err().0, 13, "{bytes}");
        }
    }
}
