//! The text header that PPM and PFM share: words between white space, comments from `#` to the line's end.

/// The words of a header and what follows it.
pub(super) struct Header<'a> {
    rest: &'a [u8],
}

impl<'a> Header<'a> {
    /// A header that must begin with `magic`.
    pub(super) fn new(bytes: &'a [u8], magic: &str) -> Result<Self, String> {
        let mut header = Self { rest: bytes };
        match header.word() {
            Ok(word) if word == magic => Ok(header),
            _ => Err(format!("does not begin with {magic}")),
        }
    }

    /// The next word as a number.
    pub(super) fn number<T: std::str::FromStr>(&mut self, what: &str) -> Result<T, String> {
        let word = self.word()?;
        word.parse().map_err(|_| format!("{what} `{word}` is not a valid number"))
    }

    /// Width and height, neither zero.
    pub(super) fn size(&mut self) -> Result<(u32, u32), String> {
        let size = (self.number("width")?, self.number("height")?);
        if size.0 == 0 || size.1 == 0 {
            return Err(format!("empty picture of {}x{} pixels", size.0, size.1));
        }
        Ok(size)
    }

    /// The pixels: what follows the one white space after the last word, at least `pixels * bytes_each` bytes.
    pub(super) fn pixels(self, size: (u32, u32), bytes_each: u64) -> Result<&'a [u8], String> {
        let body = self.rest.get(1..).unwrap_or_default();
        let needed = u128::from(size.0) * u128::from(size.1) * u128::from(bytes_each);
        if (body.len() as u128) < needed {
            return Err(format!("cut short: {} of {needed} bytes of pixels", body.len()));
        }
        Ok(&body[..needed as usize])
    }

    fn word(&mut self) -> Result<&'a str, String> {
        self.skip_space();
        let end = self.rest.iter().position(u8::is_ascii_whitespace).unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        match std::str::from_utf8(word) {
            Ok(word) if !word.is_empty() => Ok(word),
            _ => Err("the header is cut short or is not text".into()),
        }
    }

    fn skip_space(&mut self) {
        while let [first, rest @ ..] = self.rest {
            match first {
                b'#' => {
                    let end = rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
                    self.rest = &rest[end..];
                }
                byte if byte.is_ascii_whitespace() => self.rest = rest,
                _ => return,
            }
        }
    }
}
