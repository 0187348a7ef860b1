//! OBJ bytes as statements: lines, joined where a backslash continues them, and the words in them.

use std::borrow::Cow;

/// Statements, each with the number of its first line.
pub(super) struct Statements<'a> {
    rest: &'a [u8],
    /// The number of the next line.
    pub(super) line: usize,
}

impl<'a> Statements<'a> {
    /// The statements of a text whose first line has the number `line`.
    pub(super) fn of(text: &'a [u8], line: usize) -> Self {
        Self { rest: text, line }
    }

    /// The next line without its end.
    fn take_line(&mut self) -> &'a [u8] {
        let (line, rest) = split_line(self.rest);
        self.rest = rest;
        self.line += 1;
        line
    }
}

impl<'a> Iterator for Statements<'a> {
    type Item = (usize, Cow<'a, [u8]>);

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let (number, mut line) = (self.line, self.take_line());
        if !line.ends_with(b"\\") {
            return Some((number, Cow::Borrowed(line)));
        }
        let mut whole = Vec::new();
        while let Some(continued) = line.strip_suffix(b"\\") {
            whole.extend_from_slice(continued);
            line = self.take_line();
        }
        whole.extend_from_slice(line);
        Some((number, Cow::Owned(whole)))
    }
}

/// The first line without its end, and what follows it.
fn split_line(text: &[u8]) -> (&[u8], &[u8]) {
    let (line, rest) = match memchr::memchr(b'\n', text) {
        Some(end) => (&text[..end], &text[end + 1..]),
        None => (text, &[][..]),
    };
    (line.strip_suffix(b"\r").unwrap_or(line), rest)
}

fn is_continued(line: &[u8]) -> bool {
    line.strip_suffix(b"\r").unwrap_or(line).ends_with(b"\\")
}

/// Pieces of at least so many bytes (the last may be shorter), cut between statements.
pub(super) fn pieces(mut text: &[u8], size: usize) -> Vec<&[u8]> {
    let mut pieces = Vec::new();
    while text.len() > size {
        let mut ends = memchr::memchr_iter(b'\n', &text[size..]).map(|at| size + at);
        let Some(end) = ends.find(|&end| !is_continued(&text[..end])) else { break };
        let (piece, behind) = text.split_at(end + 1);
        pieces.push(piece);
        text = behind;
    }
    pieces.push(text);
    pieces
}

/// The words of a statement.
#[derive(Clone)]
pub(super) struct Words<'a>(&'a [u8]);

impl<'a> Words<'a> {
    pub(super) fn of(statement: &'a [u8]) -> Self {
        Self(statement)
    }

    /// All that was not taken yet, as a name.
    pub(super) fn name(self) -> String {
        String::from_utf8_lossy(self.0).trim().to_owned()
    }

    /// The next word as a number, as Rust reads one; `None` without a word or for another one.
    pub(super) fn number(&mut self) -> Option<f32> {
        self.skip_spaces();
        let (number, used) = fast_float2::parse_partial(self.0).ok()?;
        self.0 = &self.0[used..];
        self.0.first().is_none_or(is_space).then_some(number)
    }

    fn skip_spaces(&mut self) {
        let blank = self.0.iter().take_while(|b| is_space(b)).count();
        self.0 = &self.0[blank..];
    }
}

impl<'a> Iterator for Words<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        self.skip_spaces();
        let length = self.0.iter().take_while(|b| !is_space(b)).count();
        let (word, rest) = self.0.split_at(length);
        self.0 = rest;
        (length > 0).then_some(word)
    }
}

fn is_space(byte: &u8) -> bool {
    matches!(byte, b' ' | b'\t'..=b'\r')
}

/// A whole number with or without sign.
pub(super) fn integer(word: &[u8]) -> Option<i64> {
    let digits = word.strip_prefix(b"-").or(word.strip_prefix(b"+")).unwrap_or(word);
    // 18 digits fit; longer ones may still be small, but nobody counts that far.
    if digits.is_empty() || digits.len() > 18 || !digits.iter().all(u8::is_ascii_digit) {
        return None;
    }
    let size = digits.iter().fold(0, |n, digit| 10 * n + i64::from(digit - b'0'));
    Some(if word[0] == b'-' { -size } else { size })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &str) -> Vec<(usize, String)> {
        let statements = Statements::of(text.as_bytes(), 1);
        statements.map(|(line, text)| (line, String::from_utf8_lossy(&text).into_owned())).collect()
    }

    #[test]
    fn backslashes_join_lines_which_keep_their_numbers() {
        let expected = [(1, "a b".into()), (3, "c".into()), (4, String::new()), (5, "d".into())];
        assert_eq!(lines("a \\\nb\nc\n\nd\\"), expected);
        assert_eq!(lines("a\\\r\n\\\r\nb\r\nc"), [(1, "ab".into()), (4, "c".into())]);
        assert_eq!(lines(""), []);
    }

    #[test]
    fn pieces_are_the_text_cut_between_statements() {
        let text = "v 0 0 \\\n0\nv 1\\\\\n\n\\\n\r\nf 1 \\\r\n2 3\n\nx\\";
        for size in 0..=text.len() + 1 {
            let pieces = pieces(text.as_bytes(), size);
            assert_eq!(pieces.concat(), text.as_bytes());
            let joined: Vec<String> = pieces
                .iter()
                .flat_map(|piece| lines(str::from_utf8(piece).unwrap()))
                .map(|(_, statement)| statement)
                .collect();
            let whole: Vec<String> = lines(text).into_iter().map(|(_, statement)| statement).collect();
            assert_eq!(joined, whole, "{size}");
        }
    }

    #[test]
    fn numbers_are_those_of_the_language() {
        let words = "0 -0 1 +1 .5 -.5 5. 1e5 1E-5 1.e+2 nan NaN inf -inf infinity 1e999 -1e999 1e-999 0.1 16777217 \
            3.4028235e38 3.4028236e38 1.1754944e-38 1e-45 7e-46 8388609.5 0.000000059604645 . - + e5 1e 1e+ x 1x 0x1 \
            1_0 1,5 ++1 +-1 --1 infi 1/2 # 123456789012345678901234567890 0.30000000000000000000000000000001 \
            1.00000005960464477539062 1.000000059604644775390625 1.00000005960464477539063 nan1 -nan +nan +inf";
        for word in words.split_whitespace() {
            let ours = Words::of(format!(" {word}\t").as_bytes()).number();
            assert_eq!(ours.map(f32::to_bits), word.parse().ok().map(f32::to_bits), "{word}");
        }
        assert_eq!(Words::of(b"  ").number(), None);
    }

    #[test]
    fn integers_have_an_end() {
        let read = |word: &str| integer(word.as_bytes());
        assert_eq!([read("7"), read("-7"), read("+7"), read("007")], [Some(7), Some(-7), Some(7), Some(7)]);
        for bad in ["", "-", "+", "+-1", "1.0", "x", "1x", "9223372036854775808"] {
            assert_eq!(read(bad), None, "{bad}");
        }
    }
}
