//! One pass over the text of an OBJ before it is parsed: finds the lines that matter later, checks every index,
//! and smooths what the parser does not take.

use std::borrow::Cow;

/// An OBJ text ready for the parser, with the same line numbers, and what is to know about it.
#[derive(Debug, Default)]
pub(super) struct ObjText {
    /// The text without polylines, colours and continued lines.
    pub(super) text: String,
    /// Line and file names of each `mtllib`.
    pub(super) libraries: Vec<(usize, String)>,
    /// Line and name of each `usemtl`.
    pub(super) materials: Vec<(usize, String)>,
    /// Faces with fewer than three corners.
    pub(super) thin_faces: usize,
    /// What was odd but could be read.
    pub(super) notes: Vec<String>,
    /// Vertices, texture coordinates and normals so far.
    counts: [usize; 3],
    /// The highest number used of each, and the line.
    highest: [(usize, usize); 3],
}

/// What is wrong in which line.
pub(super) type LineError = (usize, String);

/// Stands for a number below zero that reaches before the first one.
const TOO_FAR_BACK: usize = usize::MAX;

const KINDS: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// The prepared text.
///
/// # Errors
/// The first face whose numbers make no sense or point outside the file.
pub(super) fn prepare(source: &str) -> Result<ObjText, LineError> {
    let mut prepared = ObjText { text: String::with_capacity(source.len()), ..ObjText::default() };
    let source = source.strip_prefix('\u{feff}').unwrap_or(source);
    let mut lines = source.lines().enumerate();
    while let Some((index, line)) = lines.next() {
        let (mut whole, mut taken) = (Cow::Borrowed(line), 1);
        while whole.ends_with('\\') {
            whole.to_mut().pop();
            let Some((_, next)) = lines.next() else { break };
            whole.to_mut().push_str(next);
            taken += 1;
        }
        prepared.add(&whole, index + 1).map_err(|message| (index + 1, message))?;
        prepared.text.extend(std::iter::repeat_n('\n', taken));
    }
    prepared.check_highest()?;
    Ok(prepared)
}

impl ObjText {
    fn add(&mut self, line: &str, number: usize) -> Result<(), String> {
        let line = line.trim();
        let (keyword, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        match keyword {
            "v" => self.add_vertex(rest),
            "vt" => {
                self.counts[1] += 1;
                self.text.push_str(line);
                // A texture of one dimension: the second coordinate is 0.
                if rest.split_whitespace().count() == 1 {
                    self.text.push_str(" 0");
                }
            }
            "vn" => {
                self.counts[2] += 1;
                self.text.push_str(line);
            }
            "f" => self.add_face(line, rest, number)?,
            "mtllib" => {
                self.libraries.push((number, rest.trim().to_owned()));
                self.text.push_str("mtllib -");
            }
            "usemtl" if rest.trim().is_empty() => return Err("usemtl names no material".to_owned()),
            "usemtl" => {
                self.materials.push((number, rest.trim().to_owned()));
                self.text.push_str("usemtl ");
                self.text.push_str(rest.trim());
            }
            "o" | "g" => self.text.push_str(line),
            // Lines, points, smoothing groups, curves: the parser would take polylines for polygons.
            _ => {}
        }
        Ok(())
    }

    /// Colours behind the coordinates are left out; a fourth coordinate stays.
    fn add_vertex(&mut self, rest: &str) {
        self.counts[0] += 1;
        let words = rest.split_whitespace().count();
        let kept = if words > 4 { 3 } else { words };
        self.text.push('v');
        for word in rest.split_whitespace().take(kept) {
            self.text.push(' ');
            self.text.push_str(word);
        }
    }

    fn add_face(&mut self, line: &str, rest: &str, number: usize) -> Result<(), String> {
        let mut corners = 0;
        for corner in rest.split_whitespace() {
            // Comments at the end of a line are no part of the format, but are seen.
            if corner.starts_with('#') {
                return Err(format!("`{corner}` is no corner of a face: v, v/vt, v//vn or v/vt/vn are"));
            }
            self.check_corner(corner, number)?;
            corners += 1;
        }
        if corners < 3 {
            self.thin_faces += 1;
            return Ok(());
        }
        self.text.push_str(line);
        Ok(())
    }

    fn check_corner(&mut self, corner: &str, number: usize) -> Result<(), String> {
        let malformed = || format!("`{corner}` is no corner of a face: v, v/vt, v//vn or v/vt/vn are");
        for (kind, index) in corner.split('/').enumerate() {
            if index.is_empty() && kind > 0 {
                continue;
            }
            let count = *self.counts.get(kind).ok_or_else(malformed)?;
            match index.parse::<i64>().map_err(|_| malformed())? {
                0 => return Err(format!("`{corner}` uses {} 0: they are counted from 1", KINDS[kind])),
                index if index > 0 => {
                    let index = index as usize;
                    if index > self.highest[kind].0 {
                        self.highest[kind] = (index, number);
                    }
                }
                index if index.unsigned_abs() > count as u64 => {
                    self.highest[kind] = (TOO_FAR_BACK, number);
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Numbers may point ahead, so the highest ones are compared at the end.
    ///
    /// Some programs write numbers of texture coordinates or normals and leave out the coordinates: these are ignored.
    fn check_highest(&mut self) -> Result<(), LineError> {
        for (kind, name) in KINDS.into_iter().enumerate() {
            let ((index, line), count) = (self.highest[kind], self.counts[kind]);
            if index <= count {
                continue;
            }
            if kind > 0 && count == 0 {
                self.notes.push(format!("faces name {name}s, but the file has none"));
            } else if index == TOO_FAR_BACK {
                return Err((line, format!("a face counts back to a {name} before the first")));
            } else {
                return Err((line, format!("a face uses {name} {index}: the file has {count}")));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

    fn fault(faces: &str) -> LineError {
        prepare(&format!("{TRIANGLE}{faces}")).unwrap_err()
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
        ] {
            assert_eq!(fault(bad).0, 4, "{bad}");
        }
    }

    #[test]
    fn numbers_of_attributes_that_are_nowhere_are_ignored() {
        let prepared = prepare(&format!("{TRIANGLE}f 1/7/-2 2/8/1 3/9/1\n")).unwrap();
        assert_eq!(prepared.notes.len(), 2, "{:?}", prepared.notes);
    }

    #[test]
    fn lines_keep_their_numbers() {
        let prepared = prepare("v 0 0 \\\n0\nv 1 0 0\nl 1 2\nvt 0.5\nusemtl\tred\n").unwrap();
        assert_eq!(prepared.text, "v 0 0 0\n\nv 1 0 0\n\nvt 0.5 0\nusemtl red\n");
        assert_eq!(prepared.materials, [(6, "red".to_owned())]);
    }

    #[test]
    fn colours_go_and_thin_faces_are_counted() {
        let prepared = prepare("v 0 0 0 1 0.5 0\nv 1 0 0 1\nf 1 2\nf 1\n").unwrap();
        assert_eq!(prepared.text, "v 0 0 0\nv 1 0 0 1\n\n\n");
        assert_eq!(prepared.thin_faces, 2);
    }
}
