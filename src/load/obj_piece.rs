//! One piece of an OBJ text, statement by statement: numbers, faces whose corners are resolved where they stand, marks.

use super::obj_text::{Counts, KINDS, LineError, Mark, MarkKind, NONE, ObjText};
use super::obj_words::{Statements, Words, integer};

/// A piece while it is read.
pub(super) struct Piece {
    text: ObjText,
    /// Of each kind, how many there were so far.
    seen: [i64; 3],
    /// Of each kind, how many there are in the file.
    total: [i64; 3],
}

impl Piece {
    pub(super) fn read(piece: &[u8], start: Counts, total: [i64; 3]) -> Result<ObjText, LineError> {
        let mut reader = Self { text: ObjText::default(), seen: start.kinds, total };
        for (line, statement) in Statements::of(piece, start.lines) {
            reader.add(&statement, line).map_err(|message| (line, message))?;
        }
        Ok(reader.text)
    }

    fn add(&mut self, statement: &[u8], line: usize) -> Result<(), String> {
        let mut words = Words::of(statement);
        match words.next() {
            Some(b"v") => {
                self.seen[0] += 1;
                self.text.positions.push(position(words)?);
            }
            Some(b"vt") => {
                self.seen[1] += 1;
                self.text.uvs.push(uv(words).ok_or("texcoord parse error")?);
            }
            Some(b"vn") => {
                self.seen[2] += 1;
                self.text.normals.push(three(&mut words).ok_or("normal parse error")?);
            }
            Some(b"f") => self.face(words)?,
            Some(b"o" | b"g") => self.mark(line, MarkKind::Group),
            Some(b"mtllib") => self.mark(line, MarkKind::Library(words.name())),
            Some(b"usemtl") => match words.name() {
                name if name.is_empty() => return Err("usemtl names no material".to_owned()),
                name => self.mark(line, MarkKind::Material(name)),
            },
            // Lines, points, smoothing groups, curves.
            _ => {}
        }
        Ok(())
    }

    fn mark(&mut self, line: usize, kind: MarkKind) {
        self.text.marks.push(Mark { face: self.text.arities.len(), line, kind });
    }

    fn face(&mut self, words: Words<'_>) -> Result<(), String> {
        let first = self.text.corners.len();
        for word in words {
            let corner = self.corner(word)?;
            self.text.corners.push(corner);
        }
        match self.text.corners.len() - first {
            thin @ 0..3 => {
                self.text.thin_faces += 1;
                self.text.corners.truncate(self.text.corners.len() - thin);
            }
            arity => self.text.arities.push(arity as u32),
        }
        Ok(())
    }

    fn corner(&mut self, word: &[u8]) -> Result<[u32; 3], String> {
        let mut corner = [NONE; 3];
        for (kind, number) in word.split(|&b| b == b'/').enumerate() {
            if number.is_empty() && kind > 0 {
                continue;
            }
            let number = integer(number).filter(|_| kind < 3).ok_or_else(|| no_corner(word))?;
            corner[kind] = self.place(kind, number, word)?;
        }
        Ok(corner)
    }

    /// The place in its column that a number means: from 1 upwards, or back from the last one.
    fn place(&mut self, kind: usize, number: i64, word: &[u8]) -> Result<u32, String> {
        let (name, total) = (KINDS[kind], self.total[kind]);
        let place = if number > 0 { number - 1 } else { self.seen[kind] + number };
        match number {
            0 => {
                let word = String::from_utf8_lossy(word);
                Err(format!("`{word}` uses {name} 0: they are counted from 1"))
            }
            _ if (0..total).contains(&place) => Ok(place as u32),
            // Some programs write numbers of texture coordinates or normals and leave out the coordinates.
            _ if total == 0 && kind > 0 => {
                self.text.absent[kind] = true;
                Ok(NONE)
            }
            1.. => Err(format!("a face uses {name} {number}: the file has {total}")),
            _ => Err(format!("a face counts back to a {name} before the first")),
        }
    }
}

fn no_corner(word: &[u8]) -> String {
    // Comments at the end of a line are no part of the format, but are seen.
    format!("`{}` is no corner of a face: v, v/vt, v//vn or v/vt/vn are", String::from_utf8_lossy(word))
}

fn three(words: &mut Words<'_>) -> Option<[f32; 3]> {
    Some([words.number()?, words.number()?, words.number()?])
}

/// Three coordinates, and perhaps one that divides them. More numbers are a colour, which is not read.
fn position(mut words: Words<'_>) -> Result<[f32; 3], &'static str> {
    const WRONG: &str = "position parse error";
    let position = three(&mut words).ok_or(WRONG)?;
    if words.clone().count() != 1 {
        return Ok(position);
    }
    match words.number().ok_or(WRONG)? {
        0.0 => Err("scaling (w) by zero"),
        w => Ok(position.map(|x| x / w)),
    }
}

/// Two coordinates; the second of a texture of one dimension is 0.
fn uv(mut words: Words<'_>) -> Option<[f32; 2]> {
    let u = words.number()?;
    let v = if words.clone().next().is_some() { words.number()? } else { 0.0 };
    Some([u, v])
}
